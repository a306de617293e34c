// Rounded and chamfered edges of elements: every edge becomes a row of plane strips.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "geometry/lattice.h"

namespace retrace::geometry {
namespace {

// Chords of the arc across a root or, half of them to either element, a rim. Even: no strip is level.
constexpr int kChords = 16;
// Strips below this share of an element's area are rounding.
constexpr double kLeastShare = 1e-12;

double tilt_of(const HeightPlane& plane) {
  return std::atan(plane.slope.norm());
}

Vec3 outward_normal(const HeightPlane& plane) {
  return Vec3(plane.slope.x(), plane.slope.y(), -1.0).normalized();
}

HeightPlane plane_through(const Vec3& point, const Vec3& normal) {
  HeightPlane plane;
  plane.slope = -normal.head<2>() / normal.z();
  plane.height_mm = point.z() - plane.slope.dot(point.head<2>());
  return plane;
}

/// The part of a convex polygon where one plane is at least as high as another.
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

/// The highest of several planes at every place of an outline.
std::vector<CellFacet> upper_envelope(const Polygon& outline, const std::vector<CellFacet>& planes) {
  const double least_mm2 = kLeastShare * area(outline);
  std::vector<CellFacet> facets;
  for (std::size_t i = 0; i < planes.size(); ++i) {
    CellFacet facet = planes[i];
    facet.outline = outline;
    for (std::size_t j = 0; j < planes.size() && !facet.outline.empty(); ++j)
      if (j != i) facet.outline = where_higher(facet.outline, planes[i].plane, planes[j].plane);
    if (!facet.outline.empty() && area(facet.outline) > least_mm2) facets.push_back(std::move(facet));
  }
  return facets;
}

/// Strips along the edge of two facets that meet in `on_edge`, on a circle that touches both.
void add_chords(std::vector<CellFacet>& planes, const CellFacet& a, const CellFacet& b, const Vec3& on_edge,
                const EdgeShape& edges) {
  const Vec3 normal_a = outward_normal(a.plane);
  const Vec3 normal_b = outward_normal(b.plane);
  const double between = std::acos(std::clamp(normal_a.dot(normal_b), -1.0, 1.0));
  const bool is_chamfer = edges.root_chamfer_mm > 0.0;
  const int chords = is_chamfer ? 1 : kChords;
  const double radius_mm = is_chamfer ? 0.5 * edges.root_chamfer_mm / std::sin(0.5 * between) : edges.root_radius_mm;
  const Vec3 centre = on_edge - radius_mm * (normal_a + normal_b) / (1.0 + normal_a.dot(normal_b));
  const double offset_mm = radius_mm * std::cos(0.5 * between / chords);
  for (int k = 0; k < chords; ++k) {
    const double share = (k + 0.5) / chords;
    const Vec3 normal =
        (std::sin((1.0 - share) * between) * normal_a + std::sin(share * between) * normal_b) / std::sin(between);
    planes.push_back({{}, plane_through(centre + offset_mm * normal, normal), true});
  }
}

/// Where all planes of an element meet: its apex, or a point of its roof.
Vec3 lowest_point(const Cell& cell) {
  const HeightPlane& a = cell.facets[0].plane;
  const HeightPlane& b = cell.facets[1].plane;
  Eigen::Matrix2d slopes;
  Vec2 heights(b.height_mm - a.height_mm, 0.0);
  slopes.row(0) = a.slope - b.slope;
  if (cell.facets.size() > 2) {
    slopes.row(1) = a.slope - cell.facets[2].plane.slope;
    heights.y() = cell.facets[2].plane.height_mm - a.height_mm;
  } else {
    slopes.row(1) = Vec2(-slopes(0, 1), slopes(0, 0));  // across: any point of the roof serves
  }
  const Vec2 at = slopes.fullPivLu().solve(heights);
  return {at.x(), at.y(), a.at(at)};
}

/// Takes the strips of a prism's rims off its outline: half of the arc that touches this facet and its neighbour's.
void round_rims(Cell& rounded, const Cell& cell, Rectangle& core, double radius_mm) {
  const Eigen::Index across = cell.turned ? 1 : 0;
  for (const CellFacet& facet : cell.facets) {
    const double inward = facet.plane.slope[across] < 0.0 ? 1.0 : -1.0;
    double& border = inward > 0.0 ? core.lower[across] : core.upper[across];
    const double rim = border;
    const double tilt = tilt_of(facet.plane);
    Vec2 on_rim = Vec2::Zero();
    on_rim[across] = rim;
    const double centre_z = facet.plane.at(on_rim) - radius_mm / std::cos(tilt);
    for (int k = 0; 2 * k < kChords; ++k) {
      const double from = 2.0 * tilt * k / kChords;
      const double to = 2.0 * tilt * (k + 1) / kChords;
      Rectangle strip = core;
      const double x0 = rim + inward * radius_mm * std::sin(from);
      const double x1 = rim + inward * radius_mm * std::sin(to);
      strip.lower[across] = std::min(x0, x1);
      strip.upper[across] = std::max(x0, x1);
      CellFacet chord{to_polygon(strip), {}, true};
      chord.plane.slope[across] = radius_mm * (std::cos(to) - std::cos(from)) / (x1 - x0);
      chord.plane.height_mm = centre_z + radius_mm * std::cos(from) - chord.plane.slope[across] * x0;
      rounded.facets.push_back(std::move(chord));
      border = x1;
    }
  }
}

}  // namespace

Cell with_edges(const Cell& cell, const EdgeShape& edges) {
  if (!cell.is_element || edges == EdgeShape{}) return cell;
  Cell rounded = cell;
  rounded.facets.clear();
  Polygon core = cell.outline;
  if (edges.rim_radius_mm > 0.0) {
    Rectangle rectangle = bounding_box(cell.outline);
    round_rims(rounded, cell, rectangle, edges.rim_radius_mm);
    core = to_polygon(rectangle);
  }
  std::vector<CellFacet> planes = cell.facets;
  if (edges.root_radius_mm > 0.0 || edges.root_chamfer_mm > 0.0) {
    const std::size_t n = cell.facets.size();
    const Vec3 lowest = lowest_point(cell);
    for (std::size_t k = 0; k < (n == 2 ? 1 : n); ++k)
      add_chords(planes, cell.facets[k], cell.facets[(k + 1) % n], lowest, edges);
  }
  for (CellFacet& facet : upper_envelope(core, planes)) rounded.facets.push_back(std::move(facet));
  return rounded;
}

double edge_share(const Cell& cell) {
  double on_edges = 0.0;
  for (const CellFacet& facet : cell.facets)
    if (facet.is_edge) on_edges += area(facet.outline);
  return on_edges / area(cell.outline);
}

}  // namespace retrace::geometry
