#pragma once

// The Monte Carlo engine. It computes the RRE (retroreflective efficiency) and the ledger (power by destination) of a
// part with standard errors. It traces rays with Embree or, for arrays, cell by cell.

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
#include "raytrace/sampling/replicates.h"

namespace retrace::raytrace {

struct PathSetup;

/// Estimates the RRE and the ledger with light that enters at Owen-scrambled Sobol points of the entrance face. The
/// result depends only on the seed and the parameters, and not on the number of threads.
class MonteCarlo {
 public:
  /// Method of finding the facets that rays meet.
  enum class Engine {
    embree,  ///< rays one by one, with a bounding volume hierarchy; for any part
    cell     ///< many rays in the same cell together, cell by cell; requires cell_supports()
  };
  /// Returns true if Engine::cell can be used: for infinite parts, and for finite arrays of identical elements with an
  /// inner region. Rays near the borders of a finite array are traced with Embree.
  static bool cell_supports(const geometry::Part& part);

  /// \param part must outlive the tracer
  /// \param entrance_face replaces the plane entrance face of the part; null for the plane face
  /// \pre a part with `entrance_face` is finite and uses Engine::embree
  explicit MonteCarlo(const geometry::Part& part, Engine engine = Engine::embree,
                      const geometry::Entrance* entrance_face = nullptr);
  explicit MonteCarlo(geometry::Part&& part, Engine engine = Engine::embree,
                      const geometry::Entrance* entrance_face = nullptr) = delete;
  ~MonteCarlo();

  /// Traces rays with the TBB threads of the calling thread's arena.
  /// \param score function of the directions in which light leaves the entrance face; null for none
  /// \param progress receives the finished fraction of the work, see the constructor of Rounds; null for none
  /// \pre cell_supports() is true if Engine::cell is used
  /// \throw BudgetError if power is lost because a ray inside the part missed every face
  MonteCarloResult trace(const Optics& optics, const Illumination& illumination, const std::vector<double>& cones_deg,
                         const Sampling& sampling, const PathPolicy& policy, const Cancellation* cancel = nullptr,
                         const DirectionScore* score = nullptr, Progress* progress = nullptr) const;

  /// A trace that is executed round by round. It can be abandoned if another method is faster.
  class Run {
   public:
    /// Has the same parameters as trace().
    /// \pre `tracer`, `cancel`, `score` and `progress` outlive the run
    Run(const MonteCarlo& tracer, const Optics& optics, const Illumination& illumination,
        const std::vector<double>& cones_deg, const Sampling& sampling, const PathPolicy& policy,
        const Cancellation* cancel = nullptr, const DirectionScore* score = nullptr, Progress* progress = nullptr);
    ~Run();

    /// Traces one more round, see Rounds::advance().
    bool advance();
    const MonteCarloResult& result() const;
    /// Returns MonteCarloResult::beam_area_ratio.
    double beam_area_ratio() const;
    /// Returns the estimated total work, see Rounds::expected_segments().
    double expected_segments() const;

   private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
  };

 private:
  struct Scene;
  struct Task;
  using TraceTask = std::function<std::optional<Tally>(const Task&)>;

  TraceTask one_by_one(const PathSetup& setup, const Sampling& sampling, const Cancellation* cancel) const;
  /// \param paths data for tracing the rays that leave the inner region of a finite part; null for an infinite part
  TraceTask by_cells(const LightSetup& setup, const PathSetup* paths, const PathPolicy& policy, std::uint32_t seed,
                     const Cancellation* cancel) const;
  /// Traces the rays with the numbers `from` to `until` - 1 of every replicate, and adds the results to the tally of
  /// the replicate.
  /// \param trace_task returns the tally of one task, or nothing if cancelled
  /// \return false if cancelled; the tallies are then invalid
  bool trace_range(const TraceTask& trace_task, std::uint32_t from, std::uint32_t until,
                   std::vector<Tally>& replicates) const;

  std::unique_ptr<Scene> scene_;
};

}  // namespace retrace::raytrace
