#include "raytrace/exact/beam_tracer.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "core/task_progress.h"
#include "raytrace/exact/beam_generation.h"
#include "raytrace/exact/beam_walk.h"
#include "raytrace/exact/element_memory.h"
#include "raytrace/sampling/entrance_sampler.h"
#include "raytrace/sampling/replicate_means.h"

namespace retrace::raytrace {
namespace {

// The first cut-off is kFirstCutoffOfGoal times the power that may be truncated, limited to the range from kFirstCutoff
// to kHighestFirstCutoff. Later cut-offs are lower.
constexpr double kFirstCutoffOfGoal = 100.0;
constexpr double kFirstCutoff = 1e-6;
constexpr double kHighestFirstCutoff = 1e-3;
// The truncated power is assumed to decrease at least as (cut-off)^kSlowestFall.
constexpr double kSlowestFall = 0.7;
// Maximum number of weak beams that are queued before they are resampled. They take about 30 MB.
constexpr std::size_t kMaxWaiting = 50'000;
// Progress is reported when the work of BeamTrace has grown by 5 % and by kWorkBetweenReports (about 0.1 s) since the
// last report.
constexpr double kWorkBetweenReports = 3e6;
constexpr double kGrowthBetweenReports = 1.05;

/// Returns `part` unchanged if its elements fit into the memory budget.
/// \throw BudgetError if the elements exceed the memory budget
const geometry::Part& within_memory(const geometry::Part& part) {
  require_element_memory(part);
  return part;
}

}  // namespace

BeamTracer::BeamTracer(const geometry::Part& part, Elements elements)
    : part_(within_memory(part)), centre_mm_(EntranceSampler(part).centre_mm()), cells_(part, centre_mm_) {
  if (elements == Elements::instanced) symmetry_ = TranslationalSymmetry::of(part, centre_mm_);
}

BeamScene BeamTracer::scene(const LightSetup& setup, const BeamPolicy& policy) const {
  return {part_, centre_mm_, cells_, setup, policy, symmetry_ ? &*symmetry_ : nullptr};
}

BeamResult BeamTracer::trace(const Optics& optics, const Illumination& illumination,
                             const std::vector<double>& cones_deg, const BeamPolicy& policy, const Cancellation* cancel,
                             const BeamObserver& observer, Progress* progress) const {
  if (policy.population_control)
    return trace_with_population_control(optics, illumination, cones_deg, policy, cancel, observer);
  const auto traced = [&](const BeamPolicy& how, const BeamObserver& told, PartProgress part) {
    BeamTrace trace(*this, optics, illumination, cones_deg, how, told);
    double share = 0.0;
    while (!trace.advance(static_cast<std::uint64_t>(kWorkBetweenReports + kGrowthBetweenReports * trace.work()),
                          cancel)) {
      if (is_cancelled(cancel)) break;
      share = std::max(share, trace.work() / trace.expected_work());
      part.at(share);
    }
    return trace.result();
  };
  if (policy.cutoff || !observer) return traced(policy, observer, {progress, 0.0, 1.0});
  BeamPolicy found = policy;
  const BeamResult first = traced(policy, {}, {progress, 0.0, 0.5});
  found.cutoff = first.cutoff;
  return first.complete ? traced(found, observer, {progress, 0.5, 1.0}) : first;
}

namespace {

/// Combines the result of the strong beams, which are traced exactly, with the replicates of the weak beams.
/// \param unseen minimum of the standard error; it allows for power in beams that no replicate has traced
BeamResult with_replicates(const BeamWalk& strong, const std::vector<BeamWalk>& replicates,
                           const std::vector<double>& cones_deg, double unseen) {
  BeamResult result = strong.result();
  std::vector<Tally> sums;
  for (const BeamWalk& walk : replicates) {
    sums.push_back(strong.tally());
    sums.back().add(walk.tally());
    result.beams += walk.beams();
    result.depth = std::max(result.depth, walk.depth());
  }
  const MonteCarloResult means = result_of(sums, 1, cones_deg);
  const double widened = student_factor(replicates.size());
  for (std::size_t cone = 0; cone < cones_deg.size(); ++cone) {
    result.ledgers[cone] = means.cones[cone].ledger;
    result.stokes[cone] = means.cones[cone].stokes;
    result.std_error[cone] = std::max(unseen, widened * means.cones[cone].std_error);
  }
  return result;
}

}  // namespace

BeamResult BeamTracer::trace_with_population_control(const Optics& optics, const Illumination& illumination,
                                                     const std::vector<double>& cones_deg, const BeamPolicy& policy,
                                                     const Cancellation* cancel, const BeamObserver& observer) const {
  const PopulationControl& weak = *policy.population_control;
  const LightSetup setup(part_, centre_mm_, optics, illumination, cones_deg);
  const BeamScene scene = this->scene(setup, policy);
  BeamWalk strong(scene, observer);
  std::vector<BeamWalk> replicates;
  for (std::uint32_t k = 0; k < weak.replicates; ++k) {
    replicates.emplace_back(scene, observer);
    replicates.back().set_replicate(k);
  }
  strong.pause_at_deferred(kMaxWaiting);
  strong.enter(*policy.cutoff, BeamWalk::CutoffMode::deferring);
  const double most_power = weak.survivor_power_ratio * *policy.cutoff;
  double power = 0.0;
  bool is_done = false;
  for (std::uint32_t round = 0; !is_done; ++round) {
    const auto end = strong.run(std::numeric_limits<std::uint64_t>::max(), cancel);
    is_done = end == BeamWalk::End::done;
    bool goes_on = is_done || end == BeamWalk::End::paused;
    const WaitingBeams kept = strong.take_deferred();
    const BeamGeneration first(part_, kept);
    if (first.is_significant()) power += first.power();
    for (std::uint32_t k = 0; k < weak.replicates && goes_on; ++k)
      goes_on = follow_survivors(replicates[k], part_, first, {most_power, weak.seed, k, round}, cancel);
    if (goes_on) continue;
    BeamResult none = strong.result();
    none.complete = false;
    return none;
  }
  return with_replicates(strong, replicates, cones_deg, std::min(most_power, power) / weak.replicates);
}

BeamTrace::BeamTrace(const BeamTracer& tracer, const Optics& optics, const Illumination& illumination,
                     const std::vector<double>& cones_deg, const BeamPolicy& policy, BeamObserver observer)
    : tracer_(tracer),
      setup_(tracer.part_, tracer.centre_mm_, optics, illumination, cones_deg),
      policy_(policy),
      observer_(std::move(observer)),
      cutoff_(policy.cutoff.value_or(
          std::clamp(kFirstCutoffOfGoal * policy.truncated_goal, kFirstCutoff, kHighestFirstCutoff))) {
  start();
}

BeamTrace::~BeamTrace() = default;

void BeamTrace::start() {
  walk_ = std::make_unique<BeamWalk>(tracer_.scene(setup_, policy_), observer_);
  walk_->enter(cutoff_, policy_.cutoff ? BeamWalk::CutoffMode::fixed : BeamWalk::CutoffMode::decreasing);
}

bool BeamTrace::advance(std::uint64_t max_work, const Cancellation* cancel) {
  while (!is_done_ && work() < static_cast<double>(max_work)) {
    const auto end = walk_->run(max_work - static_cast<std::uint64_t>(work_before_), cancel);
    is_done_ = end == BeamWalk::End::done;
    if (end != BeamWalk::End::cutoff_too_high) return is_done_;
    policy_.max_beams -= walk_->beams();
    work_before_ = work();
    const double fall = std::pow(policy_.truncated_goal / walk_->deferred_power(), 1.0 / kSlowestFall);
    cutoff_ = walk_->cutoff() * std::clamp(fall, 1e-4, 0.1);
    start();
  }
  return is_done_;
}

double BeamTrace::work() const {
  return work_before_ + static_cast<double>(walk_->work());
}

double BeamTrace::expected_work() const {
  return work_before_ + std::max(walk_->expected_work(), work_before_);
}

BeamResult BeamTrace::result() const {
  BeamResult result = walk_->result();
  result.complete = is_done_;
  return result;
}

}  // namespace retrace::raytrace
