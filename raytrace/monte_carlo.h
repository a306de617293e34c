#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/progress.h"
#include "geometry/part.h"
#include "raytrace/ledger.h"
#include "raytrace/optics.h"
#include "raytrace/path_tracer.h"

namespace retrace::raytrace {

/// How long a Monte-Carlo run goes on.
struct Sampling {
  std::uint32_t seed = 1;
  std::optional<std::uint64_t> rays;  ///< traced exactly (rounded up to whole replicates); else until the target
  double target_error = 1e-4;         ///< standard error of RRE to reach, > 0
  std::uint64_t max_rays = 1U << 26;  ///< limit on the way there
};

/// RRE and ledger for one acceptance cone.
struct ConeResult {
  double half_angle_deg = 0.0;
  double rre = 0.0;
  double std_error = 0.0;  ///< from the spread of independent replicates
  Stokes stokes;           ///< of what is retroreflected, along source_axis()
  Ledger ledger;
};

struct MonteCarloResult {
  std::vector<ConeResult> cones;  ///< in the order given
  std::uint64_t rays = 0;
  std::uint64_t segments = 0;
  std::uint64_t misses = 0;
  bool reached_target = true;
  bool complete = true;  ///< false if it was cancelled: the figures are then of what was traced, none if rays is 0
};

/// Monte-Carlo estimates of where light goes, by Owen-scrambled Sobol points over the entrance face. The result depends
/// on the seed and the question alone, not on the number of threads.
class MonteCarlo {
 public:
  /// Independent scrambles: the estimate is their mean, its standard error comes from their spread.
  static constexpr std::uint32_t kReplicates = 32;

  explicit MonteCarlo(const geometry::Part& part);
  ~MonteCarlo();

  /// Traces in the calling thread's TBB arena.
  /// \throw BudgetError if power is lost: a ray missed every face from inside
  MonteCarloResult trace(const Optics& optics, const Illumination& illumination, const std::vector<double>& cones_deg,
                         const Sampling& sampling, const PathPolicy& policy,
                         const Cancellation* cancel = nullptr) const;

 private:
  struct Scene;

  /// Adds rays from..until-1 of every replicate to its tally. False if cancelled: the tallies are then of no use.
  bool trace_range(const PathSetup& setup, std::uint32_t seed, std::uint32_t from, std::uint32_t until,
                   std::vector<Tally>& replicates, const Cancellation* cancel) const;

  std::unique_ptr<Scene> scene_;
};

}  // namespace retrace::raytrace
