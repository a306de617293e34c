#pragma once

// The two ways in which beams tell RRE - all of them, or weak ones resampled - side by side: the quicker one goes on.

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "core/progress.h"
#include "raytrace/exact/beam_tracer.h"
#include "raytrace/exact/stochastic_beams.h"

namespace retrace::studies {

/// Of a part's cells, in the mean.
double facets_of_cell(const geometry::Part& part);

/// Returns the expected time, in ns, for constructing the BeamTracer of a part. The time is infinite if the search
/// structures of the tracer exceed the memory budget.
double beam_tracer_ns(const geometry::Part& part);

/// One direction at one wavelength, traced until the exact engine's goal or the stochastic one's target error is
/// reached. Each way goes on where it was left when the other turns out to be slower than expected. Choices rest on
/// counts of work and not on clocks, so that they are the same on every machine. For one thread.
class BeamRace {
 public:
  struct Options {
    bool may_resample = true;
    /// Told of the beams that are followed exactly while others are resampled.
    raytrace::BeamObserver observer = {};
  };

  /// \param scattered as that of StochasticBeams; with it, beams are resampled in any case
  /// \pre `tracer`, `scattered` and `cancel` outlive this
  BeamRace(const raytrace::BeamTracer& tracer, const raytrace::ScatteredLight* scattered,
           const raytrace::Optics& optics, const raytrace::Illumination& illumination,
           const std::vector<double>& cones_deg, const raytrace::BeamPolicy& policy, const raytrace::Sampling& sampling,
           Options options, const Cancellation* cancel);

  /// What the quicker way is expected to take in all; infinite if neither may do.
  double expected_ns() const;
  /// Returns the finished fraction of the work that the faster method is expected to need. 0 before the work begins.
  double share_done() const;
  /// Runs one step of the method with the smaller expected remaining time: exact or stochastic beam tracing. A method
  /// that exceeds a budget is abandoned.
  /// \return true if the method has reached its goal
  /// \throw BudgetError if both methods are abandoned
  bool advance();

  /// Which way did. \pre advance() was true
  bool is_exact() const { return is_exact_; }
  raytrace::BeamResult exact() const { return beams_->result(); }
  const raytrace::StochasticBeams& stochastic() const { return *stochastic_; }

 private:
  double beams_ns() const;
  double stochastic_ns() const;
  bool advance_exact();
  bool advance_stochastic();

  const Cancellation* cancel_;
  std::optional<raytrace::BeamTrace> beams_;  ///< none: facets scatter
  /// Made when it is first needed.
  std::function<std::unique_ptr<raytrace::StochasticBeams>()> make_stochastic_;
  std::unique_ptr<raytrace::StochasticBeams> stochastic_;
  double first_looks_ = 0.0;
  bool may_resample_ = true;
  bool is_exact_ = false;
};

}  // namespace retrace::studies
