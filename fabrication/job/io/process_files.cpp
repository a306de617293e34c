#include "fabrication/job/io/process_files.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>

#include "core/atomic_file.h"
#include "core/data_directory.h"
#include "core/message_text.h"
#include "core/named_file.h"
#include "core/number_format.h"
#include "core/schema/access.h"
#include "core/schema/conditions.h"
#include "core/schema/reader.h"
#include "fabrication/job/io/given_access.h"

namespace retrace::fabrication {
namespace fs = std::filesystem;
namespace {

using schema::access;
using schema::kNone;
using schema::kRequired;
using schema::Number;

constexpr NumberRange kDepth{.low = 0.0, .low_included = false, .high = 1000.0};
constexpr NumberRange kFeed{.low = kMinFeedMmPerMin, .high = 1e5};
constexpr NumberRange kShortLength{.low = 0.0, .low_included = false, .high = 100.0};
constexpr NumberRange kDwell{.low = 0.0, .high = 60.0};
constexpr NumberRange kCuts{.low = 1.0, .high = 1000.0};
constexpr NumberRange kRoughness{.low = 0.0, .high = 1e4};
constexpr NumberRange kMicrometres{.low = 0.0, .high = 1000.0};
constexpr NumberRange kMinutes{.low = 0.0, .low_included = false, .high = 1e5};

bool stops_before_finishing(const Process& process) {
  return process.stop_before_finishing;
}

constexpr schema::Row kRows[] = {
    {"name", schema::Text{}, kRequired, "Name of the process.", access<&Process::name>},
    {"source", schema::Text{}, kRequired, "Source of the values.", access<&Process::source>},
    {"clearance_mm", Number{kShortLength}, kRequired,
     "Clearance of the tool above the face of the blank between cuts, measured along the normal of the face.",
     access<&Process::clearance_mm>},
    {"roughing_depth_um", Number{kDepth}, kRequired,
     "Depth of cut in roughing, and in the layers of the strategy `bidirectional`.",
     access<&Process::roughing_depth_um>},
    {"finishing_depth_um", Number{kDepth}, kRequired, "Depth of cut in finishing.",
     access<&Process::finishing_depth_um>},
    {"finishing_cuts", schema::Integer{kCuts}, 2.0,
     "Number of finishing cuts on each facet, for the strategies `two-step` and `dmc`.",
     access<&Process::finishing_cuts>},
    {"plough_length_mm", Number{kShortLength}, kRequired, "Length of a plough along facet 2, from the root.",
     access<&Process::plough_length_mm>},
    {"dwell_s", Number{kDwell}, 0.1, "Dwell time of the tool at the root, in every cut.", access<&Process::dwell_s>},
    {"roughing_feed_mm_per_min", Number{kFeed}, kRequired,
     "Feed of plunging and ploughing in roughing. Programs contain feeds with three decimals, so a feed below the "
     "minimum would be written as `F0.000`.",
     access<&Process::roughing_feed_mm_per_min>},
    {"finishing_feed_mm_per_min", Number{kFeed}, kRequired, "Feed of finishing.",
     access<&Process::finishing_feed_mm_per_min>},
    {"retract_feed_mm_per_min", Number{kFeed}, kRequired,
     "Feed of retracts, and of moves to the next cut of the same element.", access<&Process::retract_feed_mm_per_min>},
    {"shortest_plough", schema::Flag{}, false, "Whether a plough ends as soon as its chip has separated.",
     access<&Process::shortest_plough>},
    {"plough_lift_um", Number{kMicrometres}, 0.0,
     "Distance by which the tool is lifted off the facet after the chip has separated.",
     access<&Process::plough_lift_um>},
    {"slow_retract_um", Number{kMicrometres}, 0.0,
     "Length of the first part of the retract of a bidirectional cut. This part goes straight up at the cutting feed.",
     access<&Process::slow_retract_um>},
    {"rotary_clearance_mm", Number{kShortLength}, 5.0,
     "Minimum height of the tool, during a rotary move, above all points that the rotating blank can reach.",
     access<&Process::rotary_clearance_mm>},
    schema::renamed(
        "least_chip_um",
        schema::Row{
            "min_chip_um", Number{kDepth}, kNone,
            "Minimum chip thickness. If the chip of a cut is thinner along its whole length, the edge rubs instead of "
            "cutting. The value is at most half of the depth of cut, both in roughing and in finishing.",
            access_given<&Process::min_chip_um>}),
    {"stop_every_min", Number{kMinutes}, kNone,
     "Maximum run time of a program from its beginning, or from a stop, to the next stop. At a stop, the operator "
     "inspects the part and the edge, and touches off again.",
     access_given<&Process::stop_every_min>},
    {"stop_before_finishing", schema::Flag{}, false,
     "Whether the program stops between roughing and finishing, so that the operator can inspect every element. "
     "Elements of equal orientation are inspected at the same stop.",
     access_where<&Process::stop_before_finishing, stops_before_finishing>},
    {"mist", schema::Flag{}, true, "Whether mist is on while the tool cuts.", access<&Process::mist>},
    {"plough_sa_nm", Number{kRoughness}, 468.0,
     "Areal roughness Sa of facets after ploughing. The default was measured by Milliken (2017) and Hamilton et al. "
     "(2017).",
     access<&Process::plough_sa_nm>},
    {"roughing_plunge_sa_nm", Number{kRoughness}, 115.0,
     "Areal roughness Sa of facets after plunging in roughing. The default was measured by Milliken (2017) and "
     "Hamilton et al. (2017).",
     access<&Process::roughing_plunge_sa_nm>},
    {"finishing_plunge_sa_nm", Number{kRoughness}, 48.9,
     "Areal roughness Sa of facets after plunging in finishing. The default was measured by Milliken (2017) and "
     "Hamilton et al. (2017).",
     access<&Process::finishing_plunge_sa_nm>}};

/// Returns an error message if the length of a plough is less than the thickness of the chip, because the chip then
/// does not separate.
std::string hanging_chip(const Process& p) {
  if (p.shortest_plough || p.plough_length_mm >= 1e-3 * p.roughing_depth_um) return {};
  return fmt::format("must be at least roughing_depth_um ({} um), so that the chip separates, got {}",
                     shortest(p.roughing_depth_um), shortest(p.plough_length_mm));
}

/// Returns an error message if the minimum chip thickness is more than half of a depth of cut. If the first cut of a
/// facet would be too thin, the planner gives the first and the second cut the same thickness. Both are then at least
/// half a depth of cut thick, which must be sufficient.
std::string rubbing_depth(const Process& p) {
  const double most_um = 0.5 * std::min(p.roughing_depth_um, p.finishing_depth_um);
  if (!p.min_chip_um || *p.min_chip_um <= most_um) return {};
  return fmt::format("must be at most half of roughing_depth_um and of finishing_depth_um, which is {}, got {}",
                     shortest(most_um), shortest(*p.min_chip_um));
}

constexpr std::string_view kPloughKeys[] = {"plough_length_mm"};
constexpr std::string_view kMinChipKeys[] = {"min_chip_um"};
constexpr schema::Rule kRules[] = {
    schema::Check{kMinChipKeys, "`min_chip_um` is at most half of `roughing_depth_um` and of `finishing_depth_um`.",
                  schema::check_by<rubbing_depth>},
    schema::Check{kPloughKeys,
                  "A plough is at least as long as the depth of cut in roughing, unless `shortest_plough` is true.",
                  schema::check_by<hanging_chip>}};

constexpr schema::Format kFormat = {
    "process",
    "retrace.process/1",
    "Process of a fabrication job",
    {"", "Cutting process of the elements: depths, feeds, and the resulting roughness.", kRows, {}, kRules}};

}  // namespace

const schema::Format& process_format() {
  return kFormat;
}

schema::Table process_table(std::string_view name, schema::Child child) {
  schema::Table table = kFormat.root;
  table.name = name;
  table.child = child;
  return table;
}

Process parse_process(std::string_view text, const std::string& source_name) {
  Process process;
  process.warnings = schema::renamed_keys(schema::read_object(kFormat, text, source_name, &process));
  return process;
}

std::vector<Process> shipped_processes() {
  std::vector<Process> processes;
  for (const fs::path& file : shipped_files("processes"))
    processes.push_back(parse_process(read_file(file), file.string()));
  return processes;
}

Process load_process(const std::string& name_or_file, const InputLocation& where) {
  if (fs::path(name_or_file).has_extension())
    return read_named(where, [&] { return parse_process(read_file(name_or_file), name_or_file); });
  std::vector<std::string> names;
  for (const Process& process : shipped_processes()) {
    if (process.name == name_or_file) return process;
    names.push_back(process.name);
  }
  throw InputError(where, fmt::format("must be the name of a file or one of the names {}, got {}",
                                      fmt::join(names, ", "), in_quotes(name_or_file)));
}

}  // namespace retrace::fabrication
