#pragma once

// The engine of stochastic beams. Beams above a threshold are traced exactly. Weaker beams are resampled, generation by
// generation, in independent replicates.

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/progress.h"
#include "raytrace/exact/beam_tracer.h"
#include "raytrace/exact/scattered_light.h"
#include "raytrace/sampling/replicates.h"

namespace retrace::raytrace {

class BeamGeneration;

/// A trace of one direction of incidence with a BeamTracer. It consists of rounds with decreasing thresholds. The
/// rounds end when the standard error of the RRE (retroreflective efficiency) is below the target.
///
/// Beams with more power than the threshold w are traced exactly, as BeamTrace does. Each generation of weaker beams
/// with the total power P is resampled: n = ceil(P / (kSurvivorPowerRatio w)) beams survive, each with the power P / n.
/// They are selected by systematic resampling, which is unbiased and preserves the total power (BeamGeneration).
///
/// The standard error is estimated from independent replicates. Its minimum is the power of one survivor, or of one ray
/// of scattered light, divided by the number of replicates. This minimum allows for light that no replicate has traced
/// (docs/theory/beams.md).
///
/// At rough facets, beams keep their specular light. The scattered light is traced separately in each replicate
/// (ScatteredLight).
///
/// An object is not thread-safe. It distributes the replicates over threads. The results do not depend on the number of
/// threads.
class StochasticBeams {
 public:
  static constexpr std::uint32_t kReplicates = 16;

  /// \param sampling provides the seed and the target error
  /// \param scattered tracer of the scattered light for the same part and illumination; null if facets are smooth
  /// \param observer is called one time for each returned beam that is traced exactly
  /// \pre the engine `stochastic` can trace the model, see obstacle_for(); `tracer`, `scattered` and `cancel` outlive
  /// this object
  StochasticBeams(const BeamTracer& tracer, const ScatteredLight* scattered, const Optics& optics,
                  const Illumination& illumination, const std::vector<double>& cones_deg, const Sampling& sampling,
                  const Cancellation* cancel = nullptr, BeamObserver observer = {});
  ~StochasticBeams();

  /// Traces one more round at a lower threshold. If a later round than the first exceeds the memory budget, the result
  /// of the preceding round remains valid.
  /// \return true if no further round is needed or possible, or if tracing was cancelled
  /// \throw BudgetError if the first round exceeds the memory budget
  bool advance();
  /// Returns the result of the last round. The number of rays in it is 0. An interval of +-1.96 standard errors has a
  /// confidence of 95 %.
  const MonteCarloResult& result() const { return result_; }
  std::uint64_t beams() const;  ///< number of beams traced so far
  /// Returns the work done so far; expected_work() returns the total until the target error is reached. The unit is
  /// that of BeamTrace::work(), a test of a facet's bounding box.
  double work() const { return static_cast<double>(work_); }
  double expected_work() const;

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
  std::unique_ptr<BeamWalk> strong_;  ///< trace of the beams above the threshold
  std::vector<ScatterSite> strong_sites_;
  double threshold_;
  double ray_power_;                           ///< maximum power of a ray of scattered light
  double beam_error_ = 0.0, ray_error_ = 0.0;  ///< standard errors of the last round, maximum over all cones
  std::uint32_t round_ = 0;
  std::uint64_t work_ = 0;
  std::uint64_t beam_work_ = 0, ray_work_ = 0;  ///< work of the last round only
  std::uint64_t resampled_beams_ = 0;
  double first_survivors_ = 1.0;  ///< number of survivors of a replicate's first generation in the last round
  MonteCarloResult result_;
};

}  // namespace retrace::raytrace
