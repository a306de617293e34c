#pragma once

// Computes the quantities of a study at every point of a grid or a sample, on one or several machines. `retrace sweep`
// runs this study.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "compute/sampling/unit_samples.h"
#include "compute/store/store.h"
#include "core/progress.h"
#include "core/task_progress.h"
#include "core/warning.h"
#include "studies/quantity/study.h"

namespace retrace::studies {

/// Method by which the values of several parameters are combined into points.
enum class Combine {
  grid,    ///< all combinations of values; the last parameter varies fastest
  zipped,  ///< first values of all parameters together, then second values, and so on
  sobol,
  latin_hypercube,
  monte_carlo  ///< independent random points
};

/// List of the points of a study. The number of a point determines its values.
class PointPlan {
 public:
  virtual ~PointPlan() = default;
  virtual std::uint64_t size() const = 0;
  /// \pre point < size()
  virtual PointValues values(std::uint64_t point) const = 0;
};

/// Returns the values of the parameters at given fractions (0..1) of their distributions, intervals or lists.
/// \pre there is one fraction for each parameter
PointValues values_at(const Study& study, const std::vector<double>& fractions);

/// Study whose points are all known before the first point is computed.
class Sweep {
 public:
  /// \param samples number of points for `sobol`, `latin_hypercube` and `monte_carlo`
  /// \throw InputError if the parameters cannot be combined in this manner, or if there are more than max_points
  /// points
  Sweep(Study study, Combine combine, std::uint64_t samples);
  /// Creates a sweep whose points are those of a plan.
  /// \param kind kind of the store, such as "retrace.tolerance/1"
  /// \param plan plan of points for this study
  Sweep(Study study, std::string kind, std::shared_ptr<const PointPlan> plan);

  static constexpr std::uint64_t max_points = 10'000'000;

  const Study& study() const { return study_; }
  std::uint64_t size() const { return size_; }
  /// \pre point < size()
  PointValues values(std::uint64_t point) const;
  compute::StoreLayout layout() const;

 private:
  Study study_;
  std::string kind_ = "retrace.sweep/1";
  std::shared_ptr<const PointPlan> plan_;  ///< null: the parameters are combined by `combine_`
  Combine combine_ = Combine::grid;
  std::uint64_t size_ = 0;
  std::optional<compute::UnitSamples> samples_;
};

/// Returns the inputs of a point for the store: the values of the parameters and, if Study::level is set, the members
/// of ErrorLevel.
std::vector<compute::StoredValue> stored_inputs(const Study& study, const PointValues& values);

/// Computes one point of a study. An error is not thrown but recorded in the point. Returns nothing if the computation
/// was cancelled.
/// \param ran_out receives true if the point failed because the budget of memory or beams was exhausted; may be null
/// \param progress receives the finished fraction of the point; may be null
/// \throw std::bad_alloc if memory is exhausted; a later attempt with more free memory may succeed
std::optional<compute::StoredPoint> compute_point(const Study& study, std::uint64_t number, const PointValues& values,
                                                  const Cancellation* cancel, bool* ran_out = nullptr,
                                                  Progress* progress = nullptr);

/// Receives the progress of a sweep. Only one thread at a time calls its functions.
class SweepObserver {
 public:
  virtual ~SweepObserver() = default;
  virtual void at(std::uint64_t done, std::uint64_t total, std::uint64_t failed) = 0;
  /// Reports the finished fraction of all points. It is called while points are being computed, in addition to at().
  /// \param fraction finished fraction; an unfinished point counts with its own progress
  virtual void at_fraction(double fraction) { static_cast<void>(fraction); }
};

/// Counts finished points and reports them to an observer, which may be null. Several threads may use one object at the
/// same time.
class SweepCount {
 public:
  SweepCount(const Sweep& sweep, const compute::ResultStore& store, SweepObserver* observer);
  ~SweepCount();
  void finished(bool failed);
  /// Returns the object that receives the progress of the unfinished points. The progress is passed on to
  /// SweepObserver::at_fraction().
  TaskProgress& points();

 private:
  struct State;
  struct Share;
  std::unique_ptr<State> state_;
  std::unique_ptr<Share> share_;
  std::optional<TaskProgress> points_;
};

/// Returns the numbers of the points of a sweep that are not in the store, in ascending order.
std::vector<std::uint64_t> unfinished(const Sweep& sweep, const compute::ResultStore& store);

/// Computes the points that are not in the store, several at a time. Other processes may compute points of the same
/// sweep; the function waits for the points that they have claimed.
/// \return true if all points are finished, false if the computation was cancelled
/// \throw OutputError if the store cannot be written
bool run_sweep(const Sweep& sweep, compute::ResultStore& store, SweepObserver* observer, const Cancellation* cancel);

/// Sweep with its finished points.
struct SweepResult {
  const Sweep& sweep;
  std::vector<compute::StoredPoint> points;  ///< in ascending order of their numbers
  double elapsed_s = 0.0;
  bool complete = true;
  Warnings warnings;
};

/// Returns the finished points of a store, with warnings about failed points and points of other versions of the
/// program.
SweepResult collect(const Sweep& sweep, const compute::ResultStore& store, bool complete);

}  // namespace retrace::studies
