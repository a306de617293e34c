#pragma once

// Outlines of parts in plan: closed loops of straight lines and circular arcs, with exact areas, rounded corners, and
// polygons of equal area.

#include <optional>
#include <string>
#include <vector>

#include "geometry/polygon.h"
#include "geometry/vec.h"

namespace retrace::geometry {

/// Side of an outline from one corner to the next: a straight line or a circular arc.
struct OutlineSide {
  Vec2 from_mm = Vec2::Zero();
  Vec2 to_mm = Vec2::Zero();
  /// Tangent of a quarter of the arc's central angle, as in DXF files. 0: the side is straight. If it is positive, the
  /// arc runs counter-clockwise from `from_mm` to `to_mm` and is on the right of its chord.
  double bulge = 0.0;

  bool is_arc() const { return bulge != 0.0; }
  double chord_mm() const { return (to_mm - from_mm).norm(); }
  /// Returns the central angle of the arc, in radians. It is negative for a clockwise arc and 0 for a line.
  double sweep_rad() const;
  /// Returns the radius of the arc.
  /// \pre the side is an arc
  double radius_mm() const;
  /// Returns the centre of the arc.
  /// \pre the side is an arc
  Vec2 centre_mm() const;
  /// Returns the unit tangent at a point of the side, in the direction from `from_mm` to `to_mm`.
  /// \param fraction position along the side, from 0 at `from_mm` to 1 at `to_mm`
  Vec2 tangent_at(double fraction) const;
  /// Returns the side with its ends exchanged.
  OutlineSide reversed() const { return {to_mm, from_mm, -bulge}; }
};

/// Closed curve of sides, each of which begins where the previous side ends.
using OutlineLoop = std::vector<OutlineSide>;
/// Closed polygon, which need not be convex. It does not repeat its first corner.
using PolygonLoop = std::vector<Vec2>;

/// Outline of a part with holes. The first loop is the outer border and runs counter-clockwise. The other loops are the
/// borders of holes and run clockwise.
struct Outline {
  std::vector<OutlineLoop> loops;

  /// Returns the exact area inside the outer border and outside the holes.
  double area_mm2() const;
  /// Returns the exact bounding box of the outer border.
  Rectangle bounding_box() const;
};

/// Returns the area that a loop encloses. It is negative for a clockwise loop.
double enclosed_area_mm2(const OutlineLoop& loop);
OutlineLoop reversed(const OutlineLoop& loop);
OutlineLoop moved(OutlineLoop loop, const Vec2& by);

/// Returns a circle as a loop of two half circles, counter-clockwise.
OutlineLoop circle(const Vec2& centre_mm, double radius_mm);

/// Returns true if a loop consists of two half circles that form a full circle.
bool is_circle(const OutlineLoop& loop);

/// Corner whose radius is too large for its sides.
struct CornerFault {
  std::size_t corner = 0;  ///< number of the corner, from 0
};
/// Rounds the corners of a loop with arcs that are tangent to both sides.
/// \param radius_mm radius for each corner; corner k is the start of side k. 0 keeps a corner sharp.
/// \param fault set if an arc does not fit between its neighbours; the result is then undefined
OutlineLoop with_rounded_corners(const OutlineLoop& loop, const std::vector<double>& radius_mm,
                                 std::optional<CornerFault>& fault);

/// Approximates a loop by a polygon that encloses the same area. Every corner of the loop is a corner of the polygon.
/// Along an arc, the additional corners are slightly outside of the arc, and the midpoints of the polygon's sides are
/// slightly inside.
/// \param tolerance_mm maximum distance between an arc and the polygon; > 0
PolygonLoop equal_area_polygon(const OutlineLoop& loop, double tolerance_mm);

/// Returns the approximate number of corners of equal_area_polygon(), without computing the corners.
double estimated_corner_count(const OutlineLoop& loop, double tolerance_mm);

/// Returns an outline whose outer border runs counter-clockwise and whose holes run clockwise. The loop that encloses
/// the largest area is the outer border.
/// \param loops closed loops in any order and direction
Outline oriented(std::vector<OutlineLoop> loops);

/// Reason why an outline is not allowed.
struct OutlineFault {
  enum class Subject { border, hole, margin };
  std::string text;  ///< such as "must be closed, but there is a gap of 0.1 mm at x = 1, y = 2 mm"
  Subject subject = Subject::border;
};
/// Checks the loops of an outline. Returns the reason why the outline is not allowed, or nothing. A loop must be closed
/// and must not cross or touch itself. A hole must be inside the outer border, and holes must be apart from each other.
/// \param polygons the polygons of the outline's loops (equal_area_polygon()), in the same order
std::optional<OutlineFault> fault_of_outline(const Outline& outline, const std::vector<PolygonLoop>& polygons);

}  // namespace retrace::geometry
