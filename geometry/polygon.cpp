#include "geometry/polygon.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "geometry/centroid.h"
#include "geometry/plane_math.h"

namespace retrace::geometry {
namespace {

/// Clips a convex polygon at a border line: one step of the Sutherland-Hodgman algorithm (Comm. ACM 17, 32, 1974).
/// \param beyond returns the distance of a point beyond the border, mm
/// \param settle moves an intersection point exactly onto the border, to remove rounding errors
template <class Beyond, class Settle>
Polygon clip_at(const Polygon& polygon, const Beyond& beyond, const Settle& settle, double tolerance_mm) {
  Polygon kept;
  kept.reserve(polygon.size() + 2);
  bool reaches_inside = false;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2& a = polygon[i];
    const Vec2& b = polygon[(i + 1) % polygon.size()];
    const double da = beyond(a);
    const double db = beyond(b);
    if (da < -tolerance_mm) reaches_inside = true;
    if (da <= tolerance_mm) kept.push_back(a);
    const bool crosses = (da < -tolerance_mm && db > tolerance_mm) || (da > tolerance_mm && db < -tolerance_mm);
    if (crosses) kept.push_back(settle(Vec2(a + (b - a) * (da / (da - db)))));
  }
  if (!reaches_inside) kept.clear();
  return kept;
}

/// Keeps the points with `sign * coordinate <= sign * bound`.
Polygon clip_axis(const Polygon& polygon, Eigen::Index axis, double sign, double bound, double tolerance_mm) {
  const auto settle = [&](Vec2 cut) {
    cut[axis] = bound;
    return cut;
  };
  return clip_at(
      polygon, [&](const Vec2& p) { return sign * (p[axis] - bound); }, settle, tolerance_mm);
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
  return centroid(std::span<const Vec2>(polygon));
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

Polygon clip(const Polygon& polygon, const Polygon& region, double tolerance_mm) {
  Polygon result = polygon;
  for (std::size_t k = 0; k < region.size() && !result.empty(); ++k) {
    const Vec2& from = region[k];
    const Vec2 along = (region[(k + 1) % region.size()] - from).normalized();
    const auto beyond = [&](const Vec2& p) { return along.y() * (p - from).x() - along.x() * (p - from).y(); };
    result = clip_at(
        result, beyond, [](const Vec2& cut) { return cut; }, tolerance_mm);
  }
  if (result.size() < 3) result.clear();
  return result;
}

bool is_convex(const Polygon& polygon, double tolerance_mm) {
  double turned_rad = 0.0;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vec2 a = polygon[(k + 1) % polygon.size()] - polygon[k];
    const Vec2 b = polygon[(k + 2) % polygon.size()] - polygon[(k + 1) % polygon.size()];
    const double cross = a.x() * b.y() - a.y() * b.x();
    if (cross < -tolerance_mm * (a.norm() + b.norm())) return false;
    turned_rad += std::atan2(cross, a.dot(b));
  }
  return turned_rad < 3.0 * std::numbers::pi;
}

double width(const Polygon& polygon) {
  double least = INFINITY;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vec2 along = (polygon[(k + 1) % polygon.size()] - polygon[k]).normalized();
    double across = 0.0;
    for (const Vec2& p : polygon)
      across = std::max(across, along.x() * (p - polygon[k]).y() - along.y() * (p - polygon[k]).x());
    least = std::min(least, across);
  }
  return least;
}

bool contains(const Polygon& polygon, const Vec2& point) {
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vec2 along = polygon[(k + 1) % polygon.size()] - polygon[k];
    const Vec2 to = point - polygon[k];
    if (plane::cross(along, to) < 0.0) return false;
  }
  return true;
}

bool contains(const Polygon& polygon, const Vec2& point, double tolerance_mm) {
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vec2 along = (polygon[(k + 1) % polygon.size()] - polygon[k]).normalized();
    if (plane::cross(along, point - polygon[k]) < -tolerance_mm) return false;
  }
  return true;
}

bool contains(const Rectangle& r, const Polygon& polygon, double tolerance_mm) {
  return std::all_of(polygon.begin(), polygon.end(), [&](const Vec2& p) {
    return (p.array() >= r.lower.array() - tolerance_mm).all() && (p.array() <= r.upper.array() + tolerance_mm).all();
  });
}

}  // namespace retrace::geometry
