#include "design/azimuth_symmetry.h"

#include "core/overloaded.h"

namespace retrace::design {
namespace {

using geometry::Arrangement;

bool is_unpolarised(const raytrace::Stokes& s) {
  return s.q == 0.0 && s.u == 0.0 && s.v == 0.0;
}

/// Returns true if all facets of an element are equivalent and all elements are equal.
bool is_regular(const geometry::PartSpec& part) {
  const auto& edges = part.angle_errors.dihedral_error_arcmin;
  const auto& tilts = part.angle_errors.facet_tilt_arcmin;
  const bool is_prism = std::holds_alternative<geometry::RtpElement>(part.element);
  const bool edges_are_alike = is_prism || (edges[0] == edges[1] && edges[1] == edges[2]);
  const bool tilts_are_alike = tilts[0] == tilts[1] && (is_prism || tilts[1] == tilts[2]);
  return edges_are_alike && tilts_are_alike && part.random_tilts.sigma_arcmin == 0.0 && part.scratches.empty() &&
         !part.substrate;
}

/// Returns the symmetry of an array of cube corners. Returns nothing if they are canted.
/// \param cube complete cube corner; it is mirror-symmetric about three planes through its axis
template <class Cube>
std::optional<AzimuthSymmetry> of_cubes(const Cube& cube, double period_deg) {
  if (cube.cant.deg != 0.0) return std::nullopt;
  return AzimuthSymmetry{period_deg, 0.0};
}

std::optional<AzimuthSymmetry> symmetry_of(const geometry::PartSpec& part) {
  const geometry::ArrayLayout& array = part.array;
  return std::visit(
      Overloaded{[&](const geometry::RtpElement&) {
                   // A checker array is mapped onto itself by a rotation by 90 degrees and a shift by one cell.
                   const bool is_checker =
                       array.arrangement == Arrangement::checker && array.x_gap_mm == array.y_gap_mm;
                   return std::optional(AzimuthSymmetry{is_checker ? 90.0 : 180.0, 0.0});
                 },
                 [&](const geometry::HexagonalCube& cube) { return of_cubes(cube, 120.0); },
                 [&](const geometry::TriangularCube& cube) {
                   // In an array of triangular cube corners, every second cell is rotated by 180 degrees.
                   return of_cubes(cube, array.arrangement == Arrangement::single ? 120.0 : 60.0);
                 },
                 [](const geometry::RuledCells&) { return std::optional<AzimuthSymmetry>(); },
                 [&](const geometry::RoundCube& cube) { return cube.outline ? std::nullopt : of_cubes(cube, 120.0); }},
      part.element);
}

}  // namespace

std::optional<AzimuthSymmetry> azimuth_symmetry(const Design& design) {
  if (!design.elements() || design.mask() || design.facet_planes() || design.entrance || !design.shells.empty() ||
      design.wet_back || !design.surface.entrance.is_clean() || !is_unpolarised(design.light.polarisation))
    return std::nullopt;
  const geometry::PartSpec& part = design.part();
  const bool has_like_borders = design.is_infinite() || part.array.arrangement == Arrangement::single;
  return has_like_borders && is_regular(part) ? symmetry_of(part) : std::nullopt;
}

}  // namespace retrace::design
