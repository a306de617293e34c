#pragma once

// Plane regions as sets of convex polygons, from which convex regions are taken away: exact to rounding.

#include <span>
#include <vector>

#include "geometry/vec.h"

namespace retrace::fabrication {

/// outward . p <= bound_mm, in a plane. `outward` has length 1.
struct HalfPlane {
  geometry::Vec2 outward = geometry::Vec2::UnitX();
  double bound_mm = 0.0;

  /// How far a point lies outside; negative: inside.
  double over_mm(const geometry::Vec2& p) const { return outward.dot(p) - bound_mm; }
};

/// Corners of a convex polygon in order; none: it is empty.
using ConvexPiece = std::vector<geometry::Vec2>;

/// The part of a polygon within a half-plane.
ConvexPiece clipped(const ConvexPiece& piece, const HalfPlane& to);

/// Takes the intersection of half-planes away from a set of polygons that do not overlap; what is left stays polygons
/// that do not overlap. Parts thinner than a thousandth of a nanometre are neither taken nor kept.
/// \return the parts that were taken
std::vector<ConvexPiece> take_away(std::vector<ConvexPiece>& pieces, std::span<const HalfPlane> body);

/// Length of the part of the line point + s direction, low <= s <= high, within a polygon.
double chord_mm(const ConvexPiece& piece, const geometry::Vec2& point, const geometry::Vec2& direction, double low,
                double high);

/// Length of lines along a direction within polygons that do not overlap, at every place across the direction where
/// that length may be greatest: it is linear between the polygons' corners, and jumps there at most.
struct LineLength {
  double at_mm = 0.0;  ///< across . p on the line
  double length_mm = 0.0;
};
/// \param across of length 1; the lines are at right angles to it \param also more places where lines are wanted
std::vector<LineLength> line_lengths(std::span<const ConvexPiece> pieces, const geometry::Vec2& across,
                                     std::span<const double> also);

}  // namespace retrace::fabrication
