#pragma once

// Elements whose facets each have a plane of their own, as measured or as a simulated program left them, and the part
// that they make.

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "geometry/elements/element_cells.h"
#include "geometry/part/part.h"

namespace retrace::geometry {

/// The facets of one element as planes of their own: z = height_mm + slope . (p - centre_mm).
struct ElementPlanes {
  Vec2 centre_mm = Vec2::Zero();  ///< of a prism's aperture, or of a cube corner's apex, in the part frame
  /// Of a prism towards -x and +x (of a rotated element: -y and +y); of a cube corner facet k between the dihedral
  /// edges at 120 k and 120 (k + 1) degrees. None: the element is not there, and `flares` are what its place has.
  std::vector<HeightPlane> planes = std::vector<HeightPlane>(2);
  /// In the place of a hexagonal cube corner that is not there: what cavities of its neighbours, which are triangular,
  /// take of its corner at 120 k degrees, up to the line between the corners beside that one.
  std::array<std::optional<HeightPlane>, 3> flares;
  /// Of a cube corner: what a chisel with a straight edge leaves over its apex, in front of facet k: the surface is the
  /// higher of the facets and of the lowest of these. All three, or none.
  std::array<std::optional<HeightPlane>, 3> caps;
};

/// Adds the flares that triangular cavities leave beside hexagonal cube corners: a corner of a hexagon at a dihedral
/// edge is that of two others; where one of these is not there, a facet of the cavity goes on over it
/// (docs/theory/micro_chiseling.md). \param elements all that are there, at least one \param radius_mm of their
/// apertures
void add_flares(std::vector<ElementPlanes>& elements, double radius_mm);

/// FacetPlanes' spacing for cube corners.
double cube_spacing_mm(const Element& element);

/// Elements with facets of their own, such as a program left them. Elements that are not among them are not there.
class FacetPlanes {
 public:
  /// \param spacing_mm no two elements' centres are nearer than this along both axes; > 0
  FacetPlanes(std::vector<ElementPlanes> elements, double spacing_mm);
  /// The element with its centre there, up to a hundredth of the spacing; null if there is none.
  const ElementPlanes* at(const Vec2& centre_mm) const;
  std::size_t size() const { return elements_.size(); }
  /// How many of them are there, and not just land with flares.
  std::size_t element_count() const;
  const std::vector<ElementPlanes>& elements() const { return elements_; }

 private:
  using Key = std::pair<std::int64_t, std::int64_t>;
  Key key_of(const Vec2& centre_mm) const;

  std::vector<ElementPlanes> elements_;
  double spacing_mm_ = 1.0;
  std::map<Key, std::size_t> places_;
};

/// What ElementPlanes::centre_mm is of an element's cell, and the middle of land.
Vec2 place_of(const PartSpec& spec, const Cell& cell);

/// The element in the place of `cell`, its facets in planes of their own: they meet where the planes do.
/// \param centre_mm the cell's place_of() in its own coordinates
Cell cell_with_planes(const Cell& cell, const ElementPlanes& element, const Vec2& centre_mm);

/// Land on z = 0 in the place of a hexagonal cube corner, without the corners that flares take.
/// \pre the outline of `cell` is the hexagon, from its corner at 0 degrees
Cell flared_land(const Cell& cell, const ElementPlanes& element, const Vec2& centre_mm);

/// A finite part like build_part() makes it, each element with its own facets; flat land stands where an element is
/// not given. Outlines stay nominal, and vertical walls close what differs between neighbours.
/// \pre spec.array.extent is finite, facets slope as nominal ones do
/// \throw InputError as build_part(), and for planes that belong to no whole element of the array
Part build_part(const PartSpec& spec, const FacetPlanes& planes);

}  // namespace retrace::geometry
