#include "raytrace/exact/stochastic_beams.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/error.h"
#include "core/random.h"
#include "core/threads.h"
#include "raytrace/exact/beam_generation.h"
#include "raytrace/exact/beam_walk.h"
#include "raytrace/sampling/replicate_means.h"

namespace retrace::raytrace {
namespace {

/// Number of the Philox random stream that is used for the rays of scattered light.
constexpr std::uint32_t kScatterStream = 8;
constexpr double kFirstThreshold = 1e-3;
constexpr double kLastThreshold = 1e-10;
// Upper limit of the factor by which the threshold decreases between rounds. kMargin is an additional factor, because
// the standard error is known only to about 20 %.
constexpr double kGentlestFall = 0.5;
constexpr double kMargin = 0.8;
// Maximum number of beams that are kept for the replicates. They take about 100 MB.
constexpr std::size_t kMaxDeferred = 200'000;
// Maximum power of a ray of scattered light: the value in the first round, and the value at which the rounds end.
constexpr double kFirstRayPower = 1e-3;
constexpr double kLastRayPower = 1e-10;
// Fraction of the target error that is allowed for the error of the beams, and also for the error of the rays of
// scattered light. It is used if facets scatter light. The two errors add in quadrature.
constexpr double kFractionOfTarget = 0.7;
// Work of tracing a ray segment, in units of BeamTrace::work().
constexpr std::uint64_t kLooksPerSegment = 25;

}  // namespace

struct StochasticBeams::Replicate {
  Tally beams;
  Tally rays;  ///< light that is scattered out of beams
  std::uint64_t beam_work = 0;
  std::uint64_t beam_count = 0;
};

StochasticBeams::StochasticBeams(const BeamTracer& tracer, const ScatteredLight* scattered, const Optics& optics,
                                 const Illumination& illumination, const std::vector<double>& cones_deg,
                                 const Sampling& sampling, const Cancellation* cancel, BeamObserver observer)
    : tracer_(tracer),
      setup_(tracer.part_, tracer.centre_mm_, optics, illumination, cones_deg),
      scattered_(scattered),
      cones_deg_(cones_deg),
      sampling_(sampling),
      cancel_(cancel),
      strong_(std::make_unique<BeamWalk>(tracer.scene(setup_, policy_), std::move(observer))),
      threshold_(kFirstThreshold),
      ray_power_(std::min(kFirstRayPower, kReplicates * sampling.target_error)) {
  if (scattered_ != nullptr) strong_->collect_scatter_sites(strong_sites_);
  strong_->enter(threshold_, BeamWalk::CutoffMode::deferring);
}

StochasticBeams::~StochasticBeams() = default;

bool StochasticBeams::advance() try { return follow_round(); } catch (const BudgetError&) {
  if (round_ == 0) throw;
  return true;
}

bool StochasticBeams::follow_round() {
  if (round_ > 0) {
    ray_power_ = next_ray_power();
    threshold_ = next_threshold();
    strong_->lower_cutoff_to(threshold_);
  }
  const std::uint64_t before = strong_->work();
  result_.complete = strong_->run(std::numeric_limits<std::uint64_t>::max(), cancel_) == BeamWalk::End::done;
  if (!result_.complete) return true;
  const BeamGeneration first(tracer_.part_, strong_->deferred());
  first_survivors_ = std::max(1.0, first.survivor_count(kSurvivorPowerRatio * threshold_));
  std::vector<std::optional<Replicate>> replicates(kReplicates);
  for_each_in_parallel(kReplicates, [&](std::size_t k) {
    replicates[k] = replicate(static_cast<std::uint32_t>(k), first);
    return replicates[k].has_value();
  });
  std::vector<Tally> beams;
  std::vector<Tally> rays;
  std::vector<Tally> both;
  beam_work_ = strong_->work() - before;
  ray_work_ = 0;
  for (const auto& one : replicates) {
    result_.complete = result_.complete && one.has_value();
    if (!result_.complete) return true;
    beams.push_back(one->beams);
    rays.push_back(one->rays);
    both.push_back(strong_->tally());
    both.back().add(one->beams);
    both.back().add(one->rays);
    beam_work_ += one->beam_work;
    ray_work_ += kLooksPerSegment * one->rays.segments;
    resampled_beams_ += one->beam_count;
  }
  work_ += beam_work_ + ray_work_;
  result_ = result_of(both, 1, cones_deg_);
  result_.rays = 0;
  const double unseen_beam =
      first.is_significant() ? std::min(kSurvivorPowerRatio * threshold_, first.power()) / kReplicates : 0.0;
  const double unseen = std::max(unseen_beam, std::min(ray_power_, rays[0].ledger(0).total()) / kReplicates);
  const double widened = student_factor(kReplicates);
  beam_error_ = std::max(unseen_beam, widened * largest_error(result_of(beams, 1, cones_deg_)));
  ray_error_ = widened * largest_error(result_of(rays, 1, cones_deg_));
  for (ConeResult& cone : result_.cones) cone.std_error = std::max(widened * cone.std_error, unseen);
  result_.reached_target = largest_error(result_) <= sampling_.target_error;
  ++round_;
  return result_.reached_target || threshold_ <= kLastThreshold || ray_power_ <= kLastRayPower ||
         strong_->deferred().size() > kMaxDeferred;
}

std::uint64_t StochasticBeams::beams() const {
  return strong_->beams() + resampled_beams_;
}

double StochasticBeams::next_threshold() const {
  const double target = (scattered_ != nullptr ? kFractionOfTarget : 1.0) * sampling_.target_error;
  if (scattered_ != nullptr && beam_error_ <= target) return threshold_;
  // Assumed exponent: the standard error is proportional to threshold^convergence.
  constexpr double convergence = 0.9;
  // Lower limit of the factor by which the threshold decreases.
  constexpr double steepest_fall = 0.003;
  const double fall = kMargin * std::pow(target / beam_error_, 1.0 / convergence);
  return std::max(kLastThreshold, threshold_ * std::clamp(fall, steepest_fall, kGentlestFall));
}

double StochasticBeams::next_ray_power() const {
  const double target = kFractionOfTarget * sampling_.target_error;
  if (ray_error_ <= target) return ray_power_;
  return std::max(kLastRayPower, ray_power_ * std::min(kGentlestFall, kMargin * std::pow(target / ray_error_, 2.0)));
}

double StochasticBeams::expected_work() const {
  if (result_.reached_target) return work();
  const double next = next_threshold();
  // Kept beams that are also weaker than the next threshold are resampled again. The number of their survivors is
  // inversely proportional to the threshold, but not greater than the number of these beams over all elements. In an
  // array with many elements, all beams may be weaker than the next threshold.
  double still_weak = 0.0;
  double weak_beams = 0.0;
  for (const Beam& beam : strong_->deferred()) {
    if (strong_->power_for_cutoff(beam) >= next) continue;
    still_weak += beam.total_power();
    weak_beams += tracer_.part_.period_mm ? 1.0 : beam.instance_count();
  }
  const double survivors = std::min(still_weak / (kSurvivorPowerRatio * next), weak_beams);
  // Assumed exponent: the work of a round is proportional to threshold^-work_slope.
  constexpr double work_slope = 0.5;
  const double more = std::max(std::pow(threshold_ / next, work_slope), survivors / first_survivors_);
  // Assumed exponent: the number of kept beams is proportional to threshold^-deferred_slope. It grows more slowly than
  // the work, because equal elements share beams. If it exceeds the maximum anyway, the rounds end.
  constexpr double deferred_slope = 0.25;
  const double deferred = static_cast<double>(strong_->deferred().size()) * std::pow(threshold_ / next, deferred_slope);
  if (deferred > static_cast<double>(kMaxDeferred)) return std::numeric_limits<double>::infinity();
  return work() + static_cast<double>(beam_work_) * more +
         static_cast<double>(ray_work_) * ray_power_ / next_ray_power();
}

/// Traces one replicate. Returns nothing if it was cancelled.
std::optional<StochasticBeams::Replicate> StochasticBeams::replicate(std::uint32_t number,
                                                                     const BeamGeneration& first) const {
  BeamScene scene = tracer_.scene(setup_, policy_);
  scene.symmetry = nullptr;
  BeamWalk walk(scene, BeamObserver{});
  std::vector<ScatterSite> sites;
  std::unique_ptr<ScatteredReplicate> rays;
  if (scattered_ != nullptr) {
    rays = scattered_->replicate(RandomKey{sampling_.seed, kScatterStream}, number, round_, cancel_);
    walk.collect_scatter_sites(sites);
    rays->launch(strong_sites_, ray_power_);
  }
  const auto launch = [&] {
    if (rays) rays->launch(sites, ray_power_);
    sites.clear();
  };
  const Resampling how{kSurvivorPowerRatio * threshold_, sampling_.seed, number, round_};
  if (!follow_survivors(walk, tracer_.part_, first, how, cancel_, launch)) return std::nullopt;
  return Replicate{walk.tally(), rays ? rays->tally() : Tally(setup_.cone_chord2.size()), walk.work(), walk.beams()};
}

}  // namespace retrace::raytrace
