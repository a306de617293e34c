#include "raytrace/sampling/replicates.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/error.h"
#include "core/random.h"
#include "core/threads.h"
#include "raytrace/light/ledger.h"

namespace retrace::raytrace {
namespace {

constexpr std::uint32_t kReplicates = Sampling::kReplicates;
// Number of rays of a replicate per task. It is small enough for load balancing and large enough to make the overhead
// negligible.
constexpr std::uint32_t kRaysPerTask = 2048;
// Number of rays of a replicate after which the tallies of the tasks are added up. This number limits the memory of the
// tallies.
constexpr std::uint32_t kRaysPerSlice = 64 * kRaysPerTask;
// Maximum number of rays per replicate. It is less than 2^32, the length of the Sobol sequence, so that counters do not
// overflow.
constexpr std::uint32_t kMaxRaysPerReplicate = UINT32_MAX - kRaysPerSlice;
// Number of rays of a replicate in the first round, after which the standard error is first estimated.
constexpr std::uint32_t kFirstRound = 256;
// Assumed exponent: the error is proportional to rays^-kConvergence. The exponent is 0.5 for random points, and 1 for
// Sobol points and smooth functions.
constexpr double kConvergence = 0.75;

void check_lost(const MonteCarloResult& result) {
  for (const ConeResult& cone : result.cones)
    if (cone.ledger[Account::lost] > kLostLimit)
      throw BudgetError(
          fmt::format("{} of {} rays missed every face from inside the part ({} of the power): this is a defect "
                      "of retrace, please report the design",
                      result.misses, result.rays, cone.ledger[Account::lost]));
}

/// Returns the standard error of the RRE (retroreflective efficiency) of one cone. It combines the spread of the
/// replicates with an allowance for paths that no ray has taken, see with_unsampled_paths().
/// \param spread standard deviation of the mean over replicates, see ConeResult::spread
/// \param rays total number of rays in all replicates
double std_error_of(double spread, double rays) {
  return with_unsampled_paths(student_factor(kReplicates) * spread, rays);
}

}  // namespace

/// Returns the keys that scramble both coordinates of a replicate's entry points.
std::array<std::uint64_t, 2> scramble_keys(std::uint32_t seed, std::uint32_t replicate) {
  const auto words = philox({seed, kScrambleStream}, replicate, 0);
  return {(std::uint64_t{words[0]} << 32) | words[1], (std::uint64_t{words[2]} << 32) | words[3]};
}

bool trace_replicates(std::uint32_t from, std::uint32_t until, std::vector<Tally>& replicates,
                      const ReplicateTask& trace) {
  struct Task {
    std::uint32_t replicate, first, last;
  };
  std::vector<Task> tasks;
  for (std::uint32_t replicate = 0; replicate < kReplicates; ++replicate)
    for (std::uint32_t first = from; first < until; first += kRaysPerTask)
      tasks.push_back({replicate, first, std::min(until, first + kRaysPerTask)});
  std::vector<std::optional<Tally>> tallies(tasks.size());
  for_each_in_parallel(tasks.size(),
                       [&](std::size_t k) { tallies[k] = trace(tasks[k].replicate, tasks[k].first, tasks[k].last); });
  if (std::any_of(tallies.begin(), tallies.end(), [](const auto& t) { return !t.has_value(); })) return false;
  // The tallies are added in the order of the tasks, so that the sums do not depend on the threads.
  for (std::size_t k = 0; k < tasks.size(); ++k) replicates[tasks[k].replicate].add(*tallies[k]);
  return true;
}

Rounds::Rounds(const Sampling& sampling, std::vector<double> cones_deg, std::size_t score_size, TraceRange trace_range,
               Progress* progress)
    : sampling_(sampling),
      cones_deg_(std::move(cones_deg)),
      trace_range_(std::move(trace_range)),
      progress_(progress),
      goal_(static_cast<std::uint32_t>(std::min<std::uint64_t>(
          (sampling.rays.value_or(sampling.max_rays) + kReplicates - 1) / kReplicates, kMaxRaysPerReplicate))),
      replicates_(kReplicates, Tally(cones_deg_.size(), score_size)) {}

/// Returns the number of rays per replicate after the next round. The number is doubled in each round, because the
/// points of a Sobol sequence are best distributed if their number is a power of 2.
std::uint32_t Rounds::next_end() const {
  if (done_ == 0) return std::min(goal_, kFirstRound);
  return done_ > goal_ / 2 ? goal_ : 2 * done_;
}

bool Rounds::advance() {
  const std::uint32_t end = next_end();
  for (std::uint32_t first = done_; first < end;) {
    const std::uint32_t last = end - first > kRaysPerSlice ? first + kRaysPerSlice : end;
    if (!trace_range_(first, last, replicates_)) {
      result_.complete = false;  // the results of the preceding rounds are kept
      return true;
    }
    first = last;
    if (sampling_.rays && first < end) report(first);
  }
  done_ = end;
  result_ = result_of(replicates_, done_, cones_deg_);
  check_lost(result_);
  for (ConeResult& cone : result_.cones) cone.std_error = std_error_of(cone.spread, static_cast<double>(result_.rays));
  result_.reached_target = sampling_.rays || largest_error(result_) <= sampling_.target_error;
  report(done_);
  return done_ >= goal_ || (!sampling_.rays && result_.reached_target);
}

void Rounds::report(std::uint32_t rays) {
  if (progress_ == nullptr) return;
  double share = static_cast<double>(rays) / static_cast<double>(goal_);
  if (!sampling_.rays && result_.segments > 0)
    share = std::max(share, static_cast<double>(result_.segments) / expected_segments());
  if (!(share > reported_)) return;
  reported_ = std::min(share, 1.0);
  progress_->at(reported_);
}

double Rounds::expected_segments() const {
  double factor = 1.0;
  if (!sampling_.rays) {
    double spread = 0.0;
    for (const ConeResult& cone : result_.cones) spread = std::max(spread, cone.spread);
    const auto rays = static_cast<double>(result_.rays);
    while (std_error_of(spread * std::pow(factor, -kConvergence), factor * rays) > sampling_.target_error)
      factor *= 2.0;
  }
  return factor * static_cast<double>(result_.segments);
}

}  // namespace retrace::raytrace
