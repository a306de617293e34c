#pragma once

// Rounds and replicates of Monte Carlo runs. Rays are traced until the standard error, estimated from the spread of the
// replicates, is small enough.

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "core/progress.h"
#include "raytrace/light/light_setup.h"
#include "raytrace/sampling/replicate_means.h"

namespace retrace::raytrace {

/// Random numbers of a Monte Carlo run and the criteria that end it.
struct Sampling {
  /// Number of independent scrambles of the points. The result of one scramble is a replicate. The estimate is the mean
  /// of all replicates, and its standard error is computed from their spread.
  static constexpr std::uint32_t kReplicates = 32;

  /// Method of choosing entry points and branches. `stratified` uses Sobol points and splits rays at interfaces.
  /// `plain` uses pseudo-random points and one random branch per interface. `plain` is slower, is meant for
  /// comparisons, and requires MonteCarlo::Engine::embree.
  enum class Kind { stratified, plain };
  Kind kind = Kind::stratified;
  std::uint32_t seed = 1;
  std::optional<std::uint64_t> rays;  ///< number of rays, rounded up to a multiple of kReplicates; not set: as needed
  double target_error = 1e-4;         ///< target standard error of the RRE, > 0
  std::uint64_t max_rays = 1U << 26;  ///< maximum number of rays if `rays` is not set
};

/// Numbers of the Philox random streams: for the scrambles of entry points, and for the choices along a path.
inline constexpr std::uint32_t kScrambleStream = 1;
inline constexpr std::uint32_t kChoiceStream = 2;

/// Returns the keys that scramble both coordinates of a replicate's entry points.
std::array<std::uint64_t, 2> scramble_keys(std::uint32_t seed, std::uint32_t replicate);

/// Function that traces the rays with the numbers `first` to `last` - 1 of a replicate. It returns nothing if
/// cancelled.
using ReplicateTask =
    std::function<std::optional<Tally>(std::uint32_t replicate, std::uint32_t first, std::uint32_t last)>;

/// Traces the rays with the numbers `from` to `until` - 1 of every replicate, with all available threads. Adds the
/// results to the tallies. The sums do not depend on the number of threads. The memory is proportional to the number of
/// rays. Callers should therefore request few rays at a time.
/// \return false if cancelled; the tallies are then invalid
bool trace_replicates(std::uint32_t from, std::uint32_t until, std::vector<Tally>& replicates,
                      const ReplicateTask& trace);

/// Function that traces the rays with the numbers `from` to `until` - 1 of every replicate and adds the results to the
/// tallies. It returns false if cancelled.
using TraceRange = std::function<bool(std::uint32_t from, std::uint32_t until, std::vector<Tally>& replicates)>;

/// Doubles the number of rays from round to round, until the target error or the requested number of rays is reached.
class Rounds {
 public:
  /// \param progress receives the finished fraction of the rays; null for none. If Sampling::rays is not set, the
  ///        fraction is estimated.
  Rounds(const Sampling& sampling, std::vector<double> cones_deg, std::size_t score_size, TraceRange trace_range,
         Progress* progress = nullptr);

  /// Traces one more round.
  /// \return true if no further round is needed or if cancelled
  /// \throw BudgetError if power is lost because a ray inside the part missed every face
  bool advance();
  /// Returns the result of the rounds so far.
  const MonteCarloResult& result() const { return result_; }
  /// Returns the expected total number of ray segments until the target error is reached, estimated from the rounds so
  /// far.
  /// \pre advance() has been called at least one time
  double expected_segments() const;

 private:
  std::uint32_t next_end() const;
  /// \param rays number of rays traced so far in each replicate
  void report(std::uint32_t rays);

  Sampling sampling_;
  std::vector<double> cones_deg_;
  TraceRange trace_range_;
  Progress* progress_;
  double reported_ = 0.0;
  std::uint32_t goal_;
  std::uint32_t done_ = 0;  ///< number of rays traced so far in each replicate
  std::vector<Tally> replicates_;
  MonteCarloResult result_;
};

}  // namespace retrace::raytrace
