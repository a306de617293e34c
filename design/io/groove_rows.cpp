#include "design/io/groove_rows.h"

#include "core/schema/conditions.h"
#include "design/io/design_rows.h"

namespace retrace::design {
namespace {

using namespace schema;

constexpr Words kGrooveFormWords = {"custom", "equilateral", "base_angles", "canted"};
constexpr Words kCantDirections = {"face_more_parallel", "edge_more_parallel"};
constexpr std::string_view kGrooveForm = "form";

constexpr Condition kShortForms[] = {is(kGrooveForm, only(kGrooveFormWords, "equilateral", "canted"),
                                        "only allowed for the forms \"equilateral\", \"base_angles\" and \"canted\"; "
                                        "each set of the form \"custom\" has its own spacing")};
constexpr Condition kOfBaseAngles[] = {is(kGrooveForm, only(kGrooveFormWords, "base_angles"))};
constexpr Condition kOfCanted[] = {is(kGrooveForm, only(kGrooveFormWords, "canted"))};
constexpr Condition kOfCustom[] = {is(kGrooveForm, only(kGrooveFormWords, "custom"),
                                      "only allowed for grooves.form = \"custom\", because other forms determine it")};

constexpr NumberRange kHalfAngle{.low = 5.0, .high = 85.0};
constexpr NumberRange kHalfAngleError{.low = -300.0, .high = 300.0};
constexpr NumberRange kMicrometres{.low = -1e4, .high = 1e4};
constexpr NumberRange kGrooveOffset{.low = -1e6, .high = 1e6};
constexpr std::size_t kMaxGrooves = 1000;

constexpr Row kGrooveRows[] = {
    {kGrooveForm, Word{kGrooveFormWords}, "custom",
     "Way in which the groove sets are given. `\"custom\"`: by the tables `[grooves.a]`, `[grooves.b]`, and so on. "
     "The other forms have three sets whose faces are perpendicular to each other. `\"equilateral\"`: cube corners "
     "without cant. `\"base_angles\"`: by the angles of the base triangle. `\"canted\"`: isosceles base triangles with "
     "a given cant."},
    {"spacing_mm", kSize, kRequired,
     "Distance between neighbouring grooves of the set a. The spacings of the other sets follow from the form.",
     kShortForms},
    {"base_angles_deg", Numbers{3, {.low = 0.0, .low_included = false, .high = 90.0, .high_included = false}, "angles"},
     kRequired,
     "Angles of the base triangle, opposite to the sets a, b and c. Each is below 90 degrees, and their sum is 180 "
     "degrees.",
     kOfBaseAngles},
    {"cant_deg", Number{{.low = 0.0, .high = 30.0}}, kRequired, "Angle between +z and the axes of the cube corners.",
     kOfCanted},
    {"cant_direction", Word{kCantDirections}, "face_more_parallel",
     "Direction of the cant. `\"face_more_parallel\"`: the faces of the set a are less steep than without cant. "
     "`\"edge_more_parallel\"`: the opposite dihedral edges are less steep.",
     kOfCanted},
    {"depth_mm", kSize, Computed{"so large that the pyramids end in points"},
     "Depth of the deepest grooves, measured from the flat face of the blank. Pyramids that would be higher than the "
     "blank have flat tops."},
    {"bottom_flat_um", Number{{.low = 0.0}}, 0.0,
     "Width of a flat that replaces the bottom of each groove. The planes of the groove faces do not change."},
    {"bottom_radius_um", Number{{.low = 0.0}}, 0.0,
     "Radius of an arc that replaces the bottom of each groove and is tangent to its faces. Not together with "
     "`bottom_flat_um`."}};

constexpr Row kGrooveSetRows[] = {
    {"azimuth_deg", Number{kAzimuth}, kRequired, "Direction of the grooves, measured from +x towards +y.", kOfCustom},
    {"spacing_mm", NumberOrNumbers{{.low = 1e-6, .high = 1e6}}, kRequired,
     "Distance between neighbouring grooves, or a list of distances that repeats.", kOfCustom},
    {"half_angle_deg", Number{kHalfAngle}, kRequired,
     "Angle between the vertical and both faces of each groove, or `[[left, right], ...]`: angles of the left and the "
     "right face of each groove, seen along the azimuth. The list repeats.",
     kOfCustom},
    {"half_angle_deg", NumberRows{2, kHalfAngle, 1, kMaxGrooves, "pairs"}, kNone, "Angles of each groove.", kOfCustom},
    {"offset_mm", Number{kGrooveOffset}, 0.0,
     "Displacement of the grooves to the left, seen along the azimuth. Without it, one groove of a set of the form "
     "`custom` passes through the origin, which is the centre of a finite part."},
    {"half_angle_error_arcmin", Number{kHalfAngleError}, 0.0,
     "Angle that is added to both half-angles, or `[[left, right], ...]`: angles that are added to the half-angles of "
     "each groove. The list repeats. Such a list spreads the returned light."},
    {"half_angle_error_arcmin", NumberRows{2, kHalfAngleError, 1, kMaxGrooves, "pairs"}, kNone,
     "Angles that are added to the half-angles of each groove."},
    {"spacing_error_um", Number{kMicrometres}, 0.0, "Length that is added to all spacings of the set."},
    {"depth_error_um", Number{kMicrometres}, 0.0,
     "Depth by which the grooves of this set are deeper than those of other sets with smaller values."}};

}  // namespace

std::span<const Row> groove_rows() {
  return kGrooveRows;
}
std::span<const Row> groove_set_rows() {
  return kGrooveSetRows;
}

}  // namespace retrace::design
