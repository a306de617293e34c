#pragma once

// Chooses between the two beam methods for RRE: exact beams, and stochastic beams that resample weak beams. The method
// with the smaller expected remaining time continues.

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "core/progress.h"
#include "raytrace/exact/beam_tracer.h"
#include "raytrace/exact/stochastic_beams.h"

namespace retrace::raytrace {

/// Returns the mean number of facets of a part's cells.
double facets_of_cell(const geometry::Part& part);

/// Returns the expected time, in ns, for constructing the BeamTracer of a part. The time is infinite if the search
/// structures of the tracer exceed the memory budget.
double beam_tracer_ns(const geometry::Part& part);

/// Tracing of one direction at one wavelength by the faster of two methods. It ends when exact beams have reached their
/// goal, or stochastic beams the target error. A method continues where it stopped if the other method turns out to be
/// slower than expected. Decisions depend on counts of work and not on clocks, so that they are the same on every
/// machine. Only one thread at a time may use an object.
class BeamRace {
 public:
  struct Options {
    bool may_resample = true;
    /// Receives the beams that are traced exactly while weak beams are resampled.
    BeamObserver observer = {};
  };

  /// \param scattered see StochasticBeams; if it is given, beams are always resampled
  /// \pre `tracer`, `scattered` and `cancel` exist as long as this object
  BeamRace(const BeamTracer& tracer, const ScatteredLight* scattered, const Optics& optics,
           const Illumination& illumination, const std::vector<double>& cones_deg, const BeamPolicy& policy,
           const Sampling& sampling, Options options, const Cancellation* cancel);

  /// Returns the total time that the faster method is expected to take. Infinite if both methods are abandoned.
  double expected_ns() const;
  /// Returns the finished fraction of the work that the faster method is expected to need. 0 before the work begins.
  double share_done() const;
  /// Runs one step of the method with the smaller expected remaining time: exact or stochastic beam tracing. A method
  /// that exceeds a budget is abandoned.
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
  std::optional<BeamTrace> beams_;  ///< none if facets scatter
  /// Creates the stochastic beams when they are needed for the first time.
  std::function<std::unique_ptr<StochasticBeams>()> make_stochastic_;
  std::unique_ptr<StochasticBeams> stochastic_;
  double first_looks_ = 0.0;
  bool may_resample_ = true;
  bool is_exact_ = false;
};

}  // namespace retrace::raytrace
