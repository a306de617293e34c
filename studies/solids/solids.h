#pragma once

// Elements, parts and moulds as closed solids for CAD and other programs. `retrace export` runs this study.

#include <cstdint>
#include <optional>
#include <string>

#include "core/warning.h"
#include "design/design.h"
#include "geometry/part/closed_boundary.h"
#include "geometry/part/exact_solid.h"
#include "requests/part.h"

namespace retrace::studies {

/// Kind of solid that is made of a design.
enum class SolidKind {
  element,  ///< one element on its plate, as with `arrangement = "single"`
  array,    ///< whole part
  mould     ///< block behind the back surface of the part, with which the part is moulded
};

std::string name_of(SolidKind kind);

/// Description of a curved entrance face in a solid.
enum class SolidEntrance {
  triangles,  ///< triangles within a tolerance
  exact       ///< one face on the exact surface or on a B-spline within a tolerance, for STEP
};

/// Maximum number of elements of a solid. The whole boundary is one mesh in memory.
inline constexpr std::int64_t kMaxSolidElements = 200'000;

/// Closed boundary of a solid, with its measures.
struct Solid {
  design::Design design;
  SolidKind what = SolidKind::array;
  double block_mm = 0.0;  ///< thickness of a mould below its deepest point; 0 for other solids
  /// Maximum distance along z between a curved entrance face and its triangles or its B-spline. Not set for plane faces
  /// and for moulds.
  std::optional<double> surface_error_mm;
  geometry::BoundaryMesh mesh;
  /// Boundary with an exact entrance face. Set only for SolidEntrance::exact and a curved entrance face that is not a
  /// mesh. Volume and area are then those of this boundary, and `mesh` is empty.
  std::optional<geometry::ExactSolid> exact;
  std::int64_t elements_full = 0;
  std::int64_t elements_partial = 0;
  double volume_mm3 = 0.0;
  double area_mm2 = 0.0;
  geometry::Vec3 lower_mm = geometry::Vec3::Zero();
  geometry::Vec3 upper_mm = geometry::Vec3::Zero();
  bool is_manifold = true;  ///< true: the solid does not touch itself along an edge
  Warnings warnings;
};

/// Default of the permitted distance along z between an exact entrance surface and its triangles.
inline constexpr double kSurfaceErrorMm = 0.001;
/// Default of the permitted distance along z between an exact entrance surface and its B-spline.
inline constexpr double kSplineErrorMm = 1e-6;

/// Builds the closed boundary of the requested solid. Its facets are plane and smooth: of the design's table [surface],
/// only the angle errors and the edges are used.
/// \param model description of a curved entrance face
/// \throw InputError if the request is invalid, if a whole infinite array is requested, if the mask cannot be read, if
///     the solid has more than kMaxSolidElements elements, or if one element is requested behind a curved entrance face
Solid make_solid(const design::Design& design, const SolidRequest& request,
                 SolidEntrance model = SolidEntrance::triangles);

}  // namespace retrace::studies
