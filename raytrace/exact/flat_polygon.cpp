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

/// Andrew's monotone chain; corners that turn by less than `least_area` are left out.
FlatPolygon convex_hull(const FlatPolygon& a, const FlatPolygon& b, double least_area) {
  boost::container::small_vector<Vec2, 24> points(a.begin(), a.end());
  points.insert(points.end(), b.begin(), b.end());
  std::sort(points.begin(), points.end(),
            [](const Vec2& p, const Vec2& q) { return p.x() < q.x() || (p.x() == q.x() && p.y() < q.y()); });
  FlatPolygon hull;
  const auto add_chain = [&](auto first, auto last) {
    const std::size_t start = hull.size();
    for (auto p = first; p != last; ++p) {
      while (hull.size() >= start + 2 && turn(hull[hull.size() - 2], hull.back(), *p) <= least_area) hull.pop_back();
      hull.push_back(*p);
    }
    hull.pop_back();  // the next chain begins with it
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

void join_convex(FlatPolygons& polygons, double least_area) {
  if (polygons.size() < 2) return;
  // What does not touch has no convex union.
  const double slack_mm = std::sqrt(least_area);
  boost::container::small_vector<Box, 16> boxes;
  for (const FlatPolygon& polygon : polygons) boxes.push_back(box_around(polygon, slack_mm));
  for (std::size_t i = 0; i < polygons.size(); ++i)
    for (std::size_t j = i + 1; j < polygons.size();) {
      if (!boxes[i].intersects(boxes[j])) {
        ++j;
        continue;
      }
      FlatPolygon hull = convex_hull(polygons[i], polygons[j], least_area);
      if (std::abs(area(hull) - area(polygons[i]) - area(polygons[j])) > least_area) {
        ++j;
        continue;
      }
      polygons[i] = std::move(hull);
      polygons.erase(polygons.begin() + static_cast<std::ptrdiff_t>(j));
      boxes[i].extend(boxes[j]);
      boxes.erase(boxes.begin() + static_cast<std::ptrdiff_t>(j));
      j = i + 1;  // those that did not fit before may fit now
    }
}

}  // namespace retrace::raytrace
