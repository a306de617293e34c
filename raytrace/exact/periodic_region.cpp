#include "raytrace/exact/periodic_region.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace retrace::raytrace {
namespace {

using geometry::Polygon, geometry::Rectangle;

// Maximum relative difference between the area of a period and the total area of its cells.
constexpr double kUncovered = 1e-6;
// Minimum area of a region, in units of the area of a period. In smaller regions, each element is traced separately.
constexpr double kFewestPeriodsOfRegion = 4.0;
// Minimum fraction of the region's area that must remain when cells that do not repeat are excluded. If less remains,
// each element of the region is traced separately.
constexpr double kMinRemainingFraction = 0.25;

/// Returns the minimum of normal . p over the points p of a box.
double min_along(const Vec2& normal, const Rectangle& box) {
  return (normal.array() > 0.0).select(box.lower, box.upper).dot(normal);
}

double max_along(const Vec2& normal, const Rectangle& box) {
  return -min_along(-normal, box);
}

Vec2 outward(const Polygon& outline, std::size_t side) {
  const Vec2 along = outline[(side + 1) % outline.size()] - outline[side];
  return Vec2(along.y(), -along.x()).normalized();
}

/// Returns the half-plane normal . p <= offset_mm as a rectangle that is large enough to contain the part of `polygon`
/// in the half-plane.
Polygon half_plane(const Vec2& normal, double offset_mm, const Polygon& polygon) {
  const Rectangle box = geometry::bounding_box(polygon);
  const double reach_mm = box.size().norm();
  const Vec2 middle = box.centre() + (offset_mm - normal.dot(box.centre())) * normal;
  const Vec2 along = reach_mm * Vec2(-normal.y(), normal.x());
  const Vec2 back = 2.0 * reach_mm * normal;
  return {middle - along, middle + along, middle + along - back, middle - along - back};
}

/// Returns true if a polygon is inside an outline, with the tolerance `near_mm`.
/// \pre the outline is convex
bool is_inside(const Polygon& polygon, const Polygon& outline, double near_mm) {
  for (std::size_t side = 0; side < outline.size(); ++side)
    for (const Vec2& p : polygon)
      if (outward(outline, side).dot(p - outline[side]) > near_mm) return false;
  return true;
}

}  // namespace

PeriodicRegion::PeriodicRegion(Polygon outline, const std::array<Vec2, 2>& periods_mm,
                               const std::vector<PlacedCell>& cells, double near_mm)
    : outline_mm_(std::move(outline)), periods_mm_(periods_mm), near_mm_(near_mm) {
  const double period_mm2 = periods_mm[0].norm() * periods_mm[1].norm();
  if (geometry::area(outline_mm_) < kFewestPeriodsOfRegion * period_mm2) return;
  const std::vector<PlacedCell> of_a_period = cells_of_a_period(cells);
  if (of_a_period.empty()) return;
  for (std::size_t side = 0; side < outline_mm_.size(); ++side) {
    const Vec2 normal = outward(outline_mm_, side);
    sides_.push_back({normal, normal.dot(outline_mm_[side])});
  }
  for (const PlacedCell& cell : cells)
    if (!is_of_lattice(cell, of_a_period)) exclude(cell.box_mm);
  Polygon rest = outline_mm_;
  for (const Side& side : sides_)
    rest = geometry::clip(rest, half_plane(side.normal, side.offset_mm, outline_mm_), near_mm);
  if (rest.empty() || geometry::area(rest) < kMinRemainingFraction * geometry::area(outline_mm_)) sides_.clear();
}

/// Returns one representative cell for each position in the period, selected near the centroid of the region. Together
/// these cells cover one period. The list is empty if the area of the selected cells is not that of one period.
std::vector<PlacedCell> PeriodicRegion::cells_of_a_period(const std::vector<PlacedCell>& cells) const {
  const Vec2 middle = geometry::centroid(outline_mm_);
  const double reach_mm = periods_mm_[0].norm() + periods_mm_[1].norm();
  std::vector<PlacedCell> near;
  const auto distance = [&](const PlacedCell& cell) { return (cell.box_mm.centre() - middle).norm(); };
  for (const PlacedCell& cell : cells)
    if (distance(cell) < reach_mm) near.push_back(cell);
  std::stable_sort(near.begin(), near.end(),
                   [&](const PlacedCell& a, const PlacedCell& b) { return distance(a) < distance(b); });
  const double period_mm2 = periods_mm_[0].norm() * periods_mm_[1].norm();
  std::vector<PlacedCell> own;
  double covered_mm2 = 0.0;
  for (auto cell = near.begin(); cell != near.end() && covered_mm2 < (1.0 - kUncovered) * period_mm2; ++cell) {
    if (is_of_lattice(*cell, own)) continue;
    own.push_back(*cell);
    covered_mm2 += cell->area_mm2;
  }
  if (std::abs(covered_mm2 - period_mm2) > kUncovered * period_mm2) return {};
  return own;
}

bool PeriodicRegion::is_of_lattice(const PlacedCell& cell, const std::vector<PlacedCell>& of_a_period) const {
  return std::any_of(of_a_period.begin(), of_a_period.end(), [&](const PlacedCell& own) {
    if (own.instance.id != cell.instance.id) return false;
    Vec2 away = cell.instance.offset_mm - own.instance.offset_mm;
    for (const Vec2& period : periods_mm_) away -= std::round(away.dot(period) / period.squaredNorm()) * period;
    return away.norm() <= near_mm_;
  });
}

/// Excludes a box from the region by moving one side inward. The side that needs the smallest displacement is selected.
void PeriodicRegion::exclude(const Rectangle& box_mm) {
  Side* nearest = nullptr;
  double least_loss = std::numeric_limits<double>::infinity();
  for (Side& side : sides_) {
    const double loss = side.offset_mm - min_along(side.normal, box_mm);
    if (loss <= 0.0) return;
    if (loss < least_loss) nearest = &side;
    least_loss = std::min(loss, least_loss);
  }
  nearest->offset_mm -= least_loss;
}

std::vector<PeriodicRegion::Tiles> PeriodicRegion::tiles(const Vec2& max_step_mm) const {
  const std::array<Vec2, 2> along = {periods_mm_[0].normalized(), periods_mm_[1].normalized()};
  const auto in_lattice = [&](const Vec2& p) { return Vec2(along[0].dot(p), along[1].dot(p)); };
  const auto in_plan = [&](const Vec2& p) -> Vec2 { return p.x() * along[0] + p.y() * along[1]; };
  Polygon outline;
  for (const Vec2& p : outline_mm_) outline.push_back(in_lattice(p));
  const Rectangle box = geometry::bounding_box(outline);
  const Vec2 period_mm(periods_mm_[0].norm(), periods_mm_[1].norm());
  const Vec2 parts = period_mm.cwiseQuotient(max_step_mm).array().round().max(1.0);
  const Vec2 step = period_mm.cwiseQuotient(parts);
  const Vec2 counts = (box.size().cwiseQuotient(step).array() - kUncovered).ceil();
  std::vector<Tiles> all(static_cast<std::size_t>(parts.prod()));
  std::vector<Vec2> firsts(all.size());
  for (double j = 0.0; j < counts.y(); j += 1.0)
    for (double i = 0.0; i < counts.x(); i += 1.0) {
      const Vec2 lower = box.lower + step.cwiseProduct(Vec2(i, j));
      const Polygon tile = geometry::to_polygon({lower, lower + step});
      const auto part = static_cast<std::size_t>(std::fmod(j, parts.y()) * parts.x() + std::fmod(i, parts.x()));
      Polygon placed;
      for (const Vec2& p : tile) placed.push_back(in_plan(p));
      if (!is_inside(placed, outline_mm_, near_mm_)) {
        all[part].at_border.push_back(std::move(placed));
        continue;
      }
      if (all[part].inner.empty()) {
        all[part].first = std::move(placed);
        firsts[part] = lower;
      }
      all[part].inner.push_back(in_plan(lower - firsts[part]));
    }
  return all;
}

bool PeriodicRegion::contains(const Rectangle& box_mm, const Vec2& by) const {
  return is_periodic() && std::all_of(sides_.begin(), sides_.end(), [&](const Side& side) {
           return max_along(side.normal, box_mm) + side.normal.dot(by) <= side.offset_mm + near_mm_;
         });
}

std::vector<InstanceOffsets> PeriodicRegion::divided(const InstanceOffsets& places, const Rectangle& sweep) const {
  InstanceOffsets inside;
  std::vector<InstanceOffsets> all;
  for (const Vec2& by : places) {
    if (contains(sweep, by))
      inside.push_back(by);
    else
      all.push_back({by});
  }
  if (all.empty()) return {};
  if (!inside.empty()) all.push_back(std::move(inside));
  return all;
}

}  // namespace retrace::raytrace
