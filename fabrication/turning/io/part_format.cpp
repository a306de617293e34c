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
    {"nose_radius_mm", Number{{.low = 1e-4, .high = 100.0}}, kRequired, "Radius of the round nose."},
    {"clearance_deg", Number{{.low = 0.0, .low_included = false, .high = 60.0}}, kRequired,
     "Clearance angle of the conical flank, relative to the normal of the rake face."},
    {"window_deg", Number{{.low = 1.0, .high = 178.0}}, 120.0,
     "Angle of the sharp arc of the nose, symmetric about the axis of the tool."},
    {"rake_deg", Number{{.low = -80.0, .high = 45.0}}, 0.0, "Rake angle. If it is positive, the rake face leans back."},
    {"skew_deg", Number{{.low = -80.0, .high = 80.0}}, 0.0,
     "Rotation of the tool about its shank. For a spiral, it is made by moving along Y; for a raster, by C = -skew.",
     kNoLeastSkew},
    {"find_least_skew", Flag{}, false,
     "Whether to use the skew closest to 0, within +-60, with which the tool clears the surface."}};

using geometry::kRasterOnly;
using geometry::kSpiralOnly;
constexpr Condition kAngleOnly[] = {is("sampling", only(kSamplings, "angle"))};
constexpr Condition kArcOnly[] = {is("sampling", only(kSamplings, "arc"))};
constexpr Kind kArcUm = Number{{.low = 0.1, .high = 1e4}};
constexpr Row kPathRows[] = {
    geometry::kStrategyRow,
    {"feed_um", Number{{.low = 1e-3, .high = 1e4}}, kNone, "Feed per turn, or distance from line to line."},
    {"scallop_nm", Number{{.low = 1e-3, .high = 1e6}}, kNone,
     "Height of the cusps on a flat surface, from which the feed is computed; in place of `feed_um`."},
    {"clear_mm", Number{{.low = 0.01, .high = 1e3}}, 1.0, "Height above the part of moves without cutting."},
    {"approach_mm_per_min", Number{{.low = 0.01, .high = 1e5}}, 5.0,
     "Feed of the downward move to the beginning of a cut."},
    geometry::kRegionRadiusRow,
    {"overrun_mm", Number{{.low = 0.0, .high = 1e3}}, 0.0,
     "Distance beyond the rim at which a spiral starts. On a surface that falls outwards, the point of contact of the "
     "nose is inside of its lowest point.",
     kSpiralOnly},
    {"spindle_rpm", Number{{.low = 0.01, .high = 1e5}}, kRequired, "Speed of the spindle, in turns per minute.",
     kSpiralOnly},
    {"sampling", Word{kSamplings}, "angle",
     "Quantity that is equal from point to point. The control joins the points by straight moves of all axes, so a "
     "curved cut needs short moves: an arc of length s and curvature k leaves an error of s^2 k / 8.",
     kSpiralOnly},
    {"points_per_turn", Whole{{.low = 8.0, .high = 100000.0}}, 360.0, "Number of points per turn, at equal angles.",
     kAngleOnly},
    {"arc_um", kArcUm, kRequired, "Distance from point to point along the cut.", kArcOnly},
    {"arc_um", kArcUm, kRequired, "Distance from point to point along the lines.", kRasterOnly},
    {"servo", Word{kServos}, "slow",
     "Kind of tool servo. `\"fast\"`: Z follows the mean over a turn, and the remainder is the stroke in `servo.csv`.",
     kAngleOnly},
    {"servo", Word{only(kServos, "slow")}, "slow",
     "Kind of tool servo. A fast tool servo follows the angle of the spindle and is therefore not available here.",
     Access(), kArcOnly},
    {"cubic_error_nm", Number{{.low = 1e-2, .high = 1e4}}, kNone,
     "Maximum deviation from the spiral for controls that join points by cubics (`pmac`, `a3200`, `automation1`). "
     "Their programs contain positions, velocities and times of as few points as this deviation permits. The key needs "
     "`machine.c_acceleration_deg_per_s2`.",
     kSpiralOnly},
    geometry::kRegionSizeRow,
    {"cutting_mm_per_min", Number{{.low = 0.1, .high = 1e5}}, kRequired, "Cutting speed along the lines.",
     kRasterOnly}};
constexpr std::string_view kFeedKeys[] = {"feed_um", "scallop_nm"};
constexpr Rule kPathRules[] = {OneOf{kFeedKeys, "must have either feed_um or scallop_nm"}};

constexpr Row kLimitRows[] = {
    {"travel_mm", Numbers{2, kPlace}, kNone, "Range `[low, high]` of positions; low is less than high."},
    {"speed_mm_per_s", kPositive, kNone, "Maximum speed."},
    {"acceleration_mm_per_s2", kPositive, kNone, "Maximum acceleration."},
    {"jerk_mm_per_s3", kPositive, kNone, "Maximum jerk."}};
constexpr Row kMachineRows[] = {
    {"spindle_rpm", kPositive, kNone, "Maximum speed of the spindle."},
    {"c_acceleration_deg_per_s2", kPositive, kNone,
     "Maximum acceleration of the spindle. If it is given, spirals begin and end at a standstill."},
    {"blocks_per_s", kPositive, kNone, "Maximum number of blocks that the control executes in a second."}};
constexpr Table limits(std::string_view name, std::string_view meaning) {
  return {.name = name, .meaning = meaning, .rows = kLimitRows, .presence = Presence::optional};
}
constexpr Table kAxes[] = {limits("x", "Limits of X."), limits("y", "Limits of Y."), limits("z", "Limits of Z."),
                           limits("servo", "Limits of a fast tool servo.")};

constexpr Condition kRoundOnly[] = {
    is("path.strategy", only(geometry::kStrategies, "spiral"), "must not be given for a raster: meshes are round")};
constexpr Row kInspectRows[] = {
    {"form_tolerance_nm", kPositive, 10.0,
     "Maximum form error. Larger form errors, and cuts below the surface, fail the inspection."},
    {"map_pixels", Whole{{.low = 11.0, .high = 2001.0}}, 101.0,
     "Number of pixels along each side of the map. Each pixel shows the largest deviation over one feed across the "
     "cuts."},
    {"mesh_thickness_mm", kPositiveMm, kNone,
     "Thickness of the part in `machined.stl`, from the highest point of its back to its horizontal entrance face. If "
     "it is given, this mesh is written: the part that is moulded in the surface that the programs produce.",
     kRoundOnly},
    {"mesh_rings", Whole{{.low = 2.0, .high = 1000.0}}, 100.0, "Number of circles of the mesh `machined.stl`."}};

constexpr Row kRows[] = {{"title", Text{}, kNone, "Title, one line."}};
constexpr Table kTables[] = {
    {.name = "tool", .meaning = "Diamond tool.", .rows = kToolRows},
    {.name = "path", .meaning = "Path of the tool.", .rows = kPathRows, .rules = kPathRules},
    {.name = "machine",
     .meaning = "Limits of the machine. A quantity that is not given is not limited.",
     .rows = kMachineRows,
     .tables = kAxes,
     .presence = Presence::implied},
    {.name = "inspect", .meaning = "Requirements on the result.", .rows = kInspectRows, .presence = Presence::implied}};

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
                                {"", "Surface, tool, path of the tool, machine and inspection.", kRows, tables}};
  return format;
}

}  // namespace retrace::fabrication::turning
