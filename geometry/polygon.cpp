#include "geometry/polygon.h"

#include <algorithm>

namespace retrace::geometry {
namespace {

/// Keeps `axis * sign * coordinate <= sign * bound`.
Polygon clip_axis(const Polygon& polygon, Eigen::Index axis, double sign, double bound, double tolerance_mm) {
  Polygon kept;
  kept.reserve(polygon.size() + 2);
  bool reaches_inside = false;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2& a = polygon[i];
    const Vec2& b = polygon[(i + 1) % polygon.size()];
    const double da = sign * (a[axis] - bound);
    const double db = sign * (b[axis] - bound);
    if (da < -tolerance_mm) reaches_inside = true;
    if (da <= tolerance_mm) kept.push_back(a);
    const bool crosses = (da < -tolerance_mm && db > tolerance_mm) || (da > tolerance_mm && db < -tolerance_mm);
    if (!crosses) continue;
    Vec2 cut = a + (b - a) * (da / (da - db));
    cut[axis] = bound;
    kept.push_back(cut);
  }
  if (!reaches_inside) kept.clear();
  return kept;
}

}  // namespace

double area(const Polygon& polygon) {
  double twice = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2& a = polygon[i];
    const Vec2& b = polygon[(i + 1) % polygon.size()];
    twice += (a.x() - polygon[0].x()) * (b.y() - polygon[0].y()) - (b.x() - polygon[0].x()) * (a.y() - polygon[0].y());
  }
  return 0.5 * twice;
}

Vec2 centroid(const Polygon& polygon) {
  Vec2 sum = Vec2::Zero();
  for (const Vec2& p : polygon) sum += p;
  return sum / static_cast<double>(polygon.size());
}

Polygon to_polygon(const Rectangle& r) {
  return {r.lower, {r.upper.x(), r.lower.y()}, r.upper, {r.lower.x(), r.upper.y()}};
}

Rectangle bounding_box(const Polygon& polygon) {
  Rectangle box{polygon.front(), polygon.front()};
  for (const Vec2& p : polygon) {
    box.lower = box.lower.cwiseMin(p);
    box.upper = box.upper.cwiseMax(p);
  }
  return box;
}

Polygon moved(Polygon polygon, const Vec2& by) {
  for (Vec2& p : polygon) p += by;
  return polygon;
}

Rectangle moved(const Rectangle& rectangle, const Vec2& by) {
  return {rectangle.lower + by, rectangle.upper + by};
}

Polygon clip(const Polygon& polygon, const Rectangle& rectangle, double tolerance_mm) {
  if (rectangle.empty()) return {};
  Polygon result = polygon;
  for (const Eigen::Index axis : {0, 1}) {
    if (!result.empty()) result = clip_axis(result, axis, 1.0, rectangle.upper[axis], tolerance_mm);
    if (!result.empty()) result = clip_axis(result, axis, -1.0, rectangle.lower[axis], tolerance_mm);
  }
  if (result.size() < 3) result.clear();
  return result;
}

bool contains(const Rectangle& r, const Polygon& polygon, double tolerance_mm) {
  return std::all_of(polygon.begin(), polygon.end(), [&](const Vec2& p) {
    return (p.array() >= r.lower.array() - tolerance_mm).all() && (p.array() <= r.upper.array() + tolerance_mm).all();
  });
}

}  // namespace retrace::geometry
