#include "core/schema/access.h"
#include "requests/descriptions.h"
#include "requests/rows/common.h"

namespace retrace::requests {
namespace {

using schema::access;

/// NC dialects in which programs can be read. For "auto", the dialect is recognised from the text of the program.
constexpr std::string_view kReadDialects[] = {"auto", "rs274ngc", "sinumerik", "fanuc", "pmac", "a3200", "automation1"};

// The member VerificationRequest::texts (texts of files in memory) has no row, because only callers in C++ and Python
// can set it.
constexpr Row kVerificationRows[] = {
    {.name = "job",
     .kind = File{"a job file"},
     .meaning = "job file",
     .access = access<&VerificationRequest::job>,
     .spelling = {.value = "FILE", .is_no_option = true, .is_no_keyword = true},
     .is_required = true},
    {.name = "programs",
     .kind = Texts{},
     .meaning = "NC programs, in the order in which they run; FILE@LINE: the program "
                "was stopped after this line",
     .access = access<&VerificationRequest::programs>,
     .spelling = {.value = "FILE", .is_no_option = true, .is_no_keyword = true},
     .is_required = true},
    {"dialect",
     Word{kReadDialects},
     "dialect of the programs: rs274ngc, sinumerik, fanuc, pmac, a3200, automation1, or auto: recognised from "
     "the text",
     access<&VerificationRequest::dialect>,
     {.value = "DIALECT"}},
    {"tolerance_nm",
     Number{{.low = 0.0, .low_included = false}},
     "maximum deviation of the facet planes of a job from the design",
     access<&VerificationRequest::tolerance_nm>,
     {.value = "T",
      .otherwise = "10, or the deviation that the increments of a Fanuc control cause "
                   "if it is larger"}},
    {"next_stage",
     Text{"the name of a stage"},
     "name of the next stage of a job, such as finishing-1-facet-1: all stages before "
     "it have been cut",
     access<&VerificationRequest::next_stage>,
     {.value = "STAGE", .otherwise = "the blank is uncut", .former = "standing"}},
    {"as_machined",
     File{"a design file"},
     "output file for the design of the machined part",
     access<&VerificationRequest::as_machined>,
     {.value = "FILE", .otherwise = "none", .is_no_option = true, .is_no_keyword = true}}};

}  // namespace

template <>
const Request& description<VerificationRequest>() {
  static constexpr Request request{"verification", "verify", kVerificationRows, initial_object<VerificationRequest>};
  return request;
}

}  // namespace retrace::requests
