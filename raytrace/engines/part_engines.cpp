#include "raytrace/engines/part_engines.h"

#include <utility>

#include "core/error.h"
#include "raytrace/engines/beam_race.h"
#include "raytrace/exact/scattered_rays.h"
#include "raytrace/exact/stochastic_beams.h"

namespace retrace::raytrace {
namespace {

// Expected times of the tracers, as measured by benchmarks/engine_choice.cpp. The choice of a method depends on counted
// work and these times, and not on clocks. It is therefore the same on every machine.

/// Time of one ray segment, and additional time for each facet of a cell. For the engine `cell`, segments take longer
/// in finite arrays (kCellOfFinite), because Embree traces the rays near the borders.
struct SegmentCost {
  double ns = 0.0;
  double ns_per_facet = 0.0;
};
constexpr SegmentCost kCell{50.0, 15.0};
constexpr SegmentCost kCellOfFinite{220.0, 25.0};
constexpr SegmentCost kEmbree{350.0, 25.0};
/// Expected number of ray segments in the first round of Monte Carlo.
constexpr double kSegmentsOfFirstRound = 8192.0 * 8.0;
/// Maximum time for constructing the beam tracer, as a fraction of the expected remaining time of ray tracing. With
/// this limit, an unsuccessful attempt to trace beams takes at most half of the time of ray tracing.
constexpr double kMaxTracerFraction = 0.3;

EngineResult result_of_stochastic(const StochasticBeams& beams) {
  return {Engine::stochastic, beams.result(), beams.beams()};
}

EngineResult result_of(const BeamRace& race) {
  return race.is_exact() ? EngineResult{Engine::exact, race.exact()} : result_of_stochastic(race.stochastic());
}

}  // namespace

/// State of beam tracing: exact and stochastic beams (see BeamRace), and the light that rough facets scatter.
struct PartEngines::Beams {
  /// Traces beams for one step. Beams that exceed a budget are abandoned, because rays can be traced instead.
  /// \return true if the beams have reached their goal
  bool advance() {
    try {
      return race->advance();
    } catch (const BudgetError&) {
      race.reset();
      is_given_up = true;
      return false;
    }
  }

  std::unique_ptr<ScatteredLight> scattered;
  std::optional<BeamRace> race;
  bool is_given_up = false;
};

PartEngines::PartEngines(const geometry::Part& part, const geometry::Entrance* entrance, Settings settings,
                         const Cancellation* cancel)
    : part_(part), entrance_(entrance), settings_(std::move(settings)), cancel_(cancel) {}

void PartEngines::expect(std::size_t count) {
  if (!tracer_ns_) tracer_ns_ = beam_tracer_ns(part_) / static_cast<double>(count);
}

const BeamTracer& PartEngines::beam_tracer() {
  std::call_once(beam_tracer_is_made_, [this] {
    beam_tracer_.emplace(part_, settings_.elements);
    if (settings_.has_texture) scattering_.emplace(part_, beam_tracer_->centre_mm());
  });
  return *beam_tracer_;
}

const MonteCarlo& PartEngines::ray_tracer() {
  using Rays = MonteCarlo::Engine;
  std::call_once(ray_tracer_is_made_, [this] {
    ray_tracer_.emplace(part_, settings_.rays == Engine::cell ? Rays::cell : Rays::embree, entrance_);
  });
  return *ray_tracer_;
}

double PartEngines::ns_of_segment() const {
  const SegmentCost cost = settings_.rays != Engine::cell ? kEmbree : part_.period_mm ? kCell : kCellOfFinite;
  return cost.ns + cost.ns_per_facet * facets_of_cell(part_);
}

/// Returns the object that computes the light scattered by rough facets. Null if facets do not scatter.
std::unique_ptr<ScatteredLight> PartEngines::scattered_light(const Light& light) {
  const BeamTracer& tracer = beam_tracer();
  if (!scattering_) return nullptr;
  return std::make_unique<ScatteredLightByRays>(tracer, *scattering_, light.optics, light.illumination,
                                                settings_.cones_deg);
}

EngineResult PartEngines::by_rays(const Light& light, Progress& progress) {
  return {settings_.rays, ray_tracer().trace(light.optics, light.illumination, settings_.cones_deg, light.sampling,
                                             settings_.paths, cancel_, nullptr, &progress)};
}

EngineResult PartEngines::by_stochastic_beams(const Light& light, Progress& progress) {
  const std::unique_ptr<ScatteredLight> scattered = scattered_light(light);
  StochasticBeams beams(beam_tracer(), scattered.get(), light.optics, light.illumination, settings_.cones_deg,
                        light.sampling, cancel_);
  while (!beams.advance()) progress.at(beams.work() / beams.expected_work());
  return result_of_stochastic(beams);
}

void PartEngines::begin(Beams& beams, const Light& light) {
  beams.scattered = scattered_light(light);
  beams.race.emplace(beam_tracer(), beams.scattered.get(), light.optics, light.illumination, settings_.cones_deg,
                     settings_.beams, light.sampling, BeamRace::Options{.may_resample = !settings_.beams.cutoff},
                     cancel_);
}

std::optional<EngineResult> PartEngines::by_fastest(const Light& light, Progress& progress) {
  const double ns_per_segment = ns_of_segment();
  Beams beams;
  std::optional<MonteCarlo::Run> rays;
  while (!is_cancelled(cancel_)) {
    const double rays_take = ns_per_segment * (rays ? rays->expected_segments() : kSegmentsOfFirstRound);
    const double rays_took = rays ? ns_per_segment * static_cast<double>(rays->result().segments) : 0.0;
    const bool begins =
        !beams.race && !beams.is_given_up && *tracer_ns_ <= kMaxTracerFraction * (rays_take - rays_took);
    if (begins) begin(beams, light);
    if (beams.race && beams.race->expected_ns() <= rays_take) {
      if (beams.advance()) return result_of(*beams.race);
      if (beams.race) progress.at(beams.race->fraction_done());
    } else {
      if (!rays)
        rays.emplace(ray_tracer(), light.optics, light.illumination, settings_.cones_deg, light.sampling,
                     settings_.paths, cancel_);
      if (rays->advance()) return EngineResult{settings_.rays, rays->result()};
      progress.at(static_cast<double>(rays->result().segments) / rays->expected_segments());
    }
  }
  return std::nullopt;
}

}  // namespace retrace::raytrace
