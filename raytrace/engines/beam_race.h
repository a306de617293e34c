#pragma once

// Chooses between the two beam methods for computing the RRE: exact beams, and stochastic beams, for which weak beams
// are resampled at random. The method with the smaller expected time continues.

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "core/progress.h"
#include "raytrace/exact/beam_tracer.h"
#include "raytrace/exact/stochastic_beams.h"

namespace retrace::raytrace {

/// Returns the mean number of facets per cell of a part.
double facets_of_cell(const geometry::Part& part);

/// Returns the expected time, in ns, for constructing the BeamTracer of a part. The time is infinite if the search
/// structures of the tracer exceed the memory budget.
double beam_tracer_ns(const geometry::Part& part);

/// A trace of one direction of incidence at one wavelength by the faster of two methods. The trace ends when the exact
/// beams have reached their goal, or when the stochastic beams have reached the target error. If a method turns out to
/// be slower than expected, the trace switches to the other method, which continues where it stopped. The decisions
/// depend on counted work and not on clocks. They are therefore the same on every machine. Only one thread at a time
/// may use an object.
class BeamRace {
 public:
  struct Options {
    bool may_resample = true;  ///< true if the stochastic method may be used
    /// Receives the returned beams above the threshold of the stochastic method, see StochasticBeams. The exact method
    /// does not report its beams.
    BeamObserver observer = {};
  };

  /// \param scattered see StochasticBeams; if it is not null, only the stochastic method is used
  /// \pre `tracer`, `scattered` and `cancel` outlive this object
  BeamRace(const BeamTracer& tracer, const ScatteredLight* scattered, const Optics& optics,
           const Illumination& illumination, const std::vector<double>& cones_deg, const BeamPolicy& policy,
           const Sampling& sampling, Options options, const Cancellation* cancel);

  /// Returns the expected total time of the faster method in ns. The time is infinite if both methods are abandoned.
  double expected_ns() const;
  /// Returns the finished fraction of the expected work of the faster method. It is 0 before the work begins.
  double fraction_done() const;
  /// Runs one step of the method with the smaller expected time: exact or stochastic beam tracing. A method that
  /// exceeds a budget is abandoned.
  /// \return true if the method has reached its goal
  /// \throw BudgetError if both methods are abandoned
  bool advance();

  /// Returns true if the exact method has reached the goal, and false if the stochastic method has reached it.
  /// \pre advance() has returned true
  bool is_exact() const { return is_exact_; }
  BeamResult exact() const { return beams_->result(); }
  const StochasticBeams& stochastic() const { return *stochastic_; }

 private:
  double beams_ns() const;
  double stochastic_ns() const;
  bool advance_exact();
  bool advance_stochastic();

  const Cancellation* cancel_;
  std::optional<BeamTrace> beams_;  ///< not set if facets scatter, or if exact beams are abandoned
  /// Creates the stochastic beams when they are needed for the first time.
  std::function<std::unique_ptr<StochasticBeams>()> make_stochastic_;
  std::unique_ptr<StochasticBeams> stochastic_;
  double initial_work_ = 0.0;
  bool may_resample_ = true;
  bool is_exact_ = false;
};

}  // namespace retrace::raytrace
