#include "raytrace/paths/monte_carlo.h"

#include <tbb/enumerable_thread_specific.h>

#include <limits>

#include "raytrace/cells/cell_walker.h"
#include "raytrace/faces/back_surface.h"
#include "raytrace/paths/path_tracer.h"
#include "raytrace/sampling/entrance_sampler.h"
#include "raytrace/sampling/flush_denormals.h"
#include "raytrace/sampling/replicates.h"
#include "raytrace/sampling/sobol.h"

namespace retrace::raytrace {
namespace {

// Number of the Philox random stream for entry points. The streams of other random numbers are defined in replicates.h.
constexpr std::uint32_t kEntryStream = 3;  // plain sampling

std::size_t score_size(const LightSetup& setup) {
  return setup.score != nullptr ? setup.score->size() : 0;
}

std::array<double, 2> random_point(std::uint32_t seed, std::uint32_t replicate, std::uint32_t ray) {
  const auto words = philox({seed, kEntryStream}, replicate, ray);
  return {unit_interval(words[0]), unit_interval(words[1])};
}

}  // namespace

struct MonteCarlo::Scene {
  Scene(const geometry::Part& p, Engine engine, const geometry::Entrance* curved) : part(p), entrance(p) {
    if (curved != nullptr) entrance_face = make_entrance_face(*curved, p, entrance.centre_mm());
    if (engine == Engine::cell) cells = CellArray::make(p);
    if (engine == Engine::embree || !p.period_mm) surface.emplace(p, entrance.centre_mm());
  }

  const geometry::Part& part;
  EntranceSampler entrance;
  std::optional<BackSurface> surface;  ///< for Engine::embree, and for rays near the borders of finite parts
  std::optional<CellArray> cells;
  std::unique_ptr<const EntranceFace> entrance_face;  ///< null if the entrance face is plane
};

/// Rays with the numbers first to last - 1 of one replicate.
struct MonteCarlo::Task {
  std::uint32_t replicate = 0;
  std::uint32_t first = 0;
  std::uint32_t last = 0;
};

MonteCarlo::MonteCarlo(const geometry::Part& part, Engine engine, const geometry::Entrance* entrance_face)
    : scene_(std::make_unique<Scene>(part, engine, entrance_face)) {}
MonteCarlo::~MonteCarlo() = default;

bool MonteCarlo::cell_supports(const geometry::Part& part) {
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
      walker.trace(setup.lit_region ? (*setup.lit_region)(point) : scene_->entrance(point), {seed, kChoiceStream},
                   task.replicate, ray);
    }
    return tally;
  };
}

MonteCarlo::TraceTask MonteCarlo::by_cells(const LightSetup& setup, const PathSetup* paths, const PathPolicy& policy,
                                           std::uint32_t seed, const Cancellation* cancel) const {
  // Each thread reuses its walker to avoid memory allocations.
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
    for (const CellRay& ray : walker.handed_over())
      border.resume(ray.position, ray.ray, key, task.replicate, task.first, choices);
    return tally;
  };
}

bool MonteCarlo::trace_range(const TraceTask& trace_task, std::uint32_t from, std::uint32_t until,
                             std::vector<Tally>& replicates) const {
  return trace_replicates(from, until, replicates,
                          [&](std::uint32_t replicate, std::uint32_t first, std::uint32_t last) {
                            return trace_task({replicate, first, last});
                          });
}

/// Objects that the rounds of a run use. A member may refer to the members before it.
struct MonteCarlo::Run::Impl {
  PathPolicy policy;
  std::optional<LightSetup> light;
  std::optional<PathSetup> paths;
  TraceTask trace_task;
  std::optional<Rounds> rounds;
};

MonteCarlo::Run::Run(const MonteCarlo& tracer, const Optics& optics, const Illumination& illumination,
                     const std::vector<double>& cones_deg, const Sampling& sampling, const PathPolicy& policy,
                     const Cancellation* cancel, const DirectionScore* score, Progress* progress)
    : impl_(std::make_unique<Impl>()) {
  Impl& q = *impl_;
  const Scene& scene = *tracer.scene_;
  q.policy = policy;
  PathPolicy how = policy;
  if (sampling.kind == Sampling::Kind::plain) how.split_power = std::numeric_limits<double>::infinity();
  const Vec2 centre = scene.entrance.centre_mm();
  if (scene.surface)
    q.paths.emplace(scene.part, *scene.surface, centre, optics, illumination, cones_deg, how,
                    scene.entrance_face.get());
  if (q.paths) q.paths->score = score;
  if (scene.cells && q.paths) {
    q.trace_task = tracer.by_cells(*q.paths, &*q.paths, q.policy, sampling.seed, cancel);
  } else if (scene.cells) {
    q.light.emplace(scene.part, centre, optics, illumination, cones_deg);
    q.light->score = score;
    q.trace_task = tracer.by_cells(*q.light, nullptr, q.policy, sampling.seed, cancel);
  } else {
    q.trace_task = tracer.one_by_one(*q.paths, sampling, cancel);
  }
  q.rounds.emplace(
      sampling, cones_deg, score != nullptr ? score->size() : 0,
      [&tracer, &q](std::uint32_t from, std::uint32_t until, std::vector<Tally>& replicates) {
        return tracer.trace_range(q.trace_task, from, until, replicates);
      },
      progress);
}

MonteCarlo::Run::~Run() = default;

double MonteCarlo::Run::beam_area_ratio() const {
  return impl_->paths && impl_->paths->lit_region ? impl_->paths->lit_region->area_ratio() : 1.0;
}

bool MonteCarlo::Run::advance() {
  return impl_->rounds->advance();
}

const MonteCarloResult& MonteCarlo::Run::result() const {
  return impl_->rounds->result();
}

double MonteCarlo::Run::expected_segments() const {
  return impl_->rounds->expected_segments();
}

MonteCarloResult MonteCarlo::trace(const Optics& optics, const Illumination& illumination,
                                   const std::vector<double>& cones_deg, const Sampling& sampling,
                                   const PathPolicy& policy, const Cancellation* cancel, const DirectionScore* score,
                                   Progress* progress) const {
  Run run(*this, optics, illumination, cones_deg, sampling, policy, cancel, score, progress);
  while (!run.advance()) continue;
  MonteCarloResult result = run.result();
  result.beam_area_ratio = run.beam_area_ratio();
  return result;
}

}  // namespace retrace::raytrace
