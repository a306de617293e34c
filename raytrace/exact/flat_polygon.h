#pragma once

// Convex polygons in the coordinates across a beam, with the clipping and subtraction that split beams at facets.

#include <algorithm>
#include <boost/container/small_vector.hpp>
#include <utility>
#include <vector>

#include "geometry/vec.h"

namespace retrace::raytrace {

/// A convex, counter-clockwise polygon in the coordinates across a beam. Small polygons need no heap memory.
using FlatPolygon = boost::container::small_vector<geometry::Vec2, 12>;
using FlatPolygons = std::vector<FlatPolygon>;

/// The half plane a x + b y <= c.
struct HalfPlane {
  double a = 0.0;
  double b = 0.0;
  double c = 0.0;

  double excess(const geometry::Vec2& p) const { return a * p.x() + b * p.y() - c; }
};

inline double area(const FlatPolygon& polygon) {
  double twice = 0.0;
  for (std::size_t i = 2; i < polygon.size(); ++i) {
    const geometry::Vec2 p = polygon[i - 1] - polygon[0];
    const geometry::Vec2 q = polygon[i] - polygon[0];
    twice += p.x() * q.y() - p.y() * q.x();
  }
  return 0.5 * twice;
}

/// Adds a corner unless its distance from the previous corner is at most `merge_mm`. The direction of a shorter edge
/// would be determined by rounding, and clipping at such an edge would give arbitrary results.
inline void add_corner(FlatPolygon& polygon, const geometry::Vec2& p, double merge_mm) {
  if (polygon.empty() || (p - polygon.back()).squaredNorm() > merge_mm * merge_mm) polygon.push_back(p);
}

/// Closes a polygon made by add_corner(). A polygon with fewer than three corners becomes empty.
inline void close(FlatPolygon& polygon, double merge_mm) {
  while (polygon.size() > 1 && (polygon.front() - polygon.back()).squaredNorm() <= merge_mm * merge_mm)
    polygon.pop_back();
  if (polygon.size() < 3) polygon.clear();
}

/// Removes corners at which the outline turns clockwise. Rounding can cause such corners, because it changes the
/// direction of very short edges. The line through such an edge may cross the polygon. Clipping another polygon at this
/// line would then remove too much.
void make_convex(FlatPolygon& polygon);

/// Clips a polygon to a half-plane. The result is empty if the polygon is outside of the half-plane.
inline void clip(FlatPolygon& polygon, const HalfPlane& half, double merge_mm) {
  const std::size_t n = polygon.size();
  boost::container::small_vector<double, 16> excess(n, boost::container::default_init);
  double least = 0.0;
  double greatest = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    excess[i] = half.excess(polygon[i]);
    least = std::min(least, excess[i]);
    greatest = std::max(greatest, excess[i]);
  }
  if (greatest <= 0.0) return;
  FlatPolygon kept;
  for (std::size_t i = 0, j = n - 1; least < 0.0 && i < n; j = i++) {
    if ((excess[j] < 0.0 && excess[i] > 0.0) || (excess[j] > 0.0 && excess[i] < 0.0))
      add_corner(kept, polygon[j] + (polygon[i] - polygon[j]) * (excess[j] / (excess[j] - excess[i])), merge_mm);
    if (excess[i] <= 0.0) add_corner(kept, polygon[i], merge_mm);
  }
  close(kept, merge_mm);
  polygon = std::move(kept);
}

/// Returns the part of a polygon in a half-plane. The result is empty if the polygon is outside of the half-plane.
inline FlatPolygon clipped(FlatPolygon polygon, const HalfPlane& half, double merge_mm) {
  clip(polygon, half, merge_mm);
  return polygon;
}

/// Returns the half-plane to the left of the edge from p to q.
inline HalfPlane left_of(const geometry::Vec2& p, const geometry::Vec2& q) {
  const double a = q.y() - p.y();
  const double b = p.x() - q.x();
  return {a, b, a * p.x() + b * p.y()};
}

/// Returns the intersection of two polygons.
/// \pre `b` is convex and counter-clockwise; see make_convex()
inline FlatPolygon intersection(const FlatPolygon& a, const FlatPolygon& b, double merge_mm) {
  FlatPolygon result = a;
  for (std::size_t i = 0; i < b.size() && !result.empty(); ++i)
    clip(result, left_of(b[i], b[(i + 1) % b.size()]), merge_mm);
  return result;
}

/// Joins polygons whose union is convex.
/// \param min_area maximum difference between the area of the convex hull and the sum of the areas
/// \pre the polygons do not overlap
void join_convex(FlatPolygons& polygons, double min_area);

/// Splits the part of `a` outside of `b` into convex polygons and appends them to `out`. Polygons with an area of at
/// most `min_area` are omitted.
/// \pre `b` is convex and counter-clockwise; see make_convex()
void subtract(const FlatPolygon& a, const FlatPolygon& b, double min_area, double merge_mm, FlatPolygons& out);

}  // namespace retrace::raytrace
