#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "geometry/lattice.h"
#include "geometry/part.h"

namespace retrace::geometry {

/// The two facets of one prism as planes of their own.
struct ElementPlanes {
  Vec2 centre_mm = Vec2::Zero();  ///< of its aperture, in the part frame
  /// Towards -x and +x (of a turned element: -y and +y): z = height_mm + slope . (p - centre_mm).
  std::array<HeightPlane, 2> planes;
};

/// Prisms with facets of their own, such as a program left them. Elements that are not among them are not there.
class FacetPlanes {
 public:
  /// \param spacing_mm no two elements' centres are nearer than this along both axes; > 0
  FacetPlanes(std::vector<ElementPlanes> elements, double spacing_mm);
  /// The element with its centre there, up to a hundredth of the spacing; null if there is none.
  const ElementPlanes* at(const Vec2& centre_mm) const;
  std::size_t size() const { return elements_.size(); }
  const std::vector<ElementPlanes>& elements() const { return elements_; }

 private:
  using Key = std::pair<std::int64_t, std::int64_t>;
  Key key_of(const Vec2& centre_mm) const;

  std::vector<ElementPlanes> elements_;
  double spacing_mm_ = 1.0;
  std::map<Key, std::size_t> places_;
};

/// The element in the place of `cell`, its facets in planes of their own: they meet where the planes do.
/// \param centre_mm the cell's centre in its own coordinates
Cell cell_with_planes(const Cell& cell, const ElementPlanes& element, const Vec2& centre_mm);

/// A finite part of prisms like build_part() makes it, each with its own facets; flat land stands where an element is
/// not given. Outlines stay nominal, and vertical walls close what differs between neighbours.
/// \pre spec.element is a prism, spec.extent is finite, facets slope as nominal ones do
/// \throw InputError as build_part(), and for planes that belong to no whole element of the array
Part build_part(const PartSpec& spec, const FacetPlanes& planes);

}  // namespace retrace::geometry
