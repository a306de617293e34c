#include "core/schema/access.h"
#include "requests/descriptions.h"
#include "requests/rows/common.h"

namespace retrace::requests {
namespace {

using schema::access;

constexpr std::string_view kActionsIfExists[] = {"refuse", "resume", "overwrite"};

// These rows create no options, because the command line defines --set, --seed, --out, --resume and --overwrite itself.
constexpr Row kStudyRows[] = {
    {"overrides",
     Texts{},
     "texts KEY=VALUE for keys of designs, [analysis] and [machining]",
     access<&StudyRequest::overrides>,
     {.value = "KEY=VALUE", .option = "--set", .is_no_option = true, .is_no_keyword = true}},
    seed_row<StudyRequest>(),
    {"store",
     File{"an SQLite file"},
     "SQLite file in which finished points are kept",
     access<&StudyRequest::store>,
     {.value = "FILE", .otherwise = "finished points are not kept", .is_no_option = true, .is_no_keyword = true}},
    {"if_exists",
     Word{kActionsIfExists},
     "action if the store exists already: refuse, resume or overwrite",
     access<&StudyRequest::if_exists>,
     {.value = "ACTION", .is_no_option = true, .is_no_keyword = true}}};

}  // namespace

template <>
const Request& description<StudyRequest>() {
  static constexpr Request request{"study", "sweep", kStudyRows, initial_object<StudyRequest>};
  return request;
}

}  // namespace retrace::requests
