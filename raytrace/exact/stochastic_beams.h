#pragma once

// The engine of stochastic beams: beams above a threshold are followed exactly, those below it are resampled,
// generation by generation, in independent replicates.

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/progress.h"
#include "raytrace/exact/beam_tracer.h"
#include "raytrace/exact/scattered_light.h"
#include "raytrace/paths/monte_carlo.h"

namespace retrace::raytrace {

class BeamGeneration;

/// One direction of a BeamTracer, traced round by round at falling thresholds until the standard error of RRE is below
/// a target.
///
/// Beams with more power than the threshold w are followed as BeamTrace does. Each generation of weaker beams, of total
/// power P, is resampled: n = ceil(P / (kThinning w)) beams survive with the power P / n each. Systematic resampling
/// selects them, which is unbiased and preserves the power (BeamGeneration). The standard error is estimated from
/// independent replicates. It is at least the power of one survivor, or of one ray of scattered light, divided by the
/// number of replicates. This term allows for light that no replicate has traced (docs/theory/beams.md).
///
/// At rough facets beams keep their specular light, and what is scattered goes on by itself, in each replicate of its
/// own (ScatteredLight).
///
/// For one thread at a time; replicates are shared out among threads, and results do not depend on their number.
class StochasticBeams {
 public:
  static constexpr std::uint32_t kReplicates = 16;
  /// Survivors are stronger than the weakest beams that are followed exactly, by this factor: those are followed once
  /// and survivors in every replicate.
  static constexpr double kThinning = 32.0;

  /// Whether facets leave enough light specular for beams: smooth ones, and those of `harvey_shack` without waviness.
  static bool serves(const Optics& optics);

  /// \param sampling its seed and target error \param scattered of the same part in the same light; null: facets are
  /// smooth \param observer told of the returned beams that are followed exactly, each once
  /// \pre serves(optics); `tracer`, `scattered` and `cancel` outlive this
  StochasticBeams(const BeamTracer& tracer, const ScatteredLight* scattered, const Optics& optics,
                  const Illumination& illumination, const std::vector<double>& cones_deg, const Sampling& sampling,
                  const Cancellation* cancel = nullptr, BeamObserver observer = {});
  ~StochasticBeams();

  /// Traces one more round at a lower threshold. If the round exceeds the memory budget, the result of the preceding
  /// round is kept.
  /// \return true if no further round is needed or possible, or if tracing was cancelled
  /// \throw BudgetError if the first round exceeds the memory budget
  bool advance();
  /// Of the last round, without rays. 1.96 standard errors hold the truth in 95 of 100 cases.
  const MonteCarloResult& result() const { return result_; }
  std::uint64_t beams() const;  ///< followed so far
  /// In looks at a facet's bounding box, as BeamTrace: done so far, and expected until the target error is reached.
  double work() const { return static_cast<double>(work_); }
  double expected_work() const;
  double threshold() const { return threshold_; }

 private:
  struct Replicate;

  std::optional<Replicate> replicate(std::uint32_t number, const BeamGeneration& first) const;
  bool follow_round();
  double next_threshold() const;
  double next_ray_power() const;

  const BeamTracer& tracer_;
  const LightSetup setup_;
  const ScatteredLight* scattered_;
  const BeamPolicy policy_;
  std::vector<double> cones_deg_;
  Sampling sampling_;
  const Cancellation* cancel_;
  std::unique_ptr<BeamWalk> strong_;  ///< above the threshold
  std::vector<ScatterSite> strong_sites_;
  double threshold_;
  double ray_power_;                           ///< most that a piece of scattered light stands for
  double beam_error_ = 0.0, ray_error_ = 0.0;  ///< of the last round: the largest of all cones
  std::uint32_t round_ = 0;
  std::uint64_t work_ = 0;
  std::uint64_t beam_work_ = 0, ray_work_ = 0;  ///< of the last round alone
  std::uint64_t weak_beams_ = 0;
  double first_survivors_ = 1.0;  ///< of a replicate's first generation in the last round
  MonteCarloResult result_;
};

}  // namespace retrace::raytrace
