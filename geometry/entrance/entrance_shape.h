#pragma once

// Curved entrance faces that are described by a few numbers or by a formula, and the inclination of these faces.

#include <array>
#include <memory>
#include <string>
#include <string_view>
#include <variant>

#include "core/math/formula.h"
#include "geometry/surface/sag.h"
#include "geometry/surface/step_face.h"
#include "geometry/vec.h"

namespace retrace::geometry {

// Each shape defines a height z(x, y) in its own frame. The origin is the middle of the surface, and the material is
// below the surface. A radius of curvature is positive if the centre of curvature is on the side of the material, so
// that the surface is convex towards the light.

struct PlaneEntrance {};

/// Cylinder with its axis parallel to y. Its cross section is a conic.
struct CylinderEntrance {
  double radius_mm = 1.0;  ///< radius of curvature at the vertex, not 0
  double conic = 0.0;      ///< conic constant; 0 is a circle
};

/// Conic of revolution.
struct SphereEntrance {
  double radius_mm = 1.0;  ///< radius of curvature at the vertex, not 0
  double conic = 0.0;      ///< conic constant; 0 is a sphere
};

/// Biconic surface, see Biconic in geometry/surface/sag.h.
struct BiconicEntrance {
  std::array<double, 2> radii_mm = {1.0, 1.0};  ///< radii of curvature along x and y, not 0
  std::array<double, 2> conics{};
};

/// Height as a formula of x, y, r and theta, in mm and rad.
struct FormulaEntrance {
  std::shared_ptr<const Formula> height_mm;  ///< never null
};

/// Names of the shapes in files, in the order of the alternatives of EntranceShape.
inline constexpr std::string_view kEntranceKinds[] = {"plane", "cylinder", "sphere", "biconic", "formula", "step"};

using EntranceShape =
    std::variant<PlaneEntrance, CylinderEntrance, SphereEntrance, BiconicEntrance, FormulaEntrance, StepFace>;

/// Parses the formula of a FormulaEntrance.
/// \throw InputError at `where`, with the position of the error in the formula
FormulaEntrance parse_entrance_formula(const std::string& text, const InputLocation& where);

/// Returns the height of a shape in its own frame.
/// \pre the file of a StepFace has been read
Sag height_of(const EntranceShape& shape);

/// Orientation of an entrance face relative to the elements of the part, whose axes are parallel to z. The axis of the
/// face is the z axis of the face's own frame. One vertical plane contains the axis of the face and the reference axis
/// of the part. The axis of the face is inclined from z in the direction opposite to `azimuth_deg`. Light along the
/// reference axis then comes from the azimuth `azimuth_deg`.
struct EntranceInclination {
  double incidence_deg = 0.0;  ///< angle between the reference axis and the axis of the face, 0..60
  double azimuth_deg = 0.0;    ///< azimuth towards which the reference axis leans away from the axis of the face
  double pin_angle_deg = 0.0;  ///< angle between z and the axis of the face, 0..60
};

/// Returns the rotation about a horizontal axis that turns the axis of the face from z to its inclined direction.
Eigen::Matrix3d rotation_of(const EntranceInclination& inclination);
/// Returns the unit vector along the reference axis, towards the light, in the part frame.
Vec3 reference_axis_of(const EntranceInclination& inclination);

}  // namespace retrace::geometry
