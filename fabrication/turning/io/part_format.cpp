#include "fabrication/turning/io/part_files.h"

#include <iterator>
#include <span>
#include <vector>

#include "core/schema/conditions.h"
#include "geometry/io/surface_tables.h"

namespace retrace::fabrication::turning {
namespace {

using namespace schema;

constexpr NumberRange kPlace{.low = -1e4, .high = 1e4};
constexpr NumberRange kSize{.low = 0.0, .low_included = false, .high = 1e4};
constexpr Kind kPositiveMm = Number{kSize};
constexpr Kind kPositive = Number{{.low = 0.0, .low_included = false, .high = 1e9}};

constexpr Words kSamplings = {"angle", "arc"};
constexpr Words kServos = {"slow", "fast"};

constexpr Condition kNoLeastSkew[] = {without("find_least_skew")};
constexpr Row kToolRows[] = {
    {"nose_radius_mm", Number{{.low = 1e-4, .high = 100.0}}, kRequired, "Of the round edge."},
    {"clearance_deg", Number{{.low = 0.0, .low_included = false, .high = 60.0}}, kRequired,
     "Of the conical flank, against the normal of the rake face."},
    {"window_deg", Number{{.low = 1.0, .high = 178.0}}, 120.0, "Arc of the nose that is sharp, symmetric."},
    {"rake_deg", Number{{.low = -80.0, .high = 45.0}}, 0.0, "Positive: the face leans back."},
    {"skew_deg", Number{{.low = -80.0, .high = 80.0}}, 0.0,
     "Turn about the shank: of a spiral made by moving along Y, of a raster by C = -skew.", kNoLeastSkew},
    {"find_least_skew", Flag{}, false, "Whether to take the skew nearest to 0 that clears, within +-60."}};

using geometry::kRasterOnly;
using geometry::kSpiralOnly;
constexpr Condition kAngleOnly[] = {is("sampling", only(kSamplings, "angle"))};
constexpr Condition kArcOnly[] = {is("sampling", only(kSamplings, "arc"))};
constexpr Kind kArcUm = Number{{.low = 0.1, .high = 1e4}};
constexpr Row kPathRows[] = {
    geometry::kStrategyRow,
    {"feed_um", Number{{.low = 1e-3, .high = 1e4}}, kNone, "A turn, or from line to line."},
    {"scallop_nm", Number{{.low = 1e-3, .high = 1e6}}, kNone,
     "In its place: the feed whose cusps on a flat are so high."},
    {"clear_mm", Number{{.low = 0.01, .high = 1e3}}, 1.0, "Above the part, for moves without cutting."},
    {"approach_mm_per_min", Number{{.low = 0.01, .high = 1e5}}, 5.0, "Down to where a cut begins."},
    geometry::kRegionRadiusRow,
    {"overrun_mm", Number{{.low = 0.0, .high = 1e3}}, 0.0,
     "Beyond the rim, where a spiral starts: on a surface that falls outwards the nose touches inside of its lowest "
     "point.",
     kSpiralOnly},
    {"spindle_rpm", Number{{.low = 0.01, .high = 1e5}}, kRequired, "Turns a minute.", kSpiralOnly},
    {"sampling", Word{kSamplings}, "angle",
     "What is equal from point to point; the controller joins them by straight moves of all axes, so a curved cut "
     "wants "
     "short ones: an arc s leaves s^2 k / 8.",
     kSpiralOnly},
    {"points_per_turn", Whole{{.low = 8.0, .high = 100000.0}}, 360.0, "Points by angle.", kAngleOnly},
    {"arc_um", kArcUm, kRequired, "From point to point.", kArcOnly},
    {"arc_um", kArcUm, kRequired, "Likewise along the lines.", kRasterOnly},
    {"servo", Word{kServos}, "slow",
     "`\"fast\"`: Z follows the mean over a turn, the rest is the stroke in `servo.csv`.", kAngleOnly},
    {"servo", Word{only(kServos, "slow")}, "slow", "A fast tool servo goes by the spindle's angle.", Access(),
     kArcOnly},
    {"cubic_error_nm", Number{{.low = 1e-2, .high = 1e4}}, kNone,
     "Controls that join points by cubics (`pmac`, `a3200`, `automation1`) get places, velocities and times, as few as "
     "stay so near to the spiral; it then needs `machine.c_acceleration_deg_per_s2`.",
     kSpiralOnly},
    geometry::kRegionSizeRow,
    {"cutting_mm_per_min", Number{{.low = 0.1, .high = 1e5}}, kRequired, "Along the lines.", kRasterOnly}};
constexpr std::string_view kFeedKeys[] = {"feed_um", "scallop_nm"};
constexpr Rule kPathRules[] = {OneOf{kFeedKeys, "must have either feed_um or scallop_nm"}};

constexpr Row kLimitRows[] = {{"travel_mm", Numbers{2, kPlace}, kNone, "`[low, high]`, which rise."},
                              {"speed_mm_per_s", kPositive, kNone, "Speed that is not exceeded."},
                              {"acceleration_mm_per_s2", kPositive, kNone, "The same of acceleration."},
                              {"jerk_mm_per_s3", kPositive, kNone, "The same of jerk."}};
constexpr Row kMachineRows[] = {
    {"spindle_rpm", kPositive, kNone, "Greatest speed of the spindle."},
    {"c_acceleration_deg_per_s2", kPositive, kNone,
     "The same of its acceleration: spirals then begin and end at a standstill."},
    {"blocks_per_s", kPositive, kNone, "Most blocks that the control carries out in a second."}};
constexpr Table limits(std::string_view name, std::string_view meaning) {
  return {.name = name, .meaning = meaning, .rows = kLimitRows, .presence = Presence::optional};
}
constexpr Table kAxes[] = {limits("x", "Limits of X."), limits("y", "Limits of Y."), limits("z", "Limits of Z."),
                           limits("servo", "Limits of a fast tool servo.")};

constexpr Condition kRoundOnly[] = {
    is("path.strategy", only(geometry::kStrategies, "spiral"), "must not be given for a raster: meshes are round")};
constexpr Row kInspectRows[] = {
    {"form_tolerance_nm", kPositive, 10.0, "Larger form errors, and cuts below the surface, fail."},
    {"map_pixels", Whole{{.low = 11.0, .high = 2001.0}}, 101.0,
     "Of the map, each of which shows the greatest deviation over one feed across the cuts."},
    {"mesh_thickness_mm", kPositiveMm, kNone,
     "Writes `machined.stl`: what is moulded in the surface that the programs leave, with a level entrance face so far "
     "above its highest place.",
     kRoundOnly},
    {"mesh_rings", Whole{{.low = 2.0, .high = 1000.0}}, 100.0, "Circles of that mesh."}};

constexpr Row kRows[] = {{"title", Text{}, kNone, "One line."}};
constexpr Table kTables[] = {{.name = "tool", .meaning = "The diamond.", .rows = kToolRows},
                             {.name = "path", .meaning = "How it moves.", .rows = kPathRows, .rules = kPathRules},
                             {.name = "machine",
                              .meaning = "Limits of the machine; what is not given is not limited.",
                              .rows = kMachineRows,
                              .tables = kAxes,
                              .presence = Presence::implied},
                             {.name = "inspect",
                              .meaning = "What is asked of the result.",
                              .rows = kInspectRows,
                              .presence = Presence::implied}};

/// Returns the tables of the surface, followed by the tables of its manufacture.
std::vector<Table> all_tables() {
  const std::span<const Table> of_surface = geometry::surface_tables();
  std::vector<Table> tables(of_surface.begin(), of_surface.end());
  tables.insert(tables.end(), std::begin(kTables), std::end(kTables));
  return tables;
}

}  // namespace

const Format& turned_part_format() {
  static const std::vector<Table> tables = all_tables();
  static const Format format = {"turned_part",
                                geometry::kTurnedPartId,
                                "Freeform surface, turned",
                                {"", "A surface, the tool, its path, the machine and the inspection.", kRows, tables}};
  return format;
}

}  // namespace retrace::fabrication::turning
