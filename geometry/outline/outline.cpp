#include "geometry/outline/outline.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geometry/plane_math.h"

namespace retrace::geometry {
namespace {

/// Maximum distance between two points that are regarded as one point, as a fraction of the outline's size.
constexpr double kNearPointFraction = 1e-9;
/// Maximum central angle of an arc that is replaced by one side of a polygon, in radians.
constexpr double kMaxStepRad = std::numbers::pi / 4.0;

Vec2 rotated(const Vec2& v, double rad) {
  const double c = std::cos(rad);
  const double s = std::sin(rad);
  return {c * v.x() - s * v.y(), s * v.x() + c * v.y()};
}

/// Returns x - sin(x). The series avoids the cancellation of digits for small angles.
double minus_sine(double x) {
  if (std::abs(x) > 0.3) return x - std::sin(x);
  const double x2 = x * x;
  return x * x2 / 6.0 *
         (1.0 - x2 / 20.0 * (1.0 - x2 / 42.0 * (1.0 - x2 / 72.0 * (1.0 - x2 / 110.0 * (1.0 - x2 / 156.0)))));
}

/// Chain of polygon sides that replaces an arc of radius 1. Its first and last corners are the ends of the arc. All
/// other corners are at the distance `radius` from the centre of the arc.
struct ArcPolygon {
  int sides = 1;
  double radius = 1.0;
};

/// Returns the distance between the inner corners and the centre of the arc. It is chosen so that the polygon and the
/// sector have equal areas.
double radius_of_inner_corners(double sweep_rad, int sides) {
  const double step_rad = sweep_rad / sides;
  const double ratio = sweep_rad / std::sin(step_rad);  // about `sides`
  if (sides == 2) return 0.5 * ratio;
  // (n - 2) x^2 + 2 x = sweep / sin(step)
  return ratio / (1.0 + std::sqrt(1.0 + (sides - 2) * ratio));
}

/// Returns the maximum distance between the arc and the polygon, for an arc of radius 1.
double deviation(double sweep_rad, const ArcPolygon& polygon) {
  const double step_rad = sweep_rad / polygon.sides;
  const double outside = polygon.radius - 1.0;
  const double inside = 1.0 - polygon.radius * std::cos(0.5 * step_rad);
  const Vec2 first(1.0, 0.0);
  const Vec2 second = polygon.radius * Vec2(std::cos(step_rad), std::sin(step_rad));
  const double at_end = 1.0 - std::abs(plane::cross(first, second)) / (second - first).norm();
  return std::max({outside, at_end, polygon.sides > 2 ? inside : 0.0});
}

/// Returns a polygon that replaces an arc with nearly the minimum number of sides.
/// \param tolerance maximum deviation, relative to the radius
ArcPolygon polygon_of_arc(double sweep_rad, double tolerance) {
  // For small steps, the end sides deviate by about step^2 / 8.
  const double estimate = sweep_rad / std::sqrt(8.0 * tolerance);
  int sides = std::max(2, static_cast<int>(std::ceil(sweep_rad / kMaxStepRad)));
  if (estimate > 4.0 * sides) sides = static_cast<int>(std::min(0.5 * estimate, 1e8));
  const auto of = [&](int n) { return ArcPolygon{n, radius_of_inner_corners(sweep_rad, n)}; };
  while (deviation(sweep_rad, of(sides)) > tolerance && sides < 100'000'000) sides += 1 + sides / 64;
  return of(sides);
}

ArcPolygon polygon_of(const OutlineSide& side, double tolerance_mm) {
  if (!side.is_arc()) return {};
  return polygon_of_arc(std::abs(side.sweep_rad()), tolerance_mm / side.radius_mm());
}

/// Returns true if a point is inside a polygon, by the number of sides that a horizontal line from the point crosses.
bool is_enclosed(const PolygonLoop& loop, const Vec2& p) {
  bool inside = false;
  for (std::size_t k = 0; k < loop.size(); ++k) {
    const Vec2& a = loop[k];
    const Vec2& b = loop[(k + 1) % loop.size()];
    if ((a.y() > p.y()) == (b.y() > p.y())) continue;
    if (p.x() < a.x() + (b.x() - a.x()) * ((p.y() - a.y()) / (b.y() - a.y()))) inside = !inside;
  }
  return inside;
}

/// Returns true if two segments cross, or if their distance is at most `near_mm`.
bool meet(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d, double near_mm) {
  const Vec2 low = a.cwiseMin(b) - Vec2::Constant(near_mm);
  const Vec2 high = a.cwiseMax(b) + Vec2::Constant(near_mm);
  if ((c.cwiseMax(d).array() < low.array()).any() || (c.cwiseMin(d).array() > high.array()).any()) return false;
  const double to_c = plane::cross(b - a, c - a);
  const double to_d = plane::cross(b - a, d - a);
  const double to_a = plane::cross(d - c, a - c);
  const double to_b = plane::cross(d - c, b - c);
  if ((to_c > 0.0) != (to_d > 0.0) && (to_a > 0.0) != (to_b > 0.0)) return true;
  return std::min({plane::distance(c, a, b), plane::distance(d, a, b), plane::distance(a, c, d),
                   plane::distance(b, c, d)}) <= near_mm;
}

/// Returns a point near which two sides of a loop meet, other than at the corner of neighbouring sides.
std::optional<Vec2> self_contact(const PolygonLoop& loop, double near_mm) {
  const std::size_t n = loop.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Vec2& a = loop[i];
    const Vec2& b = loop[(i + 1) % n];
    const Vec2& c = loop[(i + 2) % n];
    // The next side must not return along this side.
    if ((b - a).dot(c - b) < 0.0 && std::min(plane::distance(c, a, b), plane::distance(a, b, c)) <= near_mm) return b;
    for (std::size_t j = i + 2; j < n; ++j)
      if (!(i == 0 && j + 1 == n) && meet(a, b, loop[j], loop[(j + 1) % n], near_mm)) return a;
  }
  return std::nullopt;
}

/// Returns a point near which the sides of two loops meet, or nothing if they do not meet.
std::optional<Vec2> contact(const PolygonLoop& one, const PolygonLoop& other, double near_mm) {
  for (std::size_t i = 0; i < one.size(); ++i)
    for (std::size_t j = 0; j < other.size(); ++j)
      if (meet(one[i], one[(i + 1) % one.size()], other[j], other[(j + 1) % other.size()], near_mm)) return one[i];
  return std::nullopt;
}

std::string at_text(const Vec2& p) {
  return fmt::format("x = {:.6g}, y = {:.6g} mm", p.x(), p.y());
}

/// Returns a fault if a side of a loop does not begin at the end of the previous side. Otherwise, returns nothing.
std::optional<OutlineFault> opening_of(const OutlineLoop& loop, double near_mm) {
  for (std::size_t k = 0; k < loop.size(); ++k) {
    const Vec2& next = loop[(k + 1) % loop.size()].from_mm;
    if ((loop[k].to_mm - next).norm() > near_mm)
      return OutlineFault{fmt::format("must be closed, but there is a gap of {:.6g} mm at {}",
                                      (loop[k].to_mm - next).norm(), at_text(loop[k].to_mm))};
  }
  return std::nullopt;
}

/// Offset curve of a side: a line or a circle at a fixed distance from the side.
struct OffsetCurve {
  bool is_line = true;
  Vec2 point_mm = Vec2::Zero();  ///< point of the line, or centre of the circle
  Vec2 along = Vec2::UnitX();
  double radius_mm = 0.0;
};

/// \param by_mm distance to the left of the side; may be negative
OffsetCurve offset_curve(const OutlineSide& side, double by_mm) {
  if (!side.is_arc()) {
    const Vec2 along = (side.to_mm - side.from_mm).normalized();
    return {true, side.from_mm + by_mm * plane::left_of(along), along, 0.0};
  }
  // The centre of a counter-clockwise arc is on its left.
  return {false, side.centre_mm(), Vec2::UnitX(), side.radius_mm() - std::copysign(1.0, side.bulge) * by_mm};
}

/// Returns the intersections of two curves. If the curves only touch, the same point may be returned twice.
std::vector<Vec2> intersections(const OffsetCurve& a, const OffsetCurve& b) {
  if (a.is_line && b.is_line) {
    const double sine = plane::cross(a.along, b.along);
    if (sine == 0.0) return {};
    return {a.point_mm + a.along * (plane::cross(b.point_mm - a.point_mm, b.along) / sine)};
  }
  if (a.is_line) {
    const double at = (b.point_mm - a.point_mm).dot(a.along);
    const Vec2 foot = a.point_mm + at * a.along;
    const double rest = b.radius_mm * b.radius_mm - (foot - b.point_mm).squaredNorm();
    if (rest < 0.0) return {};
    return {foot + std::sqrt(rest) * a.along, foot - std::sqrt(rest) * a.along};
  }
  if (b.is_line) return intersections(b, a);
  const Vec2 between = b.point_mm - a.point_mm;
  const double apart2 = between.squaredNorm();
  if (apart2 == 0.0) return {};
  const double at = 0.5 * (apart2 + a.radius_mm * a.radius_mm - b.radius_mm * b.radius_mm) / apart2;
  const double rest = a.radius_mm * a.radius_mm - at * at * apart2;
  if (rest < 0.0) return {};
  const Vec2 aside = std::sqrt(rest / apart2) * plane::left_of(between);
  return {a.point_mm + at * between + aside, a.point_mm + at * between - aside};
}

/// Arc that rounds a corner.
struct Fillet {
  Vec2 from_mm;
  Vec2 to_mm;
  double bulge;
  double on_first;   ///< position of `from_mm` along the side before the corner, as a fraction of the side
  double on_second;  ///< position of `to_mm` along the side after the corner, as a fraction of the side
};

/// Returns the point of a side that is nearest to the centre of a tangent circle.
Vec2 foot_on(const OutlineSide& side, const Vec2& centre_mm) {
  if (side.is_arc()) return side.centre_mm() + side.radius_mm() * (centre_mm - side.centre_mm()).normalized();
  const Vec2 along = (side.to_mm - side.from_mm).normalized();
  return side.from_mm + (centre_mm - side.from_mm).dot(along) * along;
}

/// Returns the position of a point of a side as a fraction of the side. Points before the start have a negative
/// fraction.
double fraction_of(const OutlineSide& side, const Vec2& p) {
  if (!side.is_arc()) return (p - side.from_mm).dot(side.to_mm - side.from_mm) / side.chord_mm() / side.chord_mm();
  const Vec2 start = side.from_mm - side.centre_mm();
  const Vec2 at = p - side.centre_mm();
  const double sweep = std::abs(side.sweep_rad());
  double rad = std::atan2(plane::cross(start, at), start.dot(at)) * std::copysign(1.0, side.bulge);
  const double middle = 0.5 * sweep;
  while (rad < middle - std::numbers::pi) rad += 2.0 * std::numbers::pi;
  return rad / sweep;
}

/// Returns the arc that rounds the corner between two sides, or nothing if there is no such arc.
std::optional<Fillet> fillet_of(const OutlineSide& first, const OutlineSide& second, double radius_mm) {
  const Vec2 before = first.tangent_at(1.0);
  const Vec2 after = second.tangent_at(0.0);
  const double side = plane::cross(before, after) > 0.0 ? 1.0 : -1.0;
  const OffsetCurve a = offset_curve(first, side * radius_mm);
  const OffsetCurve b = offset_curve(second, side * radius_mm);
  if ((!a.is_line && a.radius_mm <= 0.0) || (!b.is_line && b.radius_mm <= 0.0)) return std::nullopt;
  const std::vector<Vec2> centres = intersections(a, b);
  if (centres.empty()) return std::nullopt;
  const Vec2 centre = *std::ranges::min_element(centres, {}, [&](const Vec2& c) { return (c - first.to_mm).norm(); });
  Fillet fillet;
  fillet.from_mm = foot_on(first, centre);
  fillet.to_mm = foot_on(second, centre);
  fillet.on_first = fraction_of(first, fillet.from_mm);
  fillet.on_second = fraction_of(second, fillet.to_mm);
  const Vec2 from = fillet.from_mm - centre;
  const Vec2 to = fillet.to_mm - centre;
  double rad = side * std::atan2(plane::cross(from, to), from.dot(to));
  if (rad < 0.0) rad += 2.0 * std::numbers::pi;
  fillet.bulge = side * std::tan(0.25 * rad);
  return fillet;
}

/// Returns true if the second side continues the first one without a corner.
bool is_smooth(const OutlineSide& first, const OutlineSide& second) {
  constexpr double kMaxSine = 1e-12;
  const Vec2 before = first.tangent_at(1.0);
  const Vec2 after = second.tangent_at(0.0);
  return std::abs(plane::cross(before, after)) < kMaxSine && before.dot(after) > 0.0;
}

}  // namespace

double OutlineSide::sweep_rad() const {
  return 4.0 * std::atan(bulge);
}

double OutlineSide::radius_mm() const {
  return 0.25 * chord_mm() * (1.0 + bulge * bulge) / std::abs(bulge);
}

Vec2 OutlineSide::centre_mm() const {
  return 0.5 * (from_mm + to_mm) + plane::left_of(to_mm - from_mm) * (0.25 * (1.0 - bulge * bulge) / bulge);
}

Vec2 OutlineSide::tangent_at(double fraction) const {
  const Vec2 along = (to_mm - from_mm).normalized();
  return is_arc() ? rotated(along, (fraction - 0.5) * sweep_rad()) : along;
}

double enclosed_area_mm2(const OutlineLoop& loop) {
  PolygonLoop corners;
  double segments_mm2 = 0.0;
  for (const OutlineSide& side : loop) {
    corners.push_back(side.from_mm);
    if (side.is_arc()) segments_mm2 += 0.5 * side.radius_mm() * side.radius_mm() * minus_sine(side.sweep_rad());
  }
  return area(corners) + segments_mm2;
}

double Outline::area_mm2() const {
  double sum = 0.0;
  for (const OutlineLoop& loop : loops) sum += enclosed_area_mm2(loop);
  return sum;
}

Rectangle Outline::bounding_box() const {
  Rectangle box{Vec2::Constant(INFINITY), Vec2::Constant(-INFINITY)};
  const auto include = [&](const Vec2& p) {
    box.lower = box.lower.cwiseMin(p);
    box.upper = box.upper.cwiseMax(p);
  };
  for (const OutlineSide& side : loops.front()) {
    include(side.from_mm);
    if (!side.is_arc()) continue;
    for (const Vec2& axis : {Vec2(1, 0), Vec2(-1, 0), Vec2(0, 1), Vec2(0, -1)}) {
      const Vec2 extreme = side.centre_mm() + side.radius_mm() * axis;
      const double at = fraction_of(side, extreme);
      if (at > 0.0 && at < 1.0) include(extreme);
    }
  }
  return box;
}

OutlineLoop reversed(const OutlineLoop& loop) {
  OutlineLoop result;
  for (auto side = loop.rbegin(); side != loop.rend(); ++side) result.push_back(side->reversed());
  return result;
}

OutlineLoop moved(OutlineLoop loop, const Vec2& by) {
  for (OutlineSide& side : loop) {
    side.from_mm += by;
    side.to_mm += by;
  }
  return loop;
}

OutlineLoop circle(const Vec2& centre_mm, double radius_mm) {
  const Vec2 right = centre_mm + Vec2(radius_mm, 0.0);
  const Vec2 left = centre_mm - Vec2(radius_mm, 0.0);
  return {{right, left, 1.0}, {left, right, 1.0}};
}

bool is_circle(const OutlineLoop& loop) {
  constexpr double kSameBulge = 1e-9;
  const auto is_half = [](const OutlineSide& side) { return std::abs(std::abs(side.bulge) - 1.0) < kSameBulge; };
  return loop.size() == 2 && is_half(loop[0]) && is_half(loop[1]) && loop[0].bulge * loop[1].bulge > 0.0;
}

OutlineLoop with_rounded_corners(const OutlineLoop& loop, const std::vector<double>& radius_mm,
                                 std::optional<CornerFault>& fault) {
  constexpr double kFractionRounding = 1e-12;
  const std::size_t n = loop.size();
  std::vector<std::optional<Fillet>> fillets(n);
  for (std::size_t k = 0; k < n; ++k) {
    const OutlineSide& before = loop[(k + n - 1) % n];
    if (!(radius_mm[k] > 0.0) || is_smooth(before, loop[k])) continue;
    fillets[k] = fillet_of(before, loop[k], radius_mm[k]);
    if (!fillets[k] || fillets[k]->on_first < -kFractionRounding || fillets[k]->on_second > 1.0 + kFractionRounding) {
      fault = CornerFault{k};
      return loop;
    }
  }
  OutlineLoop result;
  for (std::size_t k = 0; k < n; ++k) {
    const std::optional<Fillet>& start = fillets[k];
    const std::optional<Fillet>& end = fillets[(k + 1) % n];
    const double from = start ? start->on_second : 0.0;
    const double to = end ? end->on_first : 1.0;
    if (from > to + kFractionRounding) {
      fault = CornerFault{radius_mm[k] >= radius_mm[(k + 1) % n] ? k : (k + 1) % n};
      return loop;
    }
    if (start) result.push_back({start->from_mm, start->to_mm, start->bulge});
    if (to - from <= kFractionRounding) continue;
    result.push_back({start ? start->to_mm : loop[k].from_mm, end ? end->from_mm : loop[k].to_mm,
                      loop[k].is_arc() ? std::tan(0.25 * (to - from) * loop[k].sweep_rad()) : 0.0});
  }
  // If two fillets use up the whole side between them, they meet at one point. This removes rounding errors there.
  for (std::size_t k = 0; k < result.size(); ++k) result[k].to_mm = result[(k + 1) % result.size()].from_mm;
  return result;
}

double estimated_corner_count(const OutlineLoop& loop, double tolerance_mm) {
  double count = 0.0;
  for (const OutlineSide& side : loop) {
    const double estimate =
        side.is_arc() ? std::abs(side.sweep_rad()) / std::sqrt(8.0 * tolerance_mm / side.radius_mm()) : 1.0;
    count += std::max(1.0, estimate);
  }
  return count;
}

PolygonLoop equal_area_polygon(const OutlineLoop& loop, double tolerance_mm) {
  PolygonLoop polygon;
  for (const OutlineSide& side : loop) {
    polygon.push_back(side.from_mm);
    if (!side.is_arc()) continue;
    const ArcPolygon arc = polygon_of(side, tolerance_mm);
    const Vec2 centre = side.centre_mm();
    const Vec2 start = arc.radius * (side.from_mm - centre);
    for (int k = 1; k < arc.sides; ++k) polygon.push_back(centre + rotated(start, side.sweep_rad() * k / arc.sides));
  }
  return polygon;
}

Outline oriented(std::vector<OutlineLoop> loops) {
  std::stable_sort(loops.begin(), loops.end(), [](const OutlineLoop& a, const OutlineLoop& b) {
    return std::abs(enclosed_area_mm2(a)) > std::abs(enclosed_area_mm2(b));
  });
  Outline outline;
  for (OutlineLoop& loop : loops) {
    const bool is_outer = outline.loops.empty();
    const bool is_left = enclosed_area_mm2(loop) > 0.0;
    outline.loops.push_back(is_left == is_outer ? std::move(loop) : reversed(loop));
  }
  return outline;
}

std::optional<OutlineFault> fault_of_outline(const Outline& outline, const std::vector<PolygonLoop>& polygons) {
  using Subject = OutlineFault::Subject;
  const double size_mm = bounding_box(polygons.front()).size().norm();
  const double near_mm = kNearPointFraction * size_mm;
  for (const OutlineLoop& loop : outline.loops) {
    if (auto fault = opening_of(loop, near_mm)) return fault;
    for (const OutlineSide& side : loop)
      if (side.chord_mm() <= near_mm)
        return OutlineFault{
            fmt::format("must have corners that differ, but two neighbours are at {}", at_text(side.from_mm))};
  }
  for (std::size_t k = 0; k < polygons.size(); ++k) {
    const Subject subject = k == 0 ? Subject::border : Subject::hole;
    if (polygons[k].size() < 3 || std::abs(area(polygons[k])) <= near_mm * size_mm)
      return OutlineFault{"must enclose an area", subject};
    if (const auto at = self_contact(polygons[k], near_mm))
      return OutlineFault{fmt::format("must not cross or touch itself, but does so near {}", at_text(*at)), subject};
    for (std::size_t j = 0; j < k; ++j)
      if (const auto at = contact(polygons[k], polygons[j], near_mm))
        return OutlineFault{fmt::format("must be apart from other borders, but a hole touches {} near {}",
                                        j == 0 ? "the outer border" : "another hole", at_text(*at)),
                            Subject::hole};
  }
  for (std::size_t k = 1; k < polygons.size(); ++k) {
    const std::string hole = at_text(bounding_box(polygons[k]).centre());
    if (!is_enclosed(polygons.front(), polygons[k].front()))
      return OutlineFault{fmt::format("must be inside the outer border, but the hole at {} is outside", hole),
                          Subject::hole};
    for (std::size_t j = 1; j < polygons.size(); ++j)
      if (j != k && is_enclosed(polygons[j], polygons[k].front()))
        return OutlineFault{fmt::format("must not be inside another hole, but the hole at {} is", hole), Subject::hole};
  }
  return std::nullopt;
}

}  // namespace retrace::geometry
