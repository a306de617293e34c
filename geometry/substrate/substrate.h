#pragma once

// Describes the substrate: the surface on which elements are placed instead of the plane z = 0.

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <string_view>
#include <variant>

#include "core/math/formula.h"
#include "geometry/surface/step_face.h"

namespace retrace::geometry {

/// Plane that rises by `incline_deg` towards `azimuth_deg`. The azimuth is counted from +x towards +y.
struct PlaneSubstrate {
  double incline_deg = 0.0;  ///< 0..60
  double azimuth_deg = 0.0;
};

/// Cylinder with its axis along x or y, above or below the centre of the part.
struct CylinderSubstrate {
  double radius_mm = 0.0;  ///< > 0: convex towards the light; < 0: concave
  bool axis_is_x = false;
};

/// Sphere with its pole at the centre of the part.
struct SphereSubstrate {
  double radius_mm = 0.0;  ///< > 0: convex towards the light; < 0: concave
};

/// Height as a formula of x and y. The height, x and y are in mm; x and y are measured from the centre of the part.
struct FormulaSubstrate {
  std::shared_ptr<const Formula> sag_mm;  ///< never null
};
/// Parses a formula.
/// \throw InputError with the position of the error, if the text is not a formula of x and y
FormulaSubstrate formula_substrate(std::string_view sag_mm);

/// Surface at a given wall thickness below an entrance surface. The wall is between the nominal rim of an element and
/// the entrance surface, measured along z. Each element is placed at the height at which its wall is `wall_mm` at the
/// thinnest point. The axes of the elements are parallel to z.
struct OffsetSubstrate {
  double wall_mm = 0.0;  ///< > 0
  /// Returns the height of the entrance surface in mm, relative to the surface's origin. The argument is a position
  /// relative to the centre of the part. The function is set after the entrance surface has been read.
  std::function<double(const Eigen::Vector2d& position_mm)> entrance_mm = {};
};

using SubstrateShape =
    std::variant<PlaneSubstrate, CylinderSubstrate, SphereSubstrate, FormulaSubstrate, OffsetSubstrate, StepFace>;

/// Orientation of elements on a substrate.
enum class ElementAxes {
  normal,   ///< along the substrate's normal at the element's centre; sizes and gaps are arc lengths
  parallel  ///< all elements are upright and shifted along z; sizes and gaps are lengths in plan
};

/// Surface on which elements are placed. It is shifted along z such that its highest point over the part is on z = 0.
struct Substrate {
  SubstrateShape shape;
  ElementAxes element_axes = ElementAxes::normal;
};

}  // namespace retrace::geometry
