#pragma once

// Quantities of a study at every point of a grid or a sample, on one machine or many. The study behind `retrace sweep`.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/progress.h"
#include "core/task_progress.h"
#include "studies/quantity/study.h"
#include "studies/store/store.h"
#include "studies/sweep/sampling.h"

namespace retrace::studies {

/// How the values of several parameters make points.
enum class Combine {
  grid,    ///< every value with every other; the last parameter varies fastest
  zipped,  ///< the first values of all, the second of all, ...
  sobol,
  latin_hypercube,
  monte_carlo  ///< each point drawn by itself
};

/// Which values the points of a study have, each told by its number alone.
class PointPlan {
 public:
  virtual ~PointPlan() = default;
  virtual std::uint64_t size() const = 0;
  /// \pre point < size()
  virtual PointValues values(std::uint64_t point) const = 0;
};

/// Values of parameters at shares 0..1 of their distributions, intervals or lists. \pre one share for each
PointValues values_at(const Study& study, const std::vector<double>& shares);

/// A study whose points are known before any is computed.
class Sweep {
 public:
  /// \param samples of `sobol`, `latin_hypercube` and `monte_carlo`
  /// \throw InputError if the parameters cannot be combined so, or make more than most_points
  Sweep(Study study, Combine combine, std::uint64_t samples);
  /// Points of another making. \param kind of the store, such as "retrace.tolerance/1" \param plan for this study
  Sweep(Study study, std::string kind, std::shared_ptr<const PointPlan> plan);

  static constexpr std::uint64_t most_points = 10'000'000;

  const Study& study() const { return study_; }
  std::uint64_t size() const { return size_; }
  /// \pre point < size()
  PointValues values(std::uint64_t point) const;
  StoreLayout layout() const;

 private:
  Study study_;
  std::string kind_ = "retrace.sweep/1";
  std::shared_ptr<const PointPlan> plan_;  ///< null: as `combine_` says
  Combine combine_ = Combine::grid;
  std::uint64_t size_ = 0;
  std::optional<UnitSamples> samples_;
};

/// Computes one point of a study. An error is not thrown but recorded in the point. Returns nothing if the computation
/// was cancelled.
/// \param ran_out receives true if the point failed because the budget of memory or beams was exhausted; may be null
/// \param progress receives the finished fraction of the point; may be null
/// \throw std::bad_alloc: a later attempt with more free memory may succeed
std::optional<StoredPoint> compute_point(const Study& study, std::uint64_t number, const PointValues& values,
                                         const Cancellation* cancel, bool* ran_out = nullptr,
                                         Progress* progress = nullptr);

/// Told how far a sweep has come. Calls come from one thread at a time.
class SweepObserver {
 public:
  virtual ~SweepObserver() = default;
  virtual void at(std::uint64_t done, std::uint64_t total, std::uint64_t failed) = 0;
  /// Reports the finished fraction of all points. It is called while points are being computed, in addition to at().
  /// \param share finished fraction; an unfinished point counts with its own progress
  virtual void at_share(double share) { static_cast<void>(share); }
};

/// Counts finished points and tells an observer, which may be null. Safe to call from several threads.
class SweepCount {
 public:
  SweepCount(const Sweep& sweep, const ResultStore& store, SweepObserver* observer);
  ~SweepCount();
  void finished(bool failed);
  /// Returns the total progress of the unfinished points. It is passed on to SweepObserver::at_share().
  TaskProgress& points();

 private:
  struct State;
  struct Share;
  std::unique_ptr<State> state_;
  std::unique_ptr<Share> share_;
  std::optional<TaskProgress> points_;
};

/// Numbers of the points of a sweep that are not in the store, ascending.
std::vector<std::uint64_t> unfinished(const Sweep& sweep, const ResultStore& store);

/// Computes what the store lacks, several points at a time, together with other processes that do the same; what those
/// have taken is waited for. \return whether all points are finished: false if it was cancelled
/// \throw OutputError if the store cannot be written
bool run_sweep(const Sweep& sweep, ResultStore& store, SweepObserver* observer, const Cancellation* cancel);

/// A sweep and what is known of it.
struct SweepResult {
  const Sweep& sweep;
  std::vector<StoredPoint> points;  ///< ascending
  double elapsed_s = 0.0;
  bool complete = true;
  std::vector<std::string> warnings;
};

/// The finished points with what is to be said about them.
SweepResult collect(const Sweep& sweep, const ResultStore& store, bool complete);

}  // namespace retrace::studies
