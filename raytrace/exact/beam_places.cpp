// Beams that represent copies at identical elements. These member functions of BeamWalk start one beam for several
// positions of an array. Near a border, where the copies meet different facets, they split the list of positions.
#include <algorithm>

#include "core/infinity.h"
#include "raytrace/exact/beam_walk.h"

namespace retrace::raytrace {
namespace {

// Number of positions of a beam whose comparison with the borders counts as one unit of BeamWalk::work().
constexpr std::size_t kPlacesPerWork = 16;

/// An interval of the entrance face along one axis, and the displacements to its copies.
struct Span {
  double from = 0.0;
  double to = 0.0;
  std::vector<double> shifts;
};

/// Divides a side of the entrance face into intervals, with `steps` intervals per period. Intervals that are a multiple
/// of the period apart are one Span. The last interval of the side may be shorter and is then a Span of its own.
std::vector<Span> spans(double lower, double upper, double period, int steps) {
  std::vector<Span> all;
  const double step = period / steps;
  const double near = 1e-9 * step;
  for (int k = 0; k < steps; ++k) {
    const double from = lower + k * step;
    Span whole{from, from + step, {}};
    for (std::int64_t i = 0;; ++i) {
      const double shift = static_cast<double>(i) * period;
      if (from + shift + step <= upper + near) {
        whole.shifts.push_back(shift);
        continue;
      }
      if (from + shift < upper - near) all.push_back({from + shift, upper, {0.0}});
      break;
    }
    if (!whole.shifts.empty()) all.push_back(std::move(whole));
  }
  return all;
}

/// Returns the part of a polygon whose projection along z is inside a convex outline.
Corners within(Corners corners, const geometry::Polygon& outline) {
  for (std::size_t k = 0; k < outline.size() && !corners.empty(); ++k) {
    const Vec2 along = (outline[(k + 1) % outline.size()] - outline[k]).normalized();
    const Vec3 inward(-along.y(), along.x(), 0.0);
    corners = cut(corners, {inward, inward.head<2>().dot(outline[k])});
  }
  return corners;
}

}  // namespace

Beam BeamWalk::at_place(const Beam& beam, std::size_t place) const {
  if (!beam.places) return beam;
  return moved(beam, (*beam.places)[place], setup_.to_source, index_at(beam.inside));
}

/// Divides the incident beam into fragments, each of which represents its copies at all full periods of the array.
/// \pre the entrance face is a rectangle with sides along the x and y axes
void BeamWalk::enter_at_places(const Beam& whole, double parts) {
  const Frame from_above(-Vec3::UnitZ());
  const double whole_area = area(flattened(whole.corners, from_above, merge_mm_));
  PlanBox box;
  for (const Vec3& p : whole.corners) box.include(p.head<2>());
  const Vec2& period = equal_->period_mm();
  const Vec2 steps = period.cwiseQuotient(step_of_entrance(parts)).array().round().max(1.0);
  const auto along = [&](Eigen::Index axis) {
    return spans(box.lower[axis], box.upper[axis], period[axis], static_cast<int>(steps[axis]));
  };
  double entered = 0.0;
  for (const Span& y : along(1)) {
    const Corners row = cut(cut(whole.corners, {Vec3::UnitY(), y.from}), {-Vec3::UnitY(), -y.to});
    for (const Span& x : along(0)) {
      Beam piece = whole;
      piece.corners = cut(cut(row, {Vec3::UnitX(), x.from}), {-Vec3::UnitX(), -x.to});
      piece.share = piece.corners.empty() ? 0.0 : area(flattened(piece.corners, from_above, merge_mm_)) / whole_area;
      if (piece.share <= 0.0) continue;
      BeamPlaces places;
      for (const double up : y.shifts)
        for (const double right : x.shifts) places.emplace_back(right, up);
      piece.places = shared(std::move(places));
      entered += piece.share * piece.place_count();
      pend(std::move(piece));
    }
  }
  book_rest(whole, 1.0 - entered);
}

/// Starts the beams that enter through the part of the entrance face above one region.
/// \param whole incident beam on the whole entrance face
/// \param number index of the region in EqualPlaces::regions()
/// \return the fraction of the incident light that enters above the region
double BeamWalk::enter_region(const Beam& whole, std::uint32_t number, const Vec2& most_step_mm) {
  const RepeatRegion& region = equal_->regions()[number];
  const Frame from_above(-Vec3::UnitZ());
  const double whole_area = area(flattened(whole.corners, from_above, merge_mm_));
  double entered = 0.0;
  const auto enter = [&](const geometry::Polygon& tile, BeamPlaces places) {
    Beam piece = whole;
    for (const geometry::Polygon* outline : {&tile, &region.outline_mm()})
      piece.corners = within(std::move(piece.corners), *outline);
    piece.share = piece.corners.empty() ? 0.0 : area(flattened(piece.corners, from_above, merge_mm_)) / whole_area;
    if (piece.share <= 0.0) return;
    piece.places = shared(std::move(places));
    piece.region = number;
    entered += piece.share * piece.place_count();
    pend(std::move(piece));
  };
  for (const RepeatRegion::Tiles& tiles : region.tiles(most_step_mm)) {
    if (!tiles.inner.empty()) enter(tiles.first, tiles.inner);
    for (const geometry::Polygon& tile : tiles.at_border) enter(tile, {});
  }
  return entered;
}

void BeamWalk::enter_regions(const Beam& whole, double parts) {
  double entered = 0.0;
  for (std::uint32_t region = 0; region < equal_->regions().size(); ++region)
    entered += enter_region(whole, region, step_of_entrance(parts));
  book_rest(whole, 1.0 - entered);
}

/// Starts the beams that enter one period of an infinite part. If the two halves of the period are identical, only one
/// half is traced.
void BeamWalk::enter_within_period(const Beam& whole, double parts) {
  Beam half = whole;
  if (const auto& by = equal_->within_period_mm()) {
    const Eigen::Index axis = by->y() > 0.0 ? 1 : 0;
    PlanBox box;
    for (const Vec3& p : whole.corners) box.include(p.head<2>());
    const double middle = box.lower[axis] + 0.5 * equal_->period_mm()[axis];
    half.corners = cut(whole.corners, {-Vec3::Unit(axis), -middle});
    half.share = 0.5;
    half.places = shared({Vec2::Zero(), *by});
  }
  if (parts == 1.0)
    pend(std::move(half));
  else
    enter_in_pieces(half, step_of_entrance(parts));
}

/// Returns a box in x and y around all points at which a beam may meet a face in its next step. The box is the whole
/// plane if the beam is inside the part and nearly horizontal, and may travel to a side face.
PlanBox BeamWalk::sweep_of(const Beam& beam) const {
  const Horizon horizon = horizon_of(beam);
  const double dz = beam.direction.z();
  PlanBox box;
  if (beam.inside && horizon.t == 0.0 && dz <= kGrazing) return {-box.lower, -box.upper};
  for (const Vec3& p : beam.corners) {
    box.include(p.head<2>());
    box.include((p + horizon.t * beam.direction).head<2>());
    if (beam.inside && !horizon.limited && dz > 0.0)
      box.include((p + (setup_.thickness_mm - p.z()) / dz * beam.direction).head<2>());
  }
  return box;
}

/// Splits the copies of a beam into groups that meet the same facets in the next step. The beam keeps its own group,
/// and the other groups are queued as new beams. The horizon (the length of the next step) is the same for all groups.
/// Along an axis in which the positions of two groups differ, no border of the part is within the horizon. Along the
/// other axis, both groups have the same distance from the border.
void BeamWalk::keep_equal_places(Beam& beam) {
  if (setup_.infinite()) return;
  work_ += beam.places->size() / kPlacesPerWork;
  const PlanBox sweep = sweep_of(beam);
  std::vector<BeamPlaces> groups = equal_->divided(*beam.places, {sweep.lower, sweep.upper}, beam.region);
  if (groups.size() <= 1) return;
  for (BeamPlaces& group : groups) {
    const Vec2 first = group.front();
    if (first.isZero(0.0)) continue;
    Beam other = moved(beam, first, setup_.to_source, index_at(beam.inside));
    for (Vec2& by : group) by -= first;
    other.places = shared(std::move(group));
    pend(std::move(other));
  }
  const auto own = std::find_if(groups.begin(), groups.end(),
                                [](const BeamPlaces& group) { return !group.empty() && group.front().isZero(0.0); });
  beam.places = shared(std::move(*own));
}

}  // namespace retrace::raytrace
