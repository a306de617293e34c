#include "raytrace/exact/flat_polygon.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace retrace::raytrace {
namespace {

using geometry::Vec2;

double turn(const Vec2& a, const Vec2& b, const Vec2& c) {
  return (b.x() - a.x()) * (c.y() - b.y()) - (b.y() - a.y()) * (c.x() - b.x());
}

using Points = boost::container::small_vector<Vec2, 24>;

/// Sorts points by x. Points whose x coordinates differ only by rounding are sorted by y. Without this rule, points on
/// a vertical side would be in arbitrary order, and convex_hull() could remove an end point of the side as collinear.
/// \param least_area tolerance: corners are collinear if twice the area of their triangle is at most this value
void sort_along_x(Points& points, double least_area) {
  std::sort(points.begin(), points.end(), [](const Vec2& p, const Vec2& q) { return p.x() < q.x(); });
  const auto is_lower = [](const Vec2& p, const Vec2& q) { return p.y() < q.y(); };
  const auto [lowest, highest] = std::minmax_element(points.begin(), points.end(), is_lower);
  const double near_mm = least_area / (highest->y() - lowest->y());
  for (auto first = points.begin(); first != points.end();) {
    auto end = first + 1;
    while (end != points.end() && !(end->x() - end[-1].x() > near_mm)) ++end;
    std::sort(first, end, is_lower);
    first = end;
  }
}

/// Returns the convex hull of two polygons by Andrew's monotone chain algorithm.
/// \param least_area a corner is omitted if twice the area of the triangle that it forms with its two neighbours is at
///        most this value
FlatPolygon convex_hull(const FlatPolygon& a, const FlatPolygon& b, double least_area) {
  Points points(a.begin(), a.end());
  points.insert(points.end(), b.begin(), b.end());
  sort_along_x(points, least_area);
  FlatPolygon hull;
  const auto add_chain = [&](auto first, auto last) {
    const std::size_t start = hull.size();
    for (auto p = first; p != last; ++p) {
      while (hull.size() >= start + 2 && turn(hull[hull.size() - 2], hull.back(), *p) <= least_area) hull.pop_back();
      hull.push_back(*p);
    }
    hull.pop_back();  // the last point is the first point of the next chain
  };
  add_chain(points.begin(), points.end());
  add_chain(points.rbegin(), points.rend());
  return hull;
}

using Box = Eigen::AlignedBox2d;

Box box_around(const FlatPolygon& polygon, double slack_mm) {
  Box box;
  for (const Vec2& p : polygon) box.extend(p);
  return {box.min().array() - slack_mm, box.max().array() + slack_mm};
}

}  // namespace

void make_convex(FlatPolygon& polygon) {
  // Removing a corner changes the angles at its two neighbours. Both neighbours are therefore checked again.
  std::size_t unchecked = polygon.size();
  for (std::size_t k = 0; unchecked > 0 && polygon.size() > 3; --unchecked) {
    const std::size_t n = polygon.size();
    if (turn(polygon[(k + n - 1) % n], polygon[k], polygon[(k + 1) % n]) >= 0.0) {
      k = (k + 1) % n;
      continue;
    }
    polygon.erase(polygon.begin() + static_cast<std::ptrdiff_t>(k));
    k = (k + n - 2) % (n - 1);
    unchecked = std::min(unchecked + 2, n);
  }
}

void join_convex(FlatPolygons& polygons, double min_area) {
  if (polygons.size() < 2) return;
  // Polygons whose bounding boxes do not touch have no convex union.
  const double slack_mm = std::sqrt(min_area);
  boost::container::small_vector<Box, 16> boxes;
  for (const FlatPolygon& polygon : polygons) boxes.push_back(box_around(polygon, slack_mm));
  for (std::size_t i = 0; i < polygons.size(); ++i)
    for (std::size_t j = i + 1; j < polygons.size();) {
      if (!boxes[i].intersects(boxes[j])) {
        ++j;
        continue;
      }
      FlatPolygon hull = convex_hull(polygons[i], polygons[j], min_area);
      if (std::abs(area(hull) - area(polygons[i]) - area(polygons[j])) > min_area) {
        ++j;
        continue;
      }
      polygons[i] = std::move(hull);
      polygons.erase(polygons.begin() + static_cast<std::ptrdiff_t>(j));
      boxes[i].extend(boxes[j]);
      boxes.erase(boxes.begin() + static_cast<std::ptrdiff_t>(j));
      j = i + 1;  // polygons that could not be joined before may fit the enlarged polygon
    }
}

void subtract(const FlatPolygon& a, const FlatPolygon& b, double min_area, double merge_mm, FlatPolygons& out) {
  FlatPolygon rest = a;
  for (std::size_t i = 0; i < b.size() && !rest.empty(); ++i) {
    const HalfPlane inner = left_of(b[i], b[(i + 1) % b.size()]);
    FlatPolygon& outer = out.emplace_back(rest);
    clip(outer, {-inner.a, -inner.b, -inner.c}, merge_mm);
    if (outer.size() < 3 || area(outer) <= min_area) out.pop_back();
    clip(rest, inner, merge_mm);
  }
}

}  // namespace retrace::raytrace
