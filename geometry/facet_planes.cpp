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

std::size_t FacetPlanes::element_count() const {
  std::size_t count = 0;
  for (const ElementPlanes& element : elements_)
    if (!element.planes.empty()) ++count;
  return count;
}

Vec2 place_of(const PartSpec& spec, const Cell& cell) {
  if (!std::holds_alternative<RtpElement>(spec.element)) return cell.at_mm;
  const Rectangle box = bounding_box(cell.outline);
  return 0.5 * (box.lower + box.upper);
}

Cell cell_with_planes(const Cell& cell, const ElementPlanes& element, const Vec2& centre_mm) {
  std::vector<HeightPlane> planes = element.planes;
  for (HeightPlane& plane : planes) plane.height_mm -= plane.slope.dot(centre_mm);
  Cell own = cell;
  own.facets.clear();
  for (std::size_t k = 0; k < planes.size(); ++k) {
    CellFacet facet;
    facet.plane = planes[k];
    facet.outline = cell.outline;
    for (std::size_t other = 0; other < planes.size() && !facet.outline.empty(); ++other)
      if (other != k) facet.outline = where_higher(facet.outline, planes[k], planes[other]);
    if (!facet.outline.empty()) own.facets.push_back(std::move(facet));
  }
  return own;
}

Cell flared_land(const Cell& cell, const ElementPlanes& element, const Vec2& centre_mm) {
  Cell land = cell;
  land.is_element = false;
  land.facets = {CellFacet{}};
  const Polygon& hexagon = cell.outline;
  for (std::size_t k = 0; k < hexagon.size(); ++k) {
    const bool is_flared = k % 2 == 0 && element.flares[k / 2].has_value();
    if (!is_flared) {
      land.facets.front().outline.push_back(hexagon[k]);
      continue;
    }
    CellFacet flare;
    flare.plane = *element.flares[k / 2];
    flare.plane.height_mm -= flare.plane.slope.dot(centre_mm);
    flare.outline = {hexagon[(k + 5) % 6], hexagon[k], hexagon[(k + 1) % 6]};
    flare.is_edge = true;  // of a facet, though on land
    land.facets.push_back(std::move(flare));
  }
  return land;
}

}  // namespace retrace::geometry
