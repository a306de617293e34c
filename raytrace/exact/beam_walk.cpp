#include "raytrace/exact/beam_walk.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "raytrace/exact/beam_entrance.h"
#include "raytrace/exact/beam_faces.h"
#include "raytrace/exact/beam_reach.h"

namespace retrace::raytrace {
namespace {

constexpr double kLastCutoff = 1e-25;
// Factors by which the cut-off decreases between passes. A pass traces all beams above the present cut-off. kGentleFall
// is used for coarse goals. After a decrease by the factor kFall, a pass may trace many more beams than a coarse goal
// requires.
constexpr double kFall = 0.1;
constexpr double kGentleFall = 0.3;
// Work per beam, except for the search for facets, as measured. The unit is one test of a bounding box
// (BeamWalk::work()).
constexpr std::uint64_t kWorkOfBeam = 50;
// Number of copies of a beam that are compared with the borders in one unit of BeamWalk::work().
constexpr std::size_t kPlacesPerWork = 16;
// Exponent s of the work, which is proportional to (truncated power)^-s. This value is assumed until two passes have
// been measured.
constexpr double kUsualSlope = 0.5;

}  // namespace

void BeamWalk::enter(double cutoff, CutoffMode approach) {
  cutoff_ = cutoff;
  mode_ = approach;
  record_.enter();
  enter_beams(scene_, record_, queue_);
  pass_ = {0.0, queue_.pending_power()};
  // With a coarse goal, the first cut-off is relative to the mean power of the beams that enter.
  if (mode_ == CutoffMode::decreasing && scene_.policy.truncated_goal > kFinestGoal)
    cutoff_ *= queue_.pending_power() / static_cast<double>(queue_.pending_count());
}

BeamWalk::End BeamWalk::run(std::uint64_t max_work, const Cancellation* cancel) {
  const BeamPolicy& policy = scene_.policy;
  for (;;) {
    while (queue_.has_pending() && !may_stop()) {
      if (is_cancelled(cancel)) return End::cancelled;
      if (work() >= max_work) return End::paused;
      queue_.require_memory();
      Beam beam = queue_.pop();
      if (power_for_cutoff(beam) < cutoff_) {
        // CutoffMode::deferring stores all beams. The other modes discard beams while the queue is full. A lower
        // cut-off then requires a new trace.
        queue_.defer(std::move(beam), mode_ != CutoffMode::deferring);
        if (queue_.deferred().size() >= max_deferred_) return End::paused;
        continue;
      }
      if (++beams_ > policy.max_beams) fail_on_budget();
      if (beam.instance_offsets) split_instances(beam);
      advance(beam, cancel);
    }
    if (mode_ == CutoffMode::deferring) return End::done;
    const bool is_enough = mode_ == CutoffMode::fixed || queue_.open_power() <= policy.truncated_goal;
    if ((is_enough && (may_stop() || policy.spare_work <= work())) || cutoff_ < kLastCutoff) break;
    if (queue_.is_full()) {
      if (is_enough) break;
      return End::cutoff_too_high;
    }
    lower_cutoff();
  }
  close();
  return End::done;
}

/// Returns true if the present pass may stop. This depends on the mode:
/// - CutoffMode::decreasing: the open power is at most the goal. Until BeamPolicy::spare_work has been done, the goal
///   is kFinestGoal, because fast traces can afford a higher accuracy. The pass may stop at any time, because the open
///   power never increases.
/// - CutoffMode::decreasing with a goal of at most kFinestGoal: no beam is pending, and the power of the deferred beams
///   is at most the goal. The power of pending beams is not used, because its rounding errors are too large.
/// - Other modes: no beam is pending.
bool BeamWalk::may_stop() const {
  const BeamPolicy& policy = scene_.policy;
  if (mode_ != CutoffMode::decreasing) return !queue_.has_pending();
  if (policy.truncated_goal <= kFinestGoal)
    return !queue_.has_pending() && queue_.deferred_power() <= policy.truncated_goal;
  return queue_.open_power() <= (work() < policy.spare_work ? kFinestGoal : policy.truncated_goal);
}

void BeamWalk::lower_cutoff() {
  lower_cutoff_to(cutoff_ * (scene_.policy.truncated_goal <= kFinestGoal ? kFall : kGentleFall));
}

void BeamWalk::lower_cutoff_to(double cutoff) {
  cutoff_ = cutoff;
  pass_ = {static_cast<double>(work()), queue_.deferred_power()};
  queue_.resume_deferred();
}

/// Ends the trace. The open power is added to `truncated`.
void BeamWalk::close() {
  queue_.discard_pending();
  record_.add_truncated(queue_.deferred_power());
}

/// Returns the expected total work. It is extrapolated with a power law between work and open power. The work of the
/// present pass is extrapolated linearly from the fraction of the power that has been processed.
double BeamWalk::expected_work() const {
  const auto done = static_cast<double>(work());
  const double goal = scene_.policy.truncated_goal;
  const double settled = 1.0 - queue_.pending_power() / pass_.power;
  if (settled < 0.01) return 2.0 * done;
  const Pass end{pass_.work + (done - pass_.work) / settled, std::max(queue_.deferred_power() / settled, 1e-300)};
  if (mode_ == CutoffMode::fixed || end.power <= goal) return std::max(end.work, done);
  const bool has_slope = pass_.work > 0.0 && end.power < 0.9 * pass_.power;
  const double slope = has_slope ? std::log(end.work / pass_.work) / std::log(pass_.power / end.power) : kUsualSlope;
  return end.work * std::pow(end.power / goal, std::clamp(slope, 0.2, 2.0));
}

BeamResult BeamWalk::result() const {
  BeamResult result = record_.result();
  result.beams = beams_;
  result.depth = depth_;
  result.cutoff = cutoff_;
  return result;
}

void BeamWalk::step(const Beam& beam, const Cancellation* cancel) {
  ++beams_;
  advance(beam, cancel);
}

WaitingBeams BeamWalk::take_waiting() {
  queue_.require_memory();
  return queue_.take_pending();
}

Beam BeamWalk::instance(const Beam& beam, std::size_t index) const {
  if (!beam.instance_offsets) return beam;
  return moved(beam, (*beam.instance_offsets)[index], scene_.setup.to_source, scene_.index_at(beam.inside));
}

/// Splits the copies of a beam into groups that meet the same facets in the next step. The beam keeps its own group,
/// and the other groups are queued as new beams. The horizon (the length of the next step) is the same for all copies
/// of a group. The reason is that along each axis, either all copies of a group have the same position, or no border is
/// within the horizon of any copy.
void BeamWalk::split_instances(Beam& beam) {
  if (scene_.setup.infinite()) return;
  work_ += beam.instance_offsets->size() / kPlacesPerWork;
  const PlanBox sweep = sweep_of(scene_, beam);
  std::vector<InstanceOffsets> groups =
      scene_.symmetry->divided(*beam.instance_offsets, {sweep.lower, sweep.upper}, beam.region);
  if (groups.size() <= 1) return;
  for (InstanceOffsets& group : groups) {
    const Vec2 first = group.front();
    if (first.isZero(0.0)) continue;
    Beam other = moved(beam, first, scene_.setup.to_source, scene_.index_at(beam.inside));
    for (Vec2& by : group) by -= first;
    other.instance_offsets = queue_.shared(std::move(group));
    queue_.push(std::move(other));
  }
  const auto own = std::find_if(groups.begin(), groups.end(), [](const InstanceOffsets& group) {
    return !group.empty() && group.front().isZero(0.0);
  });
  beam.instance_offsets = queue_.shared(std::move(*own));
}

/// Traces a beam to the next faces.
void BeamWalk::advance(const Beam& beam, const Cancellation* cancel) {
  depth_ = std::max(depth_, beam.depth);
  work_ += kWorkOfBeam;
  const Frame frame(beam.direction);
  const FlatPolygon whole = flattened(beam.corners, frame, scene_.merge_mm);
  const double whole_area = area(whole);
  if (whole_area <= scene_.min_area) {
    record_.add_rounding_loss(beam, beam.area_fraction);
    return;
  }
  const BeamStep step{scene_, beam, frame, horizon_of(scene_, beam), record_, queue_};
  facets_.find(beam, frame, whole, step.horizon);
  double used = 0.0;
  const auto fragment = [&](const FlatPolygon& piece) {
    const double share = beam.area_fraction * area(piece) / whole_area;
    used += share;
    return Fragment{piece, share};
  };
  double met_area = 0.0;
  for (std::size_t k = 0; k < facets_.size(); ++k) {
    if (is_cancelled(cancel)) return;
    for (const FlatPolygon& piece : facets_.take_visible_on_plane_of(k)) {
      met_area += area(piece);
      meet_facet(step, fragment(piece), facets_[k]);
    }
  }
  if (whole_area - met_area > scene_.min_area)
    for (const FlatPolygon& piece : facets_.unblocked(whole)) pass_facets(step, fragment(piece));
  record_.add_rounding_loss(beam, beam.area_fraction - used);
}

/// Throws the error for a trace that exceeds BeamPolicy::max_beams.
void BeamWalk::fail_on_budget() const {
  throw TraceBudgetError(
      fmt::format("the limit of {} beams is reached before all power is traced; the remaining fraction of the power is "
                  "{:.3g}; use a larger {} to follow fewer beams",
                  scene_.policy.max_beams, queue_.open_power(), reference({"cutoff"})));
}

}  // namespace retrace::raytrace
