#pragma once

// Represents plane regions as sets of convex polygons and subtracts convex regions from them. Results are exact except
// for rounding errors.

#include <span>
#include <vector>

#include "geometry/vec.h"

namespace retrace::fabrication {

/// Half-plane outward . p <= bound_mm, where `outward` is a unit vector.
struct HalfPlane {
  geometry::Vec2 outward = geometry::Vec2::UnitX();
  double bound_mm = 0.0;

  /// Returns the signed distance of a point from the boundary; negative inside the half-plane.
  double signed_distance_mm(const geometry::Vec2& p) const { return outward.dot(p) - bound_mm; }
};

/// Convex polygon as a list of its corners in order. An empty list is an empty polygon.
using ConvexPolygon = std::vector<geometry::Vec2>;

/// Returns the part of a polygon inside a half-plane.
ConvexPolygon clipped(const ConvexPolygon& piece, const HalfPlane& to);

/// Subtracts the intersection of half-planes from a set of polygons that do not overlap. The remaining polygons do not
/// overlap either. Parts that are thinner than a thousandth of a nanometre are discarded.
/// \return the subtracted parts
std::vector<ConvexPolygon> subtract(std::vector<ConvexPolygon>& pieces, std::span<const HalfPlane> body);

/// Returns the length, inside a polygon, of the line `point` + s * `direction` with low <= s <= high.
double chord_mm(const ConvexPolygon& piece, const geometry::Vec2& point, const geometry::Vec2& direction, double low,
                double high);

/// Length of one line inside a set of polygons.
struct LineLength {
  /// Position of the line: the value of across . p for all points p of the line (see line_lengths()).
  double at_mm = 0.0;
  double length_mm = 0.0;
};
/// Returns the lengths of parallel lines inside polygons that do not overlap. The lines are at all positions where the
/// length may have a maximum. These are the corners of the polygons, because the length is linear between corners.
/// \param across unit vector perpendicular to the lines
/// \param also additional positions of lines
std::vector<LineLength> line_lengths(std::span<const ConvexPolygon> pieces, const geometry::Vec2& across,
                                     std::span<const double> also);

}  // namespace retrace::fabrication
