#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/progress.h"
#include "studies/quantity/study.h"
#include "studies/store/store.h"
#include "studies/sweep/sampling.h"

namespace retrace::studies {

/// How the values of several parameters make points.
enum class Combine {
  grid,    ///< every value with every other; the last parameter varies fastest
  zipped,  ///< the first values of all, the second of all, ...
  sobol,
  latin_hypercube
};

/// A study whose points are known before any is computed.
class Sweep {
 public:
  /// \param samples of `sobol` and `latin_hypercube`
  /// \throw InputError if the parameters cannot be combined so, or make more than most_points
  Sweep(Study study, Combine combine, std::uint64_t samples);

  static constexpr std::uint64_t most_points = 10'000'000;

  const Study& study() const { return study_; }
  std::uint64_t size() const { return size_; }
  /// \pre point < size()
  PointValues values(std::uint64_t point) const;
  StoreLayout layout() const;

 private:
  PointValues sampled(std::uint64_t point) const;

  Study study_;
  Combine combine_;
  std::uint64_t size_ = 0;
  std::optional<UnitSamples> samples_;
};

/// Computes one point of a study; what is wrong with it is recorded, not thrown. Nothing if it was cancelled.
std::optional<StoredPoint> compute_point(const Study& study, std::uint64_t number, const PointValues& values,
                                         const Cancellation* cancel);

/// Told how far a sweep has come. Calls come from one thread at a time.
class SweepObserver {
 public:
  virtual ~SweepObserver() = default;
  virtual void at(std::uint64_t done, std::uint64_t total, std::uint64_t failed) = 0;
};

/// Counts finished points and tells an observer, which may be null. Safe to call from several threads.
class SweepCount {
 public:
  SweepCount(const Sweep& sweep, const ResultStore& store, SweepObserver* observer);
  ~SweepCount();
  void finished(bool failed);

 private:
  struct State;
  std::unique_ptr<State> state_;
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
