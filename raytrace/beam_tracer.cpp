#include "raytrace/beam_tracer.h"

#include <algorithm>
#include <utility>

#include "raytrace/beam_walk.h"
#include "raytrace/entrance_sampler.h"

namespace retrace::raytrace {
namespace {

// The cut-off starts here and falls tenfold until little enough is left behind.
constexpr double kFirstCutoff = 1e-6;
// Power left behind falls at least about as the cut-off to this power.
constexpr double kSlowestFall = 0.7;

geometry::Polygon entrance_of(const geometry::Part& part) {
  if (part.period_mm) return geometry::to_polygon({Vec2::Zero(), *part.period_mm});
  return part.outline;
}

}  // namespace

BeamTracer::BeamTracer(const geometry::Part& part)
    : part_(part), centre_mm_(EntranceSampler(part).centre_mm()), cells_(part, centre_mm_) {}

BeamResult BeamTracer::trace(const Optics& optics, const Illumination& illumination,
                             const std::vector<double>& cones_deg, const BeamPolicy& policy, const Cancellation* cancel,
                             const BeamObserver& observer) const {
  const LightSetup setup(part_, centre_mm_, optics, illumination, cones_deg);
  if (policy.cutoff) return follow(setup, policy, *policy.cutoff, cancel, observer);
  const BeamResult result = find_cutoff(setup, policy, cancel);
  return observer && result.complete ? follow(setup, policy, result.cutoff, cancel, observer) : result;
}

BeamResult BeamTracer::follow(const LightSetup& setup, const BeamPolicy& policy, double cutoff,
                              const Cancellation* cancel, const BeamObserver& observer) const {
  BeamWalk walk(part_, centre_mm_, cells_, setup, policy, observer);
  walk.enter(entrance_of(part_));
  return walk.result(walk.run(cutoff, BeamWalk::Approach::fixed, cancel));
}

BeamResult BeamTracer::find_cutoff(const LightSetup& setup, BeamPolicy policy, const Cancellation* cancel) const {
  for (double cutoff = kFirstCutoff;;) {
    BeamWalk walk(part_, centre_mm_, cells_, setup, policy, {});
    walk.enter(entrance_of(part_));
    const auto end = walk.run(cutoff, BeamWalk::Approach::falling, cancel);
    if (end != BeamWalk::End::cutoff_too_high) return walk.result(end);
    policy.max_beams -= walk.beams();
    const double fall = std::pow(policy.truncated_goal / walk.left_behind(), 1.0 / kSlowestFall);
    cutoff = walk.cutoff() * std::clamp(fall, 1e-4, 0.1);
  }
}

}  // namespace retrace::raytrace
