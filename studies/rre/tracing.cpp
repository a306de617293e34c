#include "studies/rre/tracing.h"

#include <algorithm>
#include <utility>
#include <variant>

#include "core/task_progress.h"
#include "raytrace/balls/ball_tracer.h"
#include "raytrace/engines/part_engines.h"
#include "raytrace/engines/wavelengths.h"
#include "studies/rre/beam_tracing.h"

namespace retrace::studies {
namespace {

/// Amount of work, in units of BeamTrace::work(), up to which beams are traced even if their error is already below the
/// requested error. It takes about 3 ms.
constexpr std::uint64_t kSpareWork = 100'000;

raytrace::Sampling sampling_of(const RreSettings& request) {
  raytrace::Sampling sampling;
  sampling.kind = request.sampling;
  sampling.seed = request.seed;
  sampling.target_error = target_error_of(request);
  sampling.rays = request.rays;
  return sampling;
}

bool asks_for_more(const RreSettings& request) {
  return request.footprint || request.far_field || request.derivatives;
}

/// Returns the limits for tracing beams. The limits are those of the request. If the request gives no target error and
/// only the engine `exact` can be used, the default goal of this engine applies.
raytrace::BeamPolicy beam_policy(const RreSettings& request) {
  raytrace::BeamPolicy policy;
  policy.cutoff = request.cutoff;
  const bool is_free = request.engine == raytrace::Engine::automatic && !asks_for_more(request);
  if (request.target_error || is_free) policy.truncated_goal = target_error_of(request);
  if (is_free) policy.spare_work = kSpareWork;
  return policy;
}

/// Adds the derivatives to the points. Returns false if the computation was cancelled.
bool add_derivatives(const TracedDirection& traced, const Cancellation* cancel, std::vector<RrePoint>& points) {
  const auto by_cone = rre_derivatives(traced, cancel);
  if (!by_cone) return false;
  for (std::size_t cone = 0; cone < points.size(); ++cone) points[cone].derivatives = (*by_cone)[cone];
  return true;
}

raytrace::PartEngines::Settings engine_settings(const design::Design& design, const raytrace::EngineFacts& facts,
                                                const RreSettings& request) {
  using Elements = raytrace::BeamTracer::Elements;
  raytrace::PartEngines::Settings settings;
  settings.rays = raytrace::ray_engine(request.engine, facts);
  settings.elements = must_be_exact(request) ? Elements::individual : Elements::instanced;
  settings.has_texture = facts.has_texture;
  settings.beams = beam_policy(request);
  settings.paths.cutoff = request.cutoff.value_or(settings.paths.cutoff);
  settings.cones_deg = design.detector.acceptance_half_angle_deg;
  return settings;
}

std::size_t unit_count(const std::vector<Direction>& directions) {
  std::size_t count = 0;
  for (const Direction& direction : directions) count += direction.spectral.size();
  return count;
}

}  // namespace

/// Traces the directions of one design at all its wavelengths.
class DesignTracing {
 public:
  DesignTracing(const design::Design& design, const design::OpticalModel& model, const RreSettings& request,
                const raytrace::EngineFacts& facts, const Cancellation* cancel)
      : design_(design),
        model_(model),
        request_(request),
        cancel_(cancel),
        follows_beams_(may_use_beams(request) && !raytrace::obstacle_for(raytrace::Engine::stochastic, facts)),
        engines_(model.part, model.entrance ? &*model.entrance : nullptr, engine_settings(design, facts, request),
                 cancel) {}

  /// Returns true if each thread traces a different direction. Otherwise, all threads trace the same direction
  /// together.
  bool takes_several() const { return follows_beams_; }

  /// Sets the number of combinations of direction and wavelength that will be traced.
  void expect(std::size_t units) {
    if (follows_beams_) engines_.expect(units);
  }

  /// Traces a direction at one wavelength. Returns false if tracing was cancelled; the direction then has no new point.
  /// \pre expect() was called
  bool trace(Direction& direction, std::size_t wavelength, Progress& progress) {
    const design::SpectralOptics& light = model_.spectral[wavelength];
    const raytrace::PartEngines::Light traced{light.optics, illumination_of(direction.at, design_),
                                              raytrace::sampling_at(sampling_of(request_), light.weight, wavelength)};
    if (design_.balls()) return trace_balls(direction, wavelength, traced, progress);
    if (!follows_beams_) return keep(direction, wavelength, engines_.by_rays(traced, progress));
    if (must_be_exact(request_)) return trace_beams(direction, wavelength, traced, progress);
    if (request_.engine == raytrace::Engine::stochastic)
      return keep(direction, wavelength, engines_.by_stochastic_beams(traced, progress));
    const std::optional<raytrace::EngineResult> fastest = engines_.by_fastest(traced, progress);
    return fastest && keep(direction, wavelength, *fastest);
  }

 private:
  const std::vector<double>& cones() const { return engines_.settings().cones_deg; }

  /// Returns the point of a direction at one of its wavelengths, before it is traced.
  RrePoint point_at(const Direction& direction, std::size_t wavelength, std::string_view engine) const {
    RrePoint at = direction.at;
    at.wavelength_nm = model_.spectral[wavelength].wavelength_nm;
    at.engine = engine;
    return at;
  }

  bool keep(Direction& direction, std::size_t wavelength, const raytrace::MonteCarloResult& traced,
            std::string_view engine) const {
    if (!traced.complete) return false;
    direction.spectral[wavelength] = points_of(point_at(direction, wavelength, engine), traced);
    direction.rays[wavelength] = traced.rays;
    direction.missed_target[wavelength] = !traced.reached_target;
    return true;
  }

  bool keep(Direction& direction, std::size_t wavelength, const raytrace::BeamResult& traced) const {
    if (!traced.complete) return false;
    direction.spectral[wavelength] =
        points_of(point_at(direction, wavelength, engine_name(raytrace::Engine::exact)), cones(), traced);
    return true;
  }

  bool keep(Direction& direction, std::size_t wavelength, const raytrace::EngineResult& result) const {
    if (const auto* beams = std::get_if<raytrace::BeamResult>(&result.traced))
      return keep(direction, wavelength, *beams);
    const auto& traced = std::get<raytrace::MonteCarloResult>(result.traced);
    if (!keep(direction, wavelength, traced, engine_name(result.engine))) return false;
    for (RrePoint& point : direction.spectral[wavelength]) point.beams = result.beams;
    return true;
  }

  bool trace_balls(Direction& direction, std::size_t wavelength, const raytrace::PartEngines::Light& light,
                   Progress& progress) const {
    return keep(direction, wavelength,
                raytrace::BallTracer(*design_.balls())
                    .trace(light.optics, light.illumination, cones(), light.sampling, engines_.settings().paths,
                           cancel_, nullptr, &progress),
                "balls");
  }

  bool trace_beams(Direction& direction, std::size_t wavelength, const raytrace::PartEngines::Light& light,
                   Progress& progress) {
    BeamOutputs answer = trace_exact_beams(
        engines_.beam_tracer(), model_.part, light.optics, light.illumination, cones(), engines_.settings().beams,
        {.footprint = request_.footprint, .far_field = request_.far_field}, cancel_, &progress);
    if (!keep(direction, wavelength, answer.traced)) return false;
    direction.footprint = std::move(answer.footprint);
    direction.far_field = std::move(answer.far_field);
    return !request_.derivatives || add_derivatives({design_, model_, engines_.beam_tracer(), light.illumination,
                                                     engines_.settings().beams, answer.traced},
                                                    cancel_, direction.spectral[wavelength]);
  }

  const design::Design& design_;
  const design::OpticalModel& model_;
  const RreSettings& request_;
  const Cancellation* cancel_;
  bool follows_beams_;  ///< true: light may be traced as beams or rays; false: only as rays
  raytrace::PartEngines engines_;
};

bool may_use_beams(const RreSettings& request) {
  const bool asks_for_rays = request.rays || request.needs_plain_sampling();
  return request.engine == raytrace::Engine::exact || request.engine == raytrace::Engine::stochastic ||
         (request.engine == raytrace::Engine::automatic && !asks_for_rays);
}

bool must_be_exact(const RreSettings& request) {
  return request.engine == raytrace::Engine::exact || asks_for_more(request);
}

raytrace::EngineFacts engine_facts(const design::Design& design, const design::OpticalModel* model,
                                   const RreSettings& request) {
  raytrace::EngineFacts facts = design::engine_facts(design, model != nullptr ? &model->optics : nullptr);
  facts.has_unequal_cells = model != nullptr && !facts.has_balls && !raytrace::MonteCarlo::cell_supports(model->part);
  facts.needs_plain_sampling = request.needs_plain_sampling();
  return facts;
}

DirectionTracing::DirectionTracing(const std::vector<design::Design>& designs,
                                   const std::vector<design::OpticalModel>& models, const RreSettings& request,
                                   const Cancellation* cancel)
    : designs_(designs), models_(models), request_(request), cancel_(cancel), tracings_(designs.size()) {}

DirectionTracing::~DirectionTracing() = default;

void DirectionTracing::trace(std::vector<Direction>& directions, Progress* progress) {
  if (progress != nullptr) progress->at(0.0);
  TaskProgress all(progress, unit_count(directions));
  for (auto first = directions.begin(); first != directions.end();) {
    const std::size_t d = first->at.design;
    const std::size_t wavelengths = models_[d].spectral.size();
    const auto last = std::find_if(first, directions.end(), [&](const Direction& at) { return at.at.design != d; });
    if (!tracings_[d])
      tracings_[d] = std::make_unique<DesignTracing>(designs_[d], models_[d], request_,
                                                     engine_facts(designs_[d], &models_[d], request_), cancel_);
    DesignTracing& tracing = *tracings_[d];
    const auto count = static_cast<std::size_t>(last - first);
    tracing.expect(count * wavelengths);
    const bool is_complete = raytrace::trace_wavelengths(
        count, wavelengths, tracing.takes_several(), all, [&](std::size_t k, std::size_t wavelength, Progress& task) {
          return tracing.trace(first[static_cast<std::ptrdiff_t>(k)], wavelength, task);
        });
    if (!is_complete) return;
    if (request_.incidence_spans.empty()) tracings_[d].reset();
    first = last;
  }
}

}  // namespace retrace::studies
