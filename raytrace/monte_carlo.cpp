#include "raytrace/monte_carlo.h"

#include <fmt/format.h>
#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.h"
#include "raytrace/back_surface.h"
#include "raytrace/cell/cell_walker.h"
#include "raytrace/entrance_sampler.h"
#include "raytrace/flush_denormals.h"
#include "raytrace/path_tracer.h"
#include "raytrace/sobol.h"
#include "raytrace/threads.h"

namespace retrace::raytrace {
namespace {

constexpr std::uint32_t kReplicates = MonteCarlo::kReplicates;
// Rays of a replicate that one task traces: small enough to share out, large enough to hide the cost of a task.
constexpr std::uint32_t kRaysPerTask = 2048;
// Rays of a replicate between two collections of the tasks' tallies: bounds their memory.
constexpr std::uint32_t kRaysPerSlice = 64 * kRaysPerTask;
// The Sobol sequence has 2^32 points; one is kept back so that counters do not wrap.
constexpr std::uint32_t kMostRaysPerReplicate = UINT32_MAX - kRaysPerSlice;
// Rays of a replicate before its error is looked at for the first time.
constexpr std::uint32_t kFirstRound = 256;
// Power that may be missing before the run counts as unsound.
constexpr double kLostLimit = 1e-9;

// Philox streams: one for the scrambles of the entry points, one for choices on the way.
constexpr std::uint32_t kScrambleStream = 1;
constexpr std::uint32_t kChoiceStream = 2;
constexpr std::uint32_t kEntryStream = 3;  // plain sampling

std::size_t score_size(const LightSetup& setup) {
  return setup.score != nullptr ? setup.score->size() : 0;
}

/// Of the scrambles of a replicate's entry points.
std::array<std::uint64_t, 2> scramble_keys(std::uint32_t seed, std::uint32_t replicate) {
  const auto words = philox({seed, kScrambleStream}, replicate, 0);
  return {(std::uint64_t{words[0]} << 32) | words[1], (std::uint64_t{words[2]} << 32) | words[3]};
}

std::array<double, 2> random_point(std::uint32_t seed, std::uint32_t replicate, std::uint32_t ray) {
  const auto words = philox({seed, kEntryStream}, replicate, ray);
  return {unit_interval(words[0]), unit_interval(words[1])};
}

ConeResult cone_result(const std::vector<Tally>& replicates, double rays, double half_angle_deg, std::size_t cone) {
  ConeResult result;
  result.half_angle_deg = half_angle_deg;
  std::vector<double> rre;
  for (const Tally& tally : replicates) {
    const Ledger ledger = tally.ledger(cone);
    rre.push_back(ledger[Account::retroreflected] / rays);
    result.stokes += 1.0 / (rays * kReplicates) * tally.retroreflected(cone);
    for (std::size_t k = 0; k < kAccountCount; ++k) result.ledger.power[k] += ledger.power[k] / rays / kReplicates;
  }
  result.rre = result.ledger[Account::retroreflected];
  double squares = 0.0;
  for (const double r : rre) squares += (r - result.rre) * (r - result.rre);
  result.std_error = std::sqrt(squares / (kReplicates - 1.0) / kReplicates);
  // Replicates that agree to rounding say the same.
  if (result.std_error < 1e-15) result.std_error = 0.0;
  return result;
}

/// Means and standard errors of what was scored.
void add_score(const std::vector<Tally>& replicates, double rays, MonteCarloResult& result) {
  const std::size_t size = replicates.front().score.size();
  result.score.assign(size, 0.0);
  result.score_error.assign(size, 0.0);
  for (std::size_t k = 0; k < size; ++k) {
    for (const Tally& tally : replicates) result.score[k] += tally.score[k] / rays / kReplicates;
    double squares = 0.0;
    for (const Tally& tally : replicates) {
      const double off = tally.score[k] / rays - result.score[k];
      squares += off * off;
    }
    result.score_error[k] = std::sqrt(squares / (kReplicates - 1.0) / kReplicates);
  }
}

MonteCarloResult result_of(const std::vector<Tally>& replicates, std::uint32_t rays_per_replicate,
                           const std::vector<double>& cones_deg) {
  MonteCarloResult result;
  result.rays = std::uint64_t{rays_per_replicate} * kReplicates;
  for (const Tally& tally : replicates) {
    result.segments += tally.segments;
    result.misses += tally.misses;
  }
  for (std::size_t cone = 0; cone < cones_deg.size(); ++cone)
    result.cones.push_back(cone_result(replicates, rays_per_replicate, cones_deg[cone], cone));
  add_score(replicates, rays_per_replicate, result);
  return result;
}

double largest_error(const MonteCarloResult& result) {
  double largest = 0.0;
  for (const ConeResult& cone : result.cones) largest = std::max(largest, cone.std_error);
  return largest;
}

void check_lost(const MonteCarloResult& result) {
  for (const ConeResult& cone : result.cones)
    if (cone.ledger[Account::lost] > kLostLimit)
      throw BudgetError(
          fmt::format("{} of {} rays missed every face from inside the part ({} of the power): this is a defect "
                      "of retrace, please report the design",
                      result.misses, result.rays, cone.ledger[Account::lost]));
}

}  // namespace

struct MonteCarlo::Scene {
  Scene(const geometry::Part& p, Engine engine) : part(p), entrance(p) {
    if (engine == Engine::cell) cells = CellArray::make(p);
    if (engine == Engine::embree || !p.period_mm) surface.emplace(p, entrance.centre_mm());
  }

  const geometry::Part& part;
  EntranceSampler entrance;
  std::optional<BackSurface> surface;  ///< for Embree, and borders
  std::optional<CellArray> cells;
};

/// Rays first..last-1 of one replicate.
struct MonteCarlo::Task {
  std::uint32_t replicate = 0;
  std::uint32_t first = 0;
  std::uint32_t last = 0;
};

MonteCarlo::MonteCarlo(const geometry::Part& part, Engine engine) : scene_(std::make_unique<Scene>(part, engine)) {}
MonteCarlo::~MonteCarlo() = default;

bool MonteCarlo::cell_serves(const geometry::Part& part) {
  return CellArray::make(part).has_value();
}

MonteCarlo::TraceTask MonteCarlo::one_by_one(const PathSetup& setup, const Sampling& sampling,
                                             const Cancellation* cancel) const {
  return [this, &setup, seed = sampling.seed, is_plain = sampling.kind == Sampling::Kind::plain,
          cancel](const Task& task) -> std::optional<Tally> {
    const FlushDenormals flush;
    Tally tally(setup.cone_chord2.size(), score_size(setup));
    const auto keys = scramble_keys(seed, task.replicate);
    const SobolSquare square(keys[0], keys[1]);
    PathWalker walker(setup, tally);
    for (std::uint32_t ray = task.first; ray < task.last; ++ray) {
      if (cancel != nullptr && cancel->requested()) return std::nullopt;
      const std::array<double, 2> point = is_plain ? random_point(seed, task.replicate, ray) : square(ray);
      walker.trace(scene_->entrance(point), {seed, kChoiceStream}, task.replicate, ray);
    }
    return tally;
  };
}

MonteCarlo::TraceTask MonteCarlo::by_cells(const LightSetup& setup, const PathSetup* paths, const PathPolicy& policy,
                                           std::uint32_t seed, const Cancellation* cancel) const {
  // Every thread keeps its walker, for its memory.
  const auto walkers = std::make_shared<tbb::enumerable_thread_specific<CellWalker>>(
      [this, &setup, &policy] { return CellWalker(setup, policy, *scene_->cells, scene_->entrance.centre_mm()); });
  const geometry::Rectangle entrance = scene_->part.period_mm
                                           ? geometry::Rectangle{Vec2::Zero(), *scene_->part.period_mm}
                                           : scene_->entrance.bounding_box();
  return [walkers, &setup, paths, entrance, seed, cancel](const Task& task) -> std::optional<Tally> {
    if (cancel != nullptr && cancel->requested()) return std::nullopt;
    const FlushDenormals flush;
    Tally tally(setup.cone_chord2.size(), score_size(setup));
    const auto keys = scramble_keys(seed, task.replicate);
    const RandomKey key{seed, kChoiceStream};
    CellWalker& walker = walkers->local();
    walker.trace(entrance, keys[0], keys[1], task.first, task.last - task.first, key, task.replicate, tally);
    if (paths == nullptr) return tally;
    PathWalker border(*paths, tally);
    std::uint32_t choices = walker.choices();
    for (const CellWalker::HandedOver& ray : walker.handed_over())
      border.resume(ray.position, ray.ray, ray.near_edge, key, task.replicate, task.first, choices);
    return tally;
  };
}

bool MonteCarlo::trace_range(const TraceTask& trace_task, std::uint32_t from, std::uint32_t until,
                             std::vector<Tally>& replicates) const {
  for (std::uint32_t slice = from; slice < until;) {
    const std::uint32_t slice_end = until - slice > kRaysPerSlice ? slice + kRaysPerSlice : until;
    std::vector<Task> tasks;
    for (std::uint32_t replicate = 0; replicate < kReplicates; ++replicate)
      for (std::uint32_t first = slice; first < slice_end; first += kRaysPerTask)
        tasks.push_back({replicate, first, std::min(slice_end, first + kRaysPerTask)});
    std::vector<std::optional<Tally>> tallies(tasks.size());
    for_each_in_parallel(tasks.size(), [&](std::size_t k) { tallies[k] = trace_task(tasks[k]); });
    if (std::any_of(tallies.begin(), tallies.end(), [](const auto& t) { return !t.has_value(); })) return false;
    // Added up in the order of the tasks, whichever thread did them.
    for (std::size_t k = 0; k < tasks.size(); ++k) replicates[tasks[k].replicate].add(*tallies[k]);
    slice = slice_end;
  }
  return true;
}

MonteCarloResult MonteCarlo::trace(const Optics& optics, const Illumination& illumination,
                                   const std::vector<double>& cones_deg, const Sampling& sampling,
                                   const PathPolicy& policy, const Cancellation* cancel,
                                   const DirectionScore* score) const {
  std::optional<LightSetup> light;
  std::optional<PathSetup> paths;
  TraceTask trace_task;
  PathPolicy how = policy;
  if (sampling.kind == Sampling::Kind::plain) how.split_power = std::numeric_limits<double>::infinity();
  const Vec2 centre = scene_->entrance.centre_mm();
  if (scene_->surface) paths.emplace(scene_->part, *scene_->surface, centre, optics, illumination, cones_deg, how);
  if (paths) paths->score = score;
  if (scene_->cells && paths) {
    trace_task = by_cells(*paths, &*paths, policy, sampling.seed, cancel);
  } else if (scene_->cells) {
    light.emplace(scene_->part, centre, optics, illumination, cones_deg);
    light->score = score;
    trace_task = by_cells(*light, nullptr, policy, sampling.seed, cancel);
  } else {
    trace_task = one_by_one(*paths, sampling, cancel);
  }
  const std::uint64_t rays = sampling.rays.value_or(sampling.max_rays);
  const auto goal = static_cast<std::uint32_t>(
      std::min<std::uint64_t>((rays + kReplicates - 1) / kReplicates, kMostRaysPerReplicate));
  std::vector<Tally> replicates(kReplicates, Tally(cones_deg.size(), score != nullptr ? score->size() : 0));
  MonteCarloResult result;
  for (std::uint32_t done = 0; done < goal;) {
    // Doubling keeps every round's points the first 2^k of their sequence, where they are best stratified.
    const std::uint32_t until = done == 0 ? std::min(goal, kFirstRound) : (done > goal / 2 ? goal : 2 * done);
    if (!trace_range(trace_task, done, until, replicates)) {
      result.complete = false;
      return result;  // what the rounds before gave
    }
    done = until;
    result = result_of(replicates, done, cones_deg);
    check_lost(result);
    if (!sampling.rays && largest_error(result) <= sampling.target_error) return result;
  }
  result.reached_target = sampling.rays.has_value();
  return result;
}

}  // namespace retrace::raytrace
