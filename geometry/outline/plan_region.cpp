#include "geometry/outline/plan_region.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/outline/convex_decomposition.h"
#include "geometry/plane_math.h"

namespace retrace::geometry {
namespace {

/// Sine of the angle below which two sides count as one straight side.
constexpr double kStraightSine = 1e-12;
/// Tolerance of positions, as a fraction of the size of the outline.
constexpr double kPlanRounding = 1e-12;

PolygonLoop without_straight_corners(const PolygonLoop& loop) {
  PolygonLoop kept;
  for (std::size_t k = 0; k < loop.size(); ++k) {
    const Vec2 before = loop[k] - loop[(k + loop.size() - 1) % loop.size()];
    const Vec2 after = loop[(k + 1) % loop.size()] - loop[k];
    if (std::abs(plane::cross(before, after)) > kStraightSine * before.norm() * after.norm() || before.dot(after) < 0.0)
      kept.push_back(loop[k]);
  }
  return kept;
}

double min_distance(const PolygonLoop& points, const PolygonLoop& loop) {
  double least = INFINITY;
  for (const Vec2& p : points)
    for (std::size_t k = 0; k < loop.size(); ++k)
      least = std::min(least, plane::distance(p, loop[k], loop[(k + 1) % loop.size()]));
  return least;
}

/// Line through a side that has been moved to the left.
struct MovedSide {
  Vec2 point_mm;
  Vec2 along;  ///< unit vector
};

/// Returns the intersections of consecutive moved sides. Corner k is the start of side k.
PolygonLoop corners_of(const std::vector<MovedSide>& sides) {
  PolygonLoop corners;
  for (std::size_t k = 0; k < sides.size(); ++k) {
    const MovedSide& before = sides[(k + sides.size() - 1) % sides.size()];
    const double sine = plane::cross(before.along, sides[k].along);
    corners.push_back(
        std::abs(sine) < kStraightSine
            ? sides[k].point_mm
            : Vec2(before.point_mm +
                   before.along * (plane::cross(sides[k].point_mm - before.point_mm, sides[k].along) / sine)));
  }
  return corners;
}

/// Moves the sides of a loop to its left. Sides whose length would become negative are removed.
PolygonLoop moved_inward(const PolygonLoop& loop, double by_mm) {
  std::vector<MovedSide> sides;
  for (std::size_t k = 0; k < loop.size(); ++k) {
    const Vec2 along = (loop[(k + 1) % loop.size()] - loop[k]).normalized();
    sides.push_back({loop[k] + by_mm * plane::left_of(along), along});
  }
  while (sides.size() > 2) {
    PolygonLoop corners = corners_of(sides);
    std::size_t shortest = 0;
    double least = INFINITY;
    for (std::size_t k = 0; k < sides.size(); ++k) {
      const double length = (corners[(k + 1) % corners.size()] - corners[k]).dot(sides[k].along);
      if (length < least) shortest = k;
      least = std::min(least, length);
    }
    if (least > kPlanRounding * by_mm) return corners;
    sides.erase(sides.begin() + static_cast<std::ptrdiff_t>(shortest));
  }
  return {};
}

/// Returns the region of a convex polygon whose points are at least `by_mm` away from all sides.
Polygon convex_inside(const Polygon& polygon, double by_mm, double tolerance_mm) {
  Polygon inside = polygon;
  for (std::size_t k = 0; k < polygon.size() && !inside.empty(); ++k) {
    const Vec2 along = (polygon[(k + 1) % polygon.size()] - polygon[k]).normalized();
    const double reach = 4.0 * bounding_box(polygon).size().norm();
    const Vec2 from = polygon[k] + by_mm * plane::left_of(along);
    const Polygon half = {from - reach * along, from + reach * along, from + reach * (along + plane::left_of(along)),
                          from + reach * (plane::left_of(along) - along)};
    inside = clip(inside, half, tolerance_mm);
  }
  return inside;
}

ConvexRegion region_of(const std::vector<PolygonLoop>& borders) {
  ConvexRegion region;
  region.borders = borders;
  region.pieces = convex_decomposition(borders);
  for (const Polygon& piece : region.pieces) region.boxes.push_back(bounding_box(piece));
  return region;
}

void append(ConvexRegion& region, const ConvexRegion& more) {
  region.pieces.insert(region.pieces.end(), more.pieces.begin(), more.pieces.end());
  region.boxes.insert(region.boxes.end(), more.boxes.begin(), more.boxes.end());
  region.borders.insert(region.borders.end(), more.borders.begin(), more.borders.end());
}

PolygonLoop backwards(PolygonLoop loop) {
  std::reverse(loop.begin(), loop.end());
  return loop;
}

/// Adds the area of the elements and the area of the margin to a plan. Returns false if the margin leaves no connected
/// area for elements.
bool add_margin(PlanRegion& plan) {
  if (!(plan.margin_mm > 0.0)) {
    plan.elements = plan.whole;
    return true;
  }
  const double near_mm = kPlanRounding * plan.box_mm.size().norm();
  Outline inner;
  std::vector<PolygonLoop> borders;
  for (const PolygonLoop& loop : plan.whole.borders) {
    borders.push_back(plan.is_convex() ? convex_inside(loop, plan.margin_mm, near_mm)
                                       : moved_inward(loop, plan.margin_mm));
    const PolygonLoop& border = borders.back();
    if (border.size() < 3 || (area(border) > 0.0) != (area(loop) > 0.0)) return false;
    OutlineLoop& sides = inner.loops.emplace_back();
    for (std::size_t k = 0; k < border.size(); ++k) sides.push_back({border[k], border[(k + 1) % border.size()], 0.0});
  }
  if (fault_of_outline(inner, borders)) return false;
  constexpr double kAlmostAll = 1.0 - 1e-6;
  for (const PolygonLoop& border : borders)
    for (const PolygonLoop& loop : plan.whole.borders)
      if (std::min(min_distance(border, loop), min_distance(loop, border)) < kAlmostAll * plan.margin_mm) return false;
  plan.elements = region_of(borders);
  plan.margin = region_of({plan.whole.borders.front(), backwards(borders.front())});
  for (std::size_t k = 1; k < borders.size(); ++k)
    append(plan.margin, region_of({backwards(borders[k]), plan.whole.borders[k]}));
  return true;
}

double perimeter(const Polygon& polygon) {
  double sum = 0.0;
  for (std::size_t k = 0; k < polygon.size(); ++k) sum += (polygon[(k + 1) % polygon.size()] - polygon[k]).norm();
  return sum;
}

/// Returns the intersections of a polygon with the convex polygons of a region. Unlike clip(), this function also
/// divides a polygon that is completely inside the region.
std::vector<Polygon> portions(const Polygon& polygon, const ConvexRegion& region, double tolerance_mm) {
  const Rectangle box = bounding_box(polygon);
  std::vector<Polygon> inside;
  for (std::size_t k = 0; k < region.pieces.size(); ++k) {
    if ((box.lower.array() >= region.boxes[k].upper.array()).any() ||
        (box.upper.array() <= region.boxes[k].lower.array()).any())
      continue;
    Polygon portion = clip(polygon, region.pieces[k], tolerance_mm);
    if (!portion.empty()) inside.push_back(std::move(portion));
  }
  return inside;
}

/// Returns true if portions of a polygon cover it completely.
bool cover(const std::vector<Polygon>& portions, const Polygon& polygon, double tolerance_mm) {
  double sum = 0.0;
  for (const Polygon& portion : portions) sum += area(portion);
  return area(polygon) - sum <= tolerance_mm * perimeter(polygon);
}

/// Returns the area of the portion of a convex polygon in which the coordinate along `axis` is below a bound.
double area_below(const Polygon& polygon, Eigen::Index axis, double bound) {
  Polygon below;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vec2& from = polygon[k];
    const Vec2& to = polygon[(k + 1) % polygon.size()];
    if (from[axis] <= bound) below.push_back(from);
    if ((from[axis] < bound && to[axis] > bound) || (from[axis] > bound && to[axis] < bound))
      below.push_back(from + (to - from) * ((bound - from[axis]) / (to[axis] - from[axis])));
  }
  return below.size() < 3 ? 0.0 : area(below);
}

}  // namespace

bool PlanRegion::is_box() const {
  const double near_mm = kPlanRounding * box_mm.size().norm();
  const auto is_corner = [&](const Vec2& p) {
    return (p - box_mm.lower).cwiseAbs().cwiseMin((p - box_mm.upper).cwiseAbs()).maxCoeff() <= near_mm;
  };
  return whole.borders.size() == 1 && whole.borders.front().size() == 4 &&
         std::ranges::all_of(whole.borders.front(), is_corner);
}

PlanRegion plan_region(Outline outline, double margin_mm, double tolerance_mm, std::optional<OutlineFault>& fault) {
  PlanRegion plan;
  plan.margin_mm = margin_mm;
  plan.tolerance_mm = tolerance_mm;
  std::vector<PolygonLoop> borders;
  for (const OutlineLoop& loop : outline.loops) borders.push_back(equal_area_polygon(loop, tolerance_mm));
  fault = fault_of_outline(outline, borders);
  if (fault) return plan;
  const Vec2 to_origin = -bounding_box(borders.front()).lower;
  for (PolygonLoop& loop : borders) loop = without_straight_corners(moved(std::move(loop), to_origin));
  for (OutlineLoop& loop : outline.loops) loop = moved(std::move(loop), to_origin);
  plan.outline = std::move(outline);
  plan.box_mm = bounding_box(borders.front());
  plan.hull = convex_hull(borders.front());
  plan.whole = region_of(borders);
  if (!add_margin(plan))
    fault = OutlineFault{"must leave one connected area for elements", OutlineFault::Subject::margin};
  return plan;
}

PlanRegion moved(PlanRegion plan, const Vec2& by) {
  for (OutlineLoop& loop : plan.outline.loops) loop = moved(std::move(loop), by);
  plan.box_mm = moved(plan.box_mm, by);
  plan.hull = moved(std::move(plan.hull), by);
  for (ConvexRegion* const region : {&plan.whole, &plan.elements, &plan.margin}) {
    for (Polygon& piece : region->pieces) piece = moved(std::move(piece), by);
    for (Rectangle& box : region->boxes) box = moved(box, by);
    for (PolygonLoop& border : region->borders) border = moved(std::move(border), by);
  }
  return plan;
}

PlanRegion without_margin(PlanRegion plan) {
  plan.margin_mm = 0.0;
  plan.margin = {};
  add_margin(plan);
  return plan;
}

std::vector<Polygon> clip(const Polygon& polygon, const ConvexRegion& region, double tolerance_mm) {
  std::vector<Polygon> inside = portions(polygon, region, tolerance_mm);
  if (inside.size() > 1 && cover(inside, polygon, tolerance_mm)) return {polygon};
  return inside;
}

std::optional<std::array<Vec2, 2>> clip_segment(const Vec2& from, const Vec2& to, const Polygon& polygon) {
  double first = 0.0;
  double last = 1.0;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vec2 along = polygon[(k + 1) % polygon.size()] - polygon[k];
    // The cross products are positive for points on the inner side of the polygon's edge.
    const double at_from = plane::cross(along, from - polygon[k]);
    const double at_to = plane::cross(along, to - polygon[k]);
    if (at_from < 0.0 && at_to < 0.0) return std::nullopt;
    if (at_from < 0.0) first = std::max(first, at_from / (at_from - at_to));
    if (at_to < 0.0) last = std::min(last, at_from / (at_from - at_to));
  }
  if (first >= last) return std::nullopt;
  return std::array<Vec2, 2>{from + first * (to - from), from + last * (to - from)};
}

double coordinate_of_area_fraction(const PlanRegion& plan, const Rectangle& room, Eigen::Index axis, double fraction) {
  const double near_mm = kPlanRounding * plan.box_mm.size().norm();
  std::vector<Polygon> pieces;
  double all_mm2 = 0.0;
  for (const Polygon& piece : plan.whole.pieces) {
    Polygon within = clip(piece, room, near_mm);
    if (within.empty()) continue;
    all_mm2 += area(within);
    pieces.push_back(std::move(within));
  }
  double low = room.lower[axis];
  double high = room.upper[axis];
  // Bisection until the two bounds are neighbouring floating-point numbers. It converges because the area is a
  // continuous function of the coordinate.
  for (double middle = 0.5 * (low + high); middle > low && middle < high; middle = 0.5 * (low + high)) {
    double below_mm2 = 0.0;
    for (const Polygon& piece : pieces) below_mm2 += area_below(piece, axis, middle);
    (below_mm2 < fraction * all_mm2 ? low : high) = middle;
  }
  return high;
}

bool is_within(const Polygon& polygon, const ConvexRegion& region, double tolerance_mm) {
  return cover(portions(polygon, region, tolerance_mm), polygon, tolerance_mm);
}

}  // namespace retrace::geometry
