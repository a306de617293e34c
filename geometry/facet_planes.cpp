#include "geometry/facet_planes.h"

#include <cmath>
#include <utility>

#include "core/error.h"
#include "geometry/plane_polygon.h"

namespace retrace::geometry {

FacetPlanes::FacetPlanes(std::vector<ElementPlanes> elements, double spacing_mm)
    : elements_(std::move(elements)), spacing_mm_(spacing_mm) {
  for (std::size_t i = 0; i < elements_.size(); ++i)
    if (!places_.try_emplace(key_of(elements_[i].centre_mm), i).second)
      throw InputError("two elements lie in one place");
}

FacetPlanes::Key FacetPlanes::key_of(const Vec2& centre_mm) const {
  return {std::llround(2.0 * centre_mm.x() / spacing_mm_), std::llround(2.0 * centre_mm.y() / spacing_mm_)};
}

const ElementPlanes* FacetPlanes::at(const Vec2& centre_mm) const {
  constexpr double kSameShare = 0.01;
  const Key key = key_of(centre_mm);
  for (std::int64_t dx = -1; dx <= 1; ++dx)
    for (std::int64_t dy = -1; dy <= 1; ++dy) {
      const auto found = places_.find({key.first + dx, key.second + dy});
      if (found == places_.end()) continue;
      const ElementPlanes& element = elements_[found->second];
      if ((element.centre_mm - centre_mm).norm() < kSameShare * spacing_mm_) return &element;
    }
  return nullptr;
}

Cell cell_with_planes(const Cell& cell, const ElementPlanes& element, const Vec2& centre_mm) {
  std::array<HeightPlane, 2> planes = element.planes;
  for (HeightPlane& plane : planes) plane.height_mm -= plane.slope.dot(centre_mm);
  Cell own = cell;
  own.facets.clear();
  for (const std::size_t k : {0U, 1U}) {
    CellFacet facet;
    facet.plane = planes[k];
    facet.outline = where_higher(cell.outline, planes[k], planes[1 - k]);
    if (!facet.outline.empty()) own.facets.push_back(std::move(facet));
  }
  return own;
}

}  // namespace retrace::geometry
