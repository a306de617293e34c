#pragma once

// What elements stand on in place of a plane, as a designer says it.

#include <memory>
#include <string_view>
#include <variant>

#include "core/math/formula.h"

namespace retrace::geometry {

/// A plane that rises by `incline_deg` towards `azimuth_deg`, from +x towards +y.
struct PlaneSubstrate {
  double incline_deg = 0.0;  ///< 0..60
  double azimuth_deg = 0.0;
};

/// A cylinder with its axis along x or y over the middle of the part.
struct CylinderSubstrate {
  double radius_mm = 0.0;  ///< > 0: it bulges towards the light; < 0: its hollow side
  bool axis_is_x = false;
};

/// A sphere with its pole over the middle of the part.
struct SphereSubstrate {
  double radius_mm = 0.0;  ///< as of a cylinder
};

/// A height over the plane as a formula of x and y in mm from the middle of the part.
struct FormulaSubstrate {
  std::shared_ptr<const Formula> sag_mm;  ///< never null
};
/// \throw InputError saying where the text is no formula of x and y
FormulaSubstrate formula_substrate(std::string_view sag_mm);

using SubstrateShape = std::variant<PlaneSubstrate, CylinderSubstrate, SphereSubstrate, FormulaSubstrate>;

/// How elements stand on a substrate.
enum class ElementAxes {
  normal,   ///< each along the substrate's normal under its middle; sizes and gaps are arc lengths
  parallel  ///< all upright, moved along z alone; sizes and gaps are those in plan
};

/// The surface on which elements stand, in place of z = 0. What it is highest over the part is z = 0.
struct Substrate {
  SubstrateShape shape;
  ElementAxes element_axes = ElementAxes::normal;
};

}  // namespace retrace::geometry
