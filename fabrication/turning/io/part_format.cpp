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

constexpr Condition kNoLeastSkew[] = {is_absent("find_min_skew")};
constexpr Row kToolRows[] = {
    {"nose_radius_mm", Number{{.low = 1e-4, .high = 100.0}}, kRequired, "Radius of the tool's round nose."},
    {"clearance_deg", Number{{.low = 0.0, .low_included = false, .high = 60.0}}, kRequired,
     "Clearance angle of the conical flank, relative to the normal of the rake face."},
    {"window_deg", Number{{.low = 1.0, .high = 178.0}}, 120.0,
     "Included angle of the arc of the nose that is sharp and can cut. The arc is symmetric about the axis of the "
     "tool."},
    {"rake_deg", Number{{.low = -80.0, .high = 45.0}}, 0.0,
     "Rake angle. If it is positive, the rake face is inclined backwards, away from the cutting direction."},
    {"skew_deg", Number{{.low = -80.0, .high = 80.0}}, 0.0,
     "Skew: rotation of the tool about its shank, from the cutting direction outwards. No rotary axis of the tool is "
     "needed. In a spiral, the tool is displaced along Y to obtain the skew; in a raster, the part is rotated to C = "
     "-skew.",
     kNoLeastSkew},
    renamed("find_least_skew",
            Row{"find_min_skew", Flag{}, false,
                "Whether the skew is determined by the program: the skew closest to 0, within +-60 degrees, at which "
                "the tool clears the surface."})};

using geometry::kRasterOnly;
using geometry::kSpiralOnly;
constexpr Condition kAngleOnly[] = {is("sampling", only(kSamplings, "angle"))};
constexpr Condition kArcOnly[] = {is("sampling", only(kSamplings, "arc"))};
constexpr Kind kArcUm = Number{{.low = 0.1, .high = 1e4}};
constexpr Row kPathRows[] = {
    geometry::kStrategyRow,
    {"feed_um", Number{{.low = 1e-3, .high = 1e4}}, kNone,
     "Spiral: feed per rotation of the spindle. Raster: distance between neighbouring lines."},
    {"scallop_nm", Number{{.low = 1e-3, .high = 1e6}}, kNone,
     "Height of the cusps on a flat surface. The feed is computed from this height. The key is given instead of "
     "`feed_um`."},
    {"clear_mm", Number{{.low = 0.01, .high = 1e3}}, 1.0, "Height, above the part, of moves without cutting."},
    {"approach_mm_per_min", Number{{.low = 0.01, .high = 1e5}}, 5.0,
     "Feed of the downward move to the beginning of a cut."},
    geometry::kRegionRadiusRow,
    {"overrun_mm", Number{{.low = 0.0, .high = 1e3}}, 0.0,
     "Distance beyond the rim at which a spiral starts. It is needed on surfaces that fall outwards, because the nose "
     "then touches the surface at a smaller radius than that of its lowest point.",
     kSpiralOnly},
    {"spindle_rpm", Number{{.low = 0.01, .high = 1e5}}, kRequired, "Speed of the spindle, in revolutions per minute.",
     kSpiralOnly},
    {"sampling", Word{kSamplings}, "angle",
     "Spacing of the points of a spiral: equal angles of the spindle, or equal arc lengths. The control connects the "
     "points by straight moves of all axes. A curved cut therefore needs short moves: an arc of length s and curvature "
     "k leaves an error of s^2 k / 8.",
     kSpiralOnly},
    {"points_per_turn", Integer{{.low = 8.0, .high = 100000.0}}, 360.0,
     "Number of points per rotation of the spindle, at equal angles.", kAngleOnly},
    {"arc_um", kArcUm, kRequired, "Distance between neighbouring points along the cut.", kArcOnly},
    {"arc_um", kArcUm, kRequired, "Distance between neighbouring points along the lines.", kRasterOnly},
    {"servo", Word{kServos}, "slow",
     "Kind of tool servo. `\"slow\"`: the Z axis follows the surface. `\"fast\"`: the Z axis follows the mean height "
     "over a rotation, and a fast tool servo adds the remainder. `servo.csv` contains this stroke of the servo.",
     kAngleOnly},
    {"servo", Word{only(kServos, "slow")}, "slow",
     "Kind of tool servo. A fast tool servo follows the angle of the spindle and is therefore not available for this "
     "sampling.",
     Access(), kArcOnly},
    {"cubic_error_nm", Number{{.low = 1e-2, .high = 1e4}}, kNone,
     "Maximum deviation from the spiral for controls that connect points by cubic curves (dialects `pmac`, `a3200` and "
     "`automation1`). Their programs contain the positions, velocities and times of as few points as this deviation "
     "allows. The key needs `machine.c_acceleration_deg_per_s2`.",
     kSpiralOnly},
    geometry::kRegionSizeRow,
    {"cutting_mm_per_min", Number{{.low = 0.1, .high = 1e5}}, kRequired, "Cutting speed along the lines.",
     kRasterOnly}};
constexpr std::string_view kFeedKeys[] = {"feed_um", "scallop_nm"};
constexpr Rule kPathRules[] = {OneOf{kFeedKeys, "must contain either the key feed_um or the key scallop_nm"}};

constexpr Row kLimitRows[] = {
    {"travel_mm", Numbers{2, kPlace}, kNone, "Range `[low, high]` of positions; low is less than high."},
    {"speed_mm_per_s", kPositive, kNone, "Maximum speed."},
    {"acceleration_mm_per_s2", kPositive, kNone, "Maximum acceleration."},
    {"jerk_mm_per_s3", kPositive, kNone, "Maximum jerk."}};
constexpr Row kMachineRows[] = {
    {"spindle_rpm", kPositive, kNone, "Maximum speed of the spindle."},
    {"c_acceleration_deg_per_s2", kPositive, kNone,
     "Maximum acceleration of the spindle. If it is given, the spindle is at rest at the beginning and at the end of a "
     "spiral."},
    {"blocks_per_s", kPositive, kNone, "Maximum number of blocks that the control executes in a second."}};
constexpr Table limits(std::string_view name, std::string_view meaning) {
  return {.name = name, .meaning = meaning, .rows = kLimitRows, .presence = Presence::optional};
}
constexpr Table kAxes[] = {limits("x", "Limits of X."), limits("y", "Limits of Y."), limits("z", "Limits of Z."),
                           limits("servo", "Limits of a fast tool servo.")};

constexpr Condition kRoundOnly[] = {
    is("path.strategy", only(geometry::kStrategies, "spiral"),
       "only allowed for strategy = \"spiral\", because meshes are made only for round parts")};
constexpr Row kInspectRows[] = {
    {"form_tolerance_nm", kPositive, 10.0,
     "Maximum form error. The part fails the inspection if its form error, or the depth of a cut below the surface, "
     "exceeds this value."},
    {"map_pixels", Integer{{.low = 11.0, .high = 2001.0}}, 101.0,
     "Number of pixels along each side of the map. Each pixel shows the largest deviation within one feed across the "
     "cuts."},
    {"mesh_thickness_mm", kPositiveMm, kNone,
     "Thickness of the part in the mesh `machined.stl`, from the highest point of its back to its horizontal entrance "
     "face. If the key is given, this mesh is written. It shows the part that is moulded from the machined surface.",
     kRoundOnly},
    {"mesh_rings", Integer{{.low = 2.0, .high = 1000.0}}, 100.0, "Number of circles of the mesh `machined.stl`."}};

constexpr Row kRows[] = {{"title", Text{}, kNone, "Title of the part, in one line."}};
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
