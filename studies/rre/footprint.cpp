#include "studies/rre/footprint.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>

namespace retrace::studies {
namespace {

using geometry::Polygon, geometry::Vec2;

// Difference of efficiencies below which neighbouring polygons are merged into one region.
constexpr double kEqualEfficiency = 1e-9;
// Distance below which corners are merged, as a fraction of an element.
constexpr double kMergeFraction = 1e-11;
// Magnitude of the normal's z component below which a facet counts as a wall, which is seen edge-on from above.
constexpr double kWall = 1e-6;

/// Rounds coordinates to 1e-12 mm, which removes rounding errors.
Vec2 rounded(const Vec2& p) {
  constexpr double kSteps = 1e12;
  return {std::round(p.x() * kSteps) / kSteps + 0.0, std::round(p.y() * kSteps) / kSteps + 0.0};
}

/// Returns the outline with the lowest corner first. If several corners are lowest, the leftmost of them is first.
Polygon outline_of(const raytrace::FlatPolygon& polygon) {
  Polygon outline;
  for (const Vec2& p : polygon) outline.push_back(rounded(p));
  const auto is_lower = [](const Vec2& a, const Vec2& b) { return a.y() < b.y() || (a.y() == b.y() && a.x() < b.x()); };
  std::rotate(outline.begin(), std::min_element(outline.begin(), outline.end(), is_lower), outline.end());
  return outline;
}

bool lies_before(const ActiveRegion& a, const ActiveRegion& b) {
  for (std::size_t k = 0; k < std::min(a.outline_mm.size(), b.outline_mm.size()); ++k) {
    const Vec2& p = a.outline_mm[k];
    const Vec2& q = b.outline_mm[k];
    if (p.y() != q.y()) return p.y() < q.y();
    if (p.x() != q.x()) return p.x() < q.x();
  }
  return a.outline_mm.size() < b.outline_mm.size();
}

}  // namespace

double Footprint::rre_contribution() const {
  double power = 0.0;
  for (const ActiveRegion& region : regions) power += geometry::area(region.outline_mm) * region.efficiency;
  return power / entrance_area_mm2;
}

FootprintBuilder::FootprintBuilder(const geometry::Part& part, std::size_t cones)
    : entrance_area_mm2_(part.entrance_area_mm2),
      size_mm_(part.size_mm),
      period_mm_(part.period_mm),
      cones_(cones),
      overlay_(part.size_mm) {}

void FootprintBuilder::add(const raytrace::ReturnedBeam& beam) {
  const bool is_shown = beam.depth > 0 && beam.cone < cones_ && beam.efficiency >= Footprint::kMinEfficiency;
  if (!is_shown) return;
  const raytrace::FlatPolygon entered(beam.entry_polygon_mm.begin(), beam.entry_polygon_mm.end());
  if (!beam.instance_offsets) {
    overlay_.insert(entered, beam.efficiency);
    return;
  }
  for (const Vec2& by : *beam.instance_offsets) {
    raytrace::FlatPolygon there = entered;
    for (Vec2& p : there) p += by;
    insert(there, beam.efficiency);
  }
}

/// Inserts a region through which light enters. For an infinite part, regions beyond the period are shifted back by one
/// period.
void FootprintBuilder::insert(const raytrace::FlatPolygon& entered, double efficiency) {
  if (!period_mm_) {
    overlay_.insert(entered, efficiency);
    return;
  }
  const double merge_mm = kMergeFraction * size_mm_;
  for (const double i : {0.0, 1.0})
    for (const double j : {0.0, 1.0}) {
      const Vec2 from = Vec2(i, j).cwiseProduct(*period_mm_);
      const Polygon period = geometry::to_polygon({from, from + *period_mm_});
      raytrace::FlatPolygon piece = raytrace::intersection(entered, {period.begin(), period.end()}, merge_mm);
      for (Vec2& p : piece) p -= from;
      overlay_.insert(piece, efficiency);
    }
}

Footprint FootprintBuilder::finish() const {
  Footprint footprint;
  footprint.entrance_area_mm2 = entrance_area_mm2_;
  for (const raytrace::ValuedPolygon& piece : raytrace::fused(overlay_.polygons(), size_mm_, kEqualEfficiency)) {
    footprint.regions.push_back({outline_of(piece.polygon), piece.value});
    footprint.active_area_mm2 += raytrace::area(piece.polygon);
  }
  std::sort(footprint.regions.begin(), footprint.regions.end(), lies_before);
  return footprint;
}

namespace {

using Edge = std::pair<std::uint32_t, std::uint32_t>;

/// Returns the edges of the facets of an element, without facets that are walls, and the number of facets at each edge.
std::map<Edge, int> edges_of(const geometry::SurfacePatch& patch, const geometry::PatchCell& cell) {
  std::map<Edge, int> edges;
  for (std::uint32_t f = cell.first_facet; f < cell.first_facet + cell.facet_count; ++f) {
    const geometry::PatchFacet& facet = patch.facets[f];
    if (facet.role != geometry::FacetRole::retro_facet || std::abs(facet.normal.z()) < kWall) continue;
    for (std::uint32_t c = 0; c < facet.corner_count; ++c) {
      const std::uint32_t from = patch.corners[facet.first_corner + c];
      const std::uint32_t to = patch.corners[facet.first_corner + (c + 1) % facet.corner_count];
      ++edges[std::minmax(from, to)];
    }
  }
  return edges;
}

}  // namespace

EntranceFace entrance_face_of(const geometry::Part& part) {
  EntranceFace face;
  face.is_periodic = part.period_mm.has_value();
  face.outline_mm = face.is_periodic ? geometry::to_polygon({Vec2::Zero(), *part.period_mm}) : part.outline;
  const geometry::Rectangle shown = geometry::bounding_box(face.outline_mm);
  for (const geometry::Placement& placement : part.placements) {
    const geometry::SurfacePatch& patch = part.patches[placement.patch];
    const auto place_of = [&](std::uint32_t vertex) -> Vec2 {
      return patch.vertices[vertex].head<2>() + placement.offset_mm;
    };
    for (const geometry::PatchCell& cell : patch.cells) {
      const Vec2 lower = cell.lower.head<2>() + placement.offset_mm;
      const Vec2 upper = cell.upper.head<2>() + placement.offset_mm;
      if (geometry::Rectangle{lower.cwiseMax(shown.lower), upper.cwiseMin(shown.upper)}.empty()) continue;
      for (const auto& [edge, facets] : edges_of(patch, cell))
        (facets > 1 ? face.roots_mm : face.rims_mm).push_back({place_of(edge.first), place_of(edge.second)});
    }
  }
  return face;
}

}  // namespace retrace::studies
