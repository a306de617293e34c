#pragma once

// The Monte-Carlo engine: RRE and ledger of a part with standard errors, by Embree or, for arrays, cell by cell.

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "core/progress.h"
#include "geometry/entrance/entrance_surface.h"
#include "geometry/part/part.h"
#include "raytrace/light/light_setup.h"
#include "raytrace/light/optics.h"
#include "raytrace/light/path_policy.h"
#include "raytrace/sampling/replicate_means.h"

namespace retrace::raytrace {

struct PathSetup;

/// How long a Monte-Carlo run goes on.
struct Sampling {
  /// Of entry points and branches: Sobol points with splitting, or pseudo-random ones of which each takes one branch at
  /// every interface - the slow way, to measure what the other is worth. The latter with Engine::embree only.
  enum class Kind { stratified, plain };
  Kind kind = Kind::stratified;
  std::uint32_t seed = 1;
  std::optional<std::uint64_t> rays;  ///< traced exactly (rounded up to whole replicates); else until the target
  double target_error = 1e-4;         ///< standard error of RRE to reach, > 0
  std::uint64_t max_rays = 1U << 26;  ///< limit on the way there
};

/// Monte-Carlo estimates of where light goes, by Owen-scrambled Sobol points over the entrance face. The result depends
/// on the seed and the question alone, not on the number of threads.
class MonteCarlo {
 public:
  /// How rays find what they meet.
  enum class Engine {
    embree,  ///< one by one, in a bounding volume hierarchy: any part
    cell     ///< all rays of like history together, column by column: where cell_serves()
  };
  /// Infinite parts; and finite arrays of equal elements that have an inner piece, whose borders are left to Embree.
  static bool cell_serves(const geometry::Part& part);

  /// Independent scrambles: the estimate is their mean, its standard error comes from their spread.
  static constexpr std::uint32_t kReplicates = 32;

  /// \param part is kept by reference: it must outlive the tracer
  /// \param entrance_face in place of the plane entrance face, above the part's back; null: that plane
  /// \pre with an entrance surface: a finite part and Engine::embree
  explicit MonteCarlo(const geometry::Part& part, Engine engine = Engine::embree,
                      const geometry::Entrance* entrance_face = nullptr);
  explicit MonteCarlo(geometry::Part&& part, Engine engine = Engine::embree,
                      const geometry::Entrance* entrance_face = nullptr) = delete;
  ~MonteCarlo();

  /// Traces rays in the TBB arena of the calling thread.
  /// \param score function of the directions in which light leaves the entrance face; null: none
  /// \param progress as in the constructor of Rounds
  /// \pre for Engine::cell: cell_serves()
  /// \throw BudgetError if power is lost because a ray inside the part missed every face
  MonteCarloResult trace(const Optics& optics, const Illumination& illumination, const std::vector<double>& cones_deg,
                         const Sampling& sampling, const PathPolicy& policy, const Cancellation* cancel = nullptr,
                         const DirectionScore* score = nullptr, Progress* progress = nullptr) const;

  /// The same round by round, to be dropped if something else is quicker.
  class Run {
   public:
    /// The parameters are those of trace().
    /// \pre `tracer`, `cancel`, `score` and `progress` outlive the run
    Run(const MonteCarlo& tracer, const Optics& optics, const Illumination& illumination,
        const std::vector<double>& cones_deg, const Sampling& sampling, const PathPolicy& policy,
        const Cancellation* cancel = nullptr, const DirectionScore* score = nullptr, Progress* progress = nullptr);
    ~Run();

    /// As Rounds::advance().
    bool advance();
    const MonteCarloResult& result() const;
    /// As Rounds::expected_segments().
    double expected_segments() const;

   private:
    struct Question;
    std::unique_ptr<Question> question_;
  };

 private:
  struct Scene;
  struct Task;
  using TraceTask = std::function<std::optional<Tally>(const Task&)>;

  TraceTask one_by_one(const PathSetup& setup, const Sampling& sampling, const Cancellation* cancel) const;
  /// \param paths of the rays that leave the inner piece of a finite part; else null
  TraceTask by_cells(const LightSetup& setup, const PathSetup* paths, const PathPolicy& policy, std::uint32_t seed,
                     const Cancellation* cancel) const;
  /// Adds rays from..until-1 of every replicate to its tally. False if cancelled: the tallies are then of no use.
  /// \param trace_task what one task gives, nothing if cancelled
  bool trace_range(const TraceTask& trace_task, std::uint32_t from, std::uint32_t until,
                   std::vector<Tally>& replicates) const;

  std::unique_ptr<Scene> scene_;
};

}  // namespace retrace::raytrace
