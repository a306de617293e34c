#include "design/io/design_rows.h"
#include "geometry/entrance/entrance_shape.h"
#include "geometry/io/step_rows.h"

namespace retrace::design {
namespace {

using namespace schema;

constexpr NumberRange kPositionMm{.low = -1e6, .high = 1e6};
constexpr NumberRange kRadiusOfFace{.low = -1e9, .high = 1e9};
constexpr NumberRange kConicOfFace{.low = -1e6, .high = 1e6};
constexpr NumberRange kInclinationDeg{.low = 0.0, .high = 60.0};
constexpr Words kSidesOfMesh = {"top", "bottom"};
constexpr double kNoConics[] = {0.0, 0.0};

constexpr Condition kFormOnly[] = {
    is_absent("turned_part", "not allowed together with turned_part, because a part has only one entrance surface"),
    is_absent("mesh", "not allowed together with mesh, because a part has only one entrance surface")};
constexpr Condition kTurnedOnly[] = {
    is_absent("mesh", "not allowed together with mesh, because a part has only one entrance surface")};
constexpr Condition kMeshOnlyKeys[] = {is_given("mesh")};
constexpr Condition kFormGiven[] = {is_given("kind")};
constexpr Condition kConicalOnly[] = {is("kind", only(geometry::kEntranceKinds, "cylinder", "sphere"))};
constexpr Condition kBiconicOnly[] = {is("kind", only(geometry::kEntranceKinds, "biconic"))};
constexpr Condition kAllButStep[] = {is("kind", only(geometry::kEntranceKinds, "plane", "formula"))};
constexpr Condition kStepOnly[] = {is("kind", only(geometry::kEntranceKinds, "step"))};
constexpr Condition kFormulaOnly[] = {is("kind", only(geometry::kEntranceKinds, "formula"))};

constexpr Row kEntranceRows[] = {
    {"kind", Word{geometry::kEntranceKinds}, kNone,
     "Shape of the entrance surface, if it is not given by a mesh or a turned part. `\"biconic\"` has different radii "
     "along x and y. `\"step\"` is a face of a STEP file.",
     kFormOnly},
    {"radius_mm", Number{kRadiusOfFace}, kRequired,
     "Radius of curvature at the vertex, not 0. If it is positive, the surface is convex towards the light; if it is "
     "negative, the surface is concave. The axis of a cylinder is parallel to y before the rotation.",
     kConicalOnly},
    {"conic", Number{kConicOfFace}, 0.0, "Conic constant of the surface. 0 is a circle, -1 a parabola.", kConicalOnly},
    {"radii_mm", Numbers{2, kRadiusOfFace, "radii, along x and y"}, kRequired,
     "`[x, y]`: radii of curvature at the vertex, not 0. The signs are those of `radius_mm`.", kBiconicOnly},
    {"conics", Numbers{2, kConicOfFace, "conic constants, along x and y"}, std::span<const double>(kNoConics),
     "`[x, y]`: conic constants.", kBiconicOnly},
    {"formula", Text{"a formula of x, y, r and theta, such as \"-r^2 / 800\""}, kRequired,
     "Height of the surface in mm, positive towards the light, as a formula of `x`, `y`, `r` and `theta` (in mm and "
     "rad), measured from the origin of the surface. The formula has the same elements as `substrate.sag_mm`.",
     kFormulaOnly},
    where(geometry::kStepFileRow, kStepOnly),
    where(geometry::kStepFaceRow, kStepOnly),
    where(geometry::kStepSewRow, kStepOnly),
    where(geometry::kStepOriginRow, kStepOnly),
    where(geometry::kStepRotationRow, kStepOnly),
    {"rotation_deg", Number{kAzimuth}, 0.0, "Rotation of the surface about its axis, from +x towards +y.", kAllButStep},
    {"incidence_deg", Number{kInclinationDeg}, 0.0,
     "Angle between the reference axis (the axis of the vehicle, H = V = 0 in photometry) and the axis of the surface, "
     "which is its normal at the origin.",
     kFormGiven},
    {"azimuth_deg", Number{kAzimuth}, 0.0,
     "Azimuth of the direction in which the reference axis leans away from the axis of the surface, measured from +x "
     "towards +y.",
     kFormGiven},
    {"pin_angle_deg", Number{kInclinationDeg}, Computed{"the angle of refraction of light along the reference axis"},
     "Angle between the axes of the elements, which are parallel to z, and the axis of the surface. By default, light "
     "along the reference axis is refracted at the origin into the direction of the elements, at the wavelength of the "
     "design (for a spectrum, at its centroid).",
     kFormGiven},
    renamed("turned", Row{"turned_part", File{"a turned part"}, kNone,
                          "File of a turned part (turning_file.md). The entrance surface is its exact surface, not an "
                          "approximation by triangles. The material is below the surface.",
                          kTurnedOnly}),
    {"mesh", File{"an STL file"}, kNone, "STL mesh of the entrance surface, binary or ASCII."},
    {"scale", kSize, 1.0, kScaleMeaning, kMeshOnlyKeys},
    {"mesh_side", Word{kSidesOfMesh}, "top",
     "Side of the mesh that is the entrance surface. `\"top\"`: the triangles that face +z. `\"bottom\"`: the "
     "triangles that face -z, with reversed orientation. `\"bottom\"` is needed for `machined.stl` of `retrace turn`, "
     "which is the counterpart that is moulded in the turned surface.",
     kMeshOnlyKeys},
    {"centre_mm", Numbers{2, kPositionMm, "coordinates, x and y"}, Computed{"the centre of the part"},
     "`[x, y]`: position of the origin of the surface, or of the file, in the part frame."}};

}  // namespace

std::span<const Row> entrance_rows() {
  return kEntranceRows;
}

}  // namespace retrace::design
