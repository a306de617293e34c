#pragma once

// Rounds and replicates of Monte-Carlo runs: how many rays are traced, and the standard error from their spread.

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "raytrace/paths/monte_carlo.h"

namespace retrace::raytrace {

/// How Monte-Carlo tracers share out rays: MonteCarlo::kReplicates independent scrambles of the same points, whose mean
/// is the estimate and whose spread its error.

/// Philox streams: of the scrambles of entry points, and of choices on the way.
inline constexpr std::uint32_t kScrambleStream = 1;
inline constexpr std::uint32_t kChoiceStream = 2;

/// Of the scrambles of a replicate's entry points.
std::array<std::uint64_t, 2> scramble_keys(std::uint32_t seed, std::uint32_t replicate);

/// Traces rays first..last-1 of a replicate; nothing if it was cancelled.
using ReplicateTask =
    std::function<std::optional<Tally>(std::uint32_t replicate, std::uint32_t first, std::uint32_t last)>;

/// Traces the rays from..until-1 of every replicate and adds their results to the tallies, with all available threads.
/// The sums do not depend on the number of threads. The tallies of all tasks are kept until the end, so that callers
/// should request few rays at a time.
/// \return false if cancelled; the tallies are then invalid
bool trace_replicates(std::uint32_t from, std::uint32_t until, std::vector<Tally>& replicates,
                      const ReplicateTask& trace);

/// Adds rays from..until-1 of every replicate. False if cancelled.
using TraceRange = std::function<bool(std::uint32_t from, std::uint32_t until, std::vector<Tally>& replicates)>;

/// Doubles the rays round by round until the target error is reached, or as many are traced as are requested.
class Rounds {
 public:
  /// \param progress receives the traced fraction of the rays. Without Sampling::rays, the number of rays is unknown
  ///        and an estimate is reported. Null: nothing is reported
  Rounds(const Sampling& sampling, std::vector<double> cones_deg, std::size_t score_size, TraceRange trace_range,
         Progress* progress = nullptr);

  /// One more round. \return whether that was the last one that is needed; if it was cancelled, it is the last as well
  /// \throw BudgetError if power is lost: a ray missed every face from inside
  bool advance();
  /// Of the rounds so far.
  const MonteCarloResult& result() const { return result_; }
  /// Straight pieces traced in all until the target error is reached, judged by the rounds so far. \pre there was one
  double expected_segments() const;

 private:
  std::uint32_t next_end() const;
  /// \param rays number of traced rays of each replicate
  void report(std::uint32_t rays);

  Sampling sampling_;
  std::vector<double> cones_deg_;
  TraceRange trace_range_;
  Progress* progress_;
  double reported_ = 0.0;
  std::uint32_t goal_;
  std::uint32_t done_ = 0;  ///< rays of a replicate
  std::vector<Tally> replicates_;
  MonteCarloResult result_;
};

}  // namespace retrace::raytrace
