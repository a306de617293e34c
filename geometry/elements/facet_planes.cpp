#include "geometry/elements/facet_planes.h"

#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <utility>

#include "core/error.h"
#include "geometry/direction.h"
#include "geometry/elements/plane_polygon.h"

namespace retrace::geometry {

FacetPlanes::FacetPlanes(std::vector<ElementPlanes> elements, double spacing_mm)
    : elements_(std::move(elements)), spacing_mm_(spacing_mm) {
  for (std::size_t i = 0; i < elements_.size(); ++i)
    if (!index_of_key_.try_emplace(key_of(elements_[i].centre_mm), i).second)
      throw InputError("two elements have the same position");
}

FacetPlanes::Key FacetPlanes::key_of(const Vec2& centre_mm) const {
  return {std::llround(2.0 * centre_mm.x() / spacing_mm_), std::llround(2.0 * centre_mm.y() / spacing_mm_)};
}

const ElementPlanes* FacetPlanes::at(const Vec2& centre_mm) const {
  constexpr double kSameShare = 0.01;
  const Key key = key_of(centre_mm);
  for (std::int64_t dx = -1; dx <= 1; ++dx)
    for (std::int64_t dy = -1; dy <= 1; ++dy) {
      const auto found = index_of_key_.find({key.first + dx, key.second + dy});
      if (found == index_of_key_.end()) continue;
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

void add_flares(std::vector<ElementPlanes>& elements, double radius_mm) {
  using Key = std::pair<std::int64_t, std::int64_t>;
  // The centres of hexagons are at multiples of this step from the first centre.
  const Vec2 step = radius_mm * Vec2(1.5, 0.5 * std::numbers::sqrt3);
  const Vec2 first = elements.front().centre_mm;
  const auto key_of = [&](const Vec2& at) {
    return Key{std::llround((at - first).x() / step.x()), std::llround((at - first).y() / step.y())};
  };
  const auto corner = [&](std::size_t k) -> Vec2 {
    return radius_mm * direction_at(Angle::from_deg(120.0 * static_cast<double>(k)));
  };
  std::set<Key> cut;
  for (const ElementPlanes& element : elements) cut.insert(key_of(element.centre_mm));
  std::map<Key, ElementPlanes> land;
  for (const ElementPlanes& element : elements)
    for (std::size_t k = 0; k < 3; ++k)
      for (const std::size_t other : {(k + 1) % 3, (k + 2) % 3}) {
        const Vec2 centre_mm = element.centre_mm + corner(k) - corner(other);
        if (cut.contains(key_of(centre_mm))) continue;
        ElementPlanes& place = land[key_of(centre_mm)];
        place.planes.clear();
        place.centre_mm = centre_mm;
        // Plane of the facet opposite to the dihedral edge `other`, with its height converted to the new centre.
        HeightPlane plane = element.planes[(other + 1) % 3];
        plane.height_mm += plane.slope.dot(centre_mm - element.centre_mm);
        if (!place.flares[other]) place.flares[other] = plane;
      }
  for (auto& [key, place] : land) elements.push_back(std::move(place));
}

double cube_spacing_mm(const Element& element) {
  // The apexes of neighbouring triangles are half a radius apart along x, which is a third of the triangle's height.
  constexpr double kNearest = 1.0 / 3.0;
  return kNearest * bounding_box(aperture_outline(element)).size().minCoeff();
}

Vec2 reference_position(const PartSpec& spec, const Cell& cell) {
  if (cell.is_element && !std::holds_alternative<RtpElement>(spec.element)) return cell.at_mm;
  return bounding_box(cell.outline).centre();
}

Cell cell_with_planes(const Cell& cell, const ElementPlanes& element, const Vec2& centre_mm) {
  const auto own_plane = [&](HeightPlane plane) {
    plane.height_mm -= plane.slope.dot(centre_mm);
    return plane;
  };
  Cell own = cell;
  own.facets.clear();
  for (const HeightPlane& plane : element.planes) {
    const std::size_t k = own.facets.size();
    const bool is_of_element = element.planes.size() == cell.facets.size();
    own.facets.push_back({{}, own_plane(plane), false, is_of_element ? cell.facets[k].centroid_mm : std::nullopt});
  }
  own.facets = upper_envelope_of(cell.outline, std::move(own.facets));
  std::vector<CellFacet> caps;
  for (const std::optional<HeightPlane>& cap : element.caps)
    if (cap) caps.push_back({{}, own_plane(*cap)});
  if (caps.size() != own.facets.size()) caps.clear();
  for (std::size_t k = 0; k < caps.size(); ++k) {
    CellFacet& facet = own.facets[k];
    caps[k].outline = where_higher(cell.outline, caps[k].plane, facet.plane);
    for (std::size_t other = 0; other < caps.size() && !caps[k].outline.empty(); ++other)
      if (other != k) caps[k].outline = where_higher(caps[k].outline, caps[other].plane, caps[k].plane);
    if (!facet.outline.empty()) facet.outline = where_higher(facet.outline, facet.plane, caps[k].plane);
  }
  own.facets.insert(own.facets.end(), caps.begin(), caps.end());
  std::erase_if(own.facets, [](const CellFacet& facet) { return facet.outline.empty(); });
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
    flare.is_edge = true;  // a flare is not a facet of an element: a neighbour's cavity cuts this land
    land.facets.push_back(std::move(flare));
  }
  return land;
}

}  // namespace retrace::geometry
