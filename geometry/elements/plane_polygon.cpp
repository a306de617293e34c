#include "geometry/elements/plane_polygon.h"

#include <cstddef>

namespace retrace::geometry {

Polygon where_higher(const Polygon& polygon, const HeightPlane& plane, const HeightPlane& other) {
  Polygon kept;
  const auto excess = [&](const Vec2& p) { return plane.at(p) - other.at(p); };
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2& a = polygon[i];
    const Vec2& b = polygon[(i + 1) % polygon.size()];
    const double at_a = excess(a);
    const double at_b = excess(b);
    if (at_a >= 0.0) kept.push_back(a);
    if ((at_a > 0.0 && at_b < 0.0) || (at_a < 0.0 && at_b > 0.0)) kept.push_back(a + (b - a) * (at_a / (at_a - at_b)));
  }
  if (kept.size() < 3) kept.clear();
  return kept;
}

std::vector<CellFacet> upper_envelope_of(const Polygon& outline, std::vector<CellFacet> planes) {
  for (CellFacet& facet : planes) {
    facet.outline = outline;
    for (const CellFacet& other : planes)
      if (&other != &facet && !facet.outline.empty())
        facet.outline = where_higher(facet.outline, facet.plane, other.plane);
  }
  return planes;
}

}  // namespace retrace::geometry
