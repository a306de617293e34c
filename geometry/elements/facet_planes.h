#pragma once

// Elements whose facets have individual planes, from a measurement or from the simulation of a machining program.

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "geometry/elements/element_cells.h"
#include "geometry/elements/part_spec.h"

namespace retrace::geometry {

/// Planes of the facets of one element: z = height_mm + slope . (p - centre_mm).
struct ElementPlanes {
  Vec2 centre_mm = Vec2::Zero();  ///< centre of a prism's aperture, or apex of a cube corner, in the part frame
  /// Prism: facets towards -x and +x (rotated element: -y and +y). Cube corner: facet k is between the dihedral edges
  /// at 120 k and 120 (k + 1) degrees. An empty list means that the element is missing; only `flares` are then used.
  std::vector<HeightPlane> planes = std::vector<HeightPlane>(2);
  /// Cuts in the flat land that replaces a missing hexagonal cube corner. The machined cavities of the neighbouring
  /// elements are triangular and extend into the corners of this land. Cut k removes the corner at 120 k degrees, up to
  /// the line between the two adjacent corners.
  std::array<std::optional<HeightPlane>, 3> flares;
  /// Cube corner: planes that a chisel with a straight edge leaves at the apex, in front of facet k. At each point, the
  /// lowest of these planes is compared with the highest facet plane, and the surface is at the height of the higher
  /// one. Either all three planes are given or none.
  std::array<std::optional<HeightPlane>, 3> caps;
};

/// Adds the flares, which are cuts in the land of missing hexagonal cube corners. Hexagonal cube corners are machined
/// as triangular cavities. A hexagon's corner at a dihedral edge is also a corner of two neighbouring hexagons. If a
/// neighbour is missing, a facet of the hexagon's cavity extends across this corner into the land of the neighbour
/// (docs/theory/micro_chiseling.md).
/// \param elements all elements that exist, at least one
/// \param radius_mm radius of the apertures of the elements
void add_flares(std::vector<ElementPlanes>& elements, double radius_mm);

/// Returns the parameter `spacing_mm` of FacetPlanes for cube corners.
double cube_spacing_mm(const Element& element);

/// Elements with individual facet planes. Elements of the array that are not in this list are missing.
class FacetPlanes {
 public:
  /// \param spacing_mm minimum distance between the centres of two elements along x or y; > 0
  FacetPlanes(std::vector<ElementPlanes> elements, double spacing_mm);
  /// Returns the element whose centre is at this position, with a tolerance of a hundredth of the spacing. Returns null
  /// if there is no such element.
  const ElementPlanes* at(const Vec2& centre_mm) const;
  std::size_t size() const { return elements_.size(); }
  /// Returns the number of elements. Land with flares is not counted.
  std::size_t element_count() const;
  const std::vector<ElementPlanes>& elements() const { return elements_; }

 private:
  using Key = std::pair<std::int64_t, std::int64_t>;
  Key key_of(const Vec2& centre_mm) const;

  std::vector<ElementPlanes> elements_;
  double spacing_mm_ = 1.0;
  std::map<Key, std::size_t> index_of_key_;
};

/// Returns the reference position of a cell, as ElementPlanes::centre_mm defines it. The reference position of land is
/// its centre.
Vec2 reference_position(const PartSpec& spec, const Cell& cell);

/// Returns the element at the position of `cell`, with individual facet planes. Each facet ends where its plane
/// intersects the planes of the other facets.
/// \param centre_mm reference position of the cell, as returned by reference_position(), in the coordinates of the cell
Cell cell_with_planes(const Cell& cell, const ElementPlanes& element, const Vec2& centre_mm);

/// Returns land on z = 0 that replaces a missing hexagonal cube corner, without the corners that the flares cut off.
/// \pre the outline of `cell` is the hexagon, beginning with its corner at 0 degrees
Cell flared_land(const Cell& cell, const ElementPlanes& element, const Vec2& centre_mm);

}  // namespace retrace::geometry
