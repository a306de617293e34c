#include <fmt/format.h>

#include "core/error.h"
#include "core/number_format.h"
#include "core/schema/access.h"
#include "requests/descriptions.h"
#include "requests/rows/common.h"

namespace retrace::requests {
namespace {

using schema::access;

/// Names of the machines and processes that are shipped with the program.
constexpr std::string_view kMachines[] = {"ideal", "paper", "thesis", "ideal-dmc"};
constexpr std::string_view kProcesses[] = {"thesis-acrylic", "thesis-forces", "thesis-forces-10um", "paper-pmma"};

constexpr std::string_view kStrategies[] = {"unidirectional", "bidirectional", "two-step", "dmc"};
constexpr std::string_view kWorkpieces[] = {"mould", "direct"};

/// Allowed tool widths, in mm, for all strategies except "dmc" (diamond micro chiseling). The row of `tool_width_mm`
/// allows a wider range, because it also applies to "dmc".
constexpr NumberRange kChiselWidthMm{.low = 0.1, .high = 2.0};

void check_making_request(const void* object) {
  const auto& request = *static_cast<const JobRequest*>(object);
  if (request.strategy != "dmc" && !kChiselWidthMm.contains(request.tool_width_mm))
    throw InputError(Field{"tool_width_mm"},
                     fmt::format("must be {}, got {}", kChiselWidthMm.text(), shortest(request.tool_width_mm)));
}

constexpr Row kJobRows[] = {
    {.name = "tool_width_mm",
     .kind = Number{{.low = 0.01, .high = 10.0}},
     .meaning =
         "width of the tool between the outer ends of its cutting edges; 0.1 to 2 mm with all strategies except dmc",
     .access = access<&JobRequest::tool_width_mm>,
     .spelling = {.value = "W"},
     .is_required = true},
    {"machine",
     WordOrFile{kMachines, ".toml", "ideal, paper, thesis, ideal-dmc or a file"},
     "name of a shipped machine, or a machine file",
     access<&JobRequest::machine>,
     {.value = "MACHINE"}},
    {"strategy",
     Word{kStrategies},
     "cutting strategy: unidirectional, bidirectional or two-step for prisms; dmc (diamond micro chiseling) for cube "
     "corners",
     access<&JobRequest::strategy>,
     {.value = "STRATEGY"}},
    {"process",
     WordOrFile{kProcesses, ".toml", "the name of a shipped process or a file"},
     "name of a shipped process, or a process file; a process contains the depths, feeds and dwell times of the cuts",
     access<&JobRequest::process>,
     {.value = "PROCESS"}},
    {"workpiece",
     Word{kWorkpieces},
     "kind of workpiece: mould if a mould of the part is cut, direct if the optical part itself is cut",
     access<&JobRequest::workpiece>,
     {.value = "KIND"}},
    {"shrinkage_percent",
     Number{{.low = 0.0, .high = 10.0}},
     "shrinkage of the moulded part; the mould is larger than the part by this percentage",
     access<&JobRequest::shrinkage_percent>,
     {.value = "S"}}};

/// NC dialects in which programs can be written.
constexpr std::string_view kProgramDialects[] = {"rs274ngc", "sinumerik", "fanuc", "pmac", "a3200", "automation1"};

/// Maximum number of an element or pass, and maximum value of `stop_every`: the largest signed 32-bit integer.
constexpr double kMaxVisits = 2147483647.0;

constexpr schema::Condition kFromElement[] = {schema::is_given("from_element")};
constexpr Need kNeedFromElement[] = {kFromElement};

constexpr Row kFabricationRows[] = {
    {"dialect",
     Word{kProgramDialects},
     "dialect of the programs: rs274ngc, sinumerik, fanuc, pmac, a3200 or automation1",
     access<&FabricationRequest::dialect>,
     {.value = "DIALECT"}},
    {"phase",
     Text{"all, roughing, finishing or the name of a stage"},
     "stages that the programs contain: all, roughing, finishing, or one stage such as finishing-1-facet-2; a + after "
     "the name also includes all later stages",
     access<&FabricationRequest::phase>,
     {.value = "PHASE"}},
    {"from_element",
     Integer{{.low = 0.0, .high = kMaxVisits}},
     "number, counted from 0, of the element at which the programs start; all earlier cuts of the selected stages are "
     "omitted",
     access<&FabricationRequest::from_element>,
     {.value = "N", .otherwise = "the first"}},
    {"from_pass",
     Integer{{.low = 1.0, .high = kMaxVisits}},
     "number, counted from 1, of the pass with which the programs start at the first element; a tool that is narrower "
     "than an element needs several parallel passes for it",
     access<&FabricationRequest::from_pass>,
     {.value = "K", .usual = "1"},
     kNeedFromElement},
    {"stop_every",
     Integer{{.low = 1.0, .high = kMaxVisits}},
     "number of elements that the tool cuts between two optional stops; an element that is cut in several stages "
     "counts several times",
     access<&FabricationRequest::stop_every>,
     {.value = "N", .otherwise = "no stops"}},
    {"split_hours",
     Number{{.low = 0.0, .low_included = false}},
     "maximum run time of one program in hours; a longer job is split into several programs",
     access<&FabricationRequest::split_hours>,
     {.value = "H", .otherwise = "all in one program"}},
    {"job_text",
     Text{"the text of a job file"},
     "text of the job file; if it is given, the file is not read",
     access<&FabricationRequest::job_text>,
     {.value = "TEXT", .otherwise = "the text of the file", .is_no_option = true, .is_no_keyword = true}}};

}  // namespace

template <>
const Request& description<JobRequest>() {
  static constexpr Request request{"job", "job", kJobRows, initial_object<JobRequest>, check_making_request};
  return request;
}
template <>
const Request& description<FabricationRequest>() {
  static constexpr Request request{"fabrication", "fabricate", kFabricationRows, initial_object<FabricationRequest>};
  return request;
}

}  // namespace retrace::requests
