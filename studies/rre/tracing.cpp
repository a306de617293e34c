#include "studies/rre/tracing.h"

#include <algorithm>
#include <cmath>
#include <mutex>

#include "core/error.h"
#include "core/task_progress.h"
#include "core/within_memory.h"
#include "raytrace/balls/ball_tracer.h"
#include "raytrace/exact/scattered_rays.h"
#include "raytrace/exact/stochastic_beams.h"
#include "raytrace/faces/back_surface.h"
#include "studies/rre/beam_race.h"
#include "studies/rre/beam_tracing.h"

namespace retrace::studies {
namespace {

// Expected times of the tracers, as measured by benchmarks/engine_choice.cpp. Methods are chosen from counted work and
// these times, and not from clocks, so that the choice is the same on every machine.

/// Time of one ray segment, and additional time for each facet of an element. For the engine `cell`, segments take
/// longer in finite arrays (kCellOfFinite), because Embree traces the rays near the borders.
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
constexpr double kMaxTracerShare = 0.3;
/// Amount of work that beams may do even if their error is already below the requested error. It takes about 3 ms.
constexpr std::uint64_t kSpareWork = 100'000;

/// Returns the sampling parameters of one wavelength. Rays are distributed in proportion to the weights w of the
/// wavelengths. An estimate then has the variance v / (w N) and contributes w^2 v / (w N). The sum is v / N, as if all
/// N rays had one wavelength. A target error t becomes t / sqrt(w) in the same way. Wavelengths have different seeds,
/// so that their estimates are independent. The first wavelength has the requested seed.
raytrace::Sampling sampling_of(const RreSettings& request, double weight, std::size_t wavelength) {
  constexpr std::uint32_t kGolden = 0x9e3779b9U;  // odd, so that all wavelengths have different seeds
  raytrace::Sampling sampling;
  sampling.kind = request.sampling;
  sampling.seed = request.seed + kGolden * static_cast<std::uint32_t>(wavelength);
  sampling.target_error = target_error_of(request) / std::sqrt(weight);
  if (request.rays)
    sampling.rays = std::max<std::uint64_t>(
        1, static_cast<std::uint64_t>(std::llround(weight * static_cast<double>(*request.rays))));
  return sampling;
}

/// Returns the point of a direction at one of its wavelengths, before it is traced.
RrePoint spectral_point(const Direction& direction, const SpectralOptics& light, std::string_view engine) {
  RrePoint at = direction.at;
  at.wavelength_nm = light.wavelength_nm;
  at.engine = engine;
  return at;
}

bool asks_for_more(const RreSettings& request) {
  return request.footprint || request.far_field || request.derivatives;
}

/// Returns the limits for tracing beams. The limits are those of the request. If the request gives no target error and
/// only the engine `exact` can be used, the default goal of this engine applies.
raytrace::BeamPolicy beam_policy(const RreSettings& request) {
  raytrace::BeamPolicy policy;
  policy.cutoff = request.cutoff;
  const bool is_free = request.engine == Engine::automatic && !asks_for_more(request);
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

std::string_view name_of(raytrace::MonteCarlo::Engine engine) {
  return engine == raytrace::MonteCarlo::Engine::cell ? "cell" : "embree";
}

std::size_t unit_count(const std::vector<Direction>& directions) {
  std::size_t count = 0;
  for (const Direction& direction : directions) count += direction.spectral.size();
  return count;
}

}  // namespace

/// Traces all directions of one design at all its wavelengths.
class DesignTracing {
 public:
  DesignTracing(const Design& design, const OpticalModel& model, const RreSettings& request, const Cancellation* cancel)
      : design_(design), model_(model), request_(request), cancel_(cancel), beams_(beam_policy(request)) {
    paths_.cutoff = request.cutoff.value_or(paths_.cutoff);
    follows_beams_ = may_follow_beams(design, model, request);
  }

  /// Returns true if each thread traces another direction. Otherwise all threads trace the same direction.
  bool takes_several() const { return follows_beams_; }

  /// Sets the number of combinations of direction and wavelength that will be traced. The construction time of the beam
  /// tracer is divided evenly among them.
  void expect(std::size_t units) {
    if (follows_beams_ && !tracer_ns_) tracer_ns_ = beam_tracer_ns(model_.part) / static_cast<double>(units);
  }

  /// Traces a direction at one wavelength. Returns false if tracing was cancelled; the direction then has no new point.
  /// \pre expect() was called
  bool trace(Direction& direction, std::size_t wavelength, Progress& progress) {
    if (!follows_beams_) return trace_rays(direction, wavelength, progress);
    if (must_be_exact(request_)) return trace_beams(direction, wavelength, progress);
    if (request_.engine == Engine::stochastic) return trace_stochastic(direction, wavelength, progress);
    return trace_fastest(direction, wavelength, progress);
  }

 private:
  const SpectralOptics& light(std::size_t wavelength) const { return model_.spectral[wavelength]; }
  const std::vector<double>& cones() const { return design_.detector.acceptance_half_angle_deg; }

  raytrace::MonteCarlo::Engine ray_engine() const {
    using raytrace::MonteCarlo;
    const bool may_be_cell = !model_.entrance && model_.optics.has_one_back() && request_.engine != Engine::embree &&
                             request_.sampling == raytrace::Sampling::Kind::stratified;
    return may_be_cell && MonteCarlo::cell_serves(model_.part) ? MonteCarlo::Engine::cell : MonteCarlo::Engine::embree;
  }

  double ns_of_segment() const {
    const bool is_cell = ray_engine() == raytrace::MonteCarlo::Engine::cell;
    const SegmentCost cost = !is_cell ? kEmbree : model_.part.period_mm ? kCell : kCellOfFinite;
    return cost.ns + cost.ns_per_facet * facets_of_cell(model_.part);
  }

  /// Returns the beam tracer. It is constructed at the first call.
  const raytrace::BeamTracer& beam_tracer() {
    using Elements = raytrace::BeamTracer::Elements;
    std::call_once(beam_tracer_is_made_, [this] {
      beam_tracer_.emplace(model_.part, must_be_exact(request_) ? Elements::each_by_itself : Elements::equal_at_once);
      if (!model_.optics.is_smooth()) scattering_.emplace(model_.part, beam_tracer_->centre_mm());
    });
    return *beam_tracer_;
  }

  /// Returns the ray tracer. It is constructed at the first call.
  const raytrace::MonteCarlo& ray_tracer() {
    std::call_once(ray_tracer_is_made_, [this] {
      ray_tracer_.emplace(model_.part, ray_engine(), model_.entrance ? &*model_.entrance : nullptr);
    });
    return *ray_tracer_;
  }

  bool keep(Direction& direction, std::size_t wavelength, const raytrace::MonteCarloResult& traced,
            std::string_view engine) const {
    if (!traced.complete) return false;
    direction.spectral[wavelength] = points_of(spectral_point(direction, light(wavelength), engine), traced);
    direction.rays[wavelength] = traced.rays;
    direction.missed_target[wavelength] = !traced.reached_target;
    return true;
  }

  bool keep(Direction& direction, std::size_t wavelength, const raytrace::BeamResult& traced) const {
    if (!traced.complete) return false;
    direction.spectral[wavelength] = points_of(spectral_point(direction, light(wavelength), "exact"), cones(), traced);
    return true;
  }

  bool trace_rays(Direction& direction, std::size_t wavelength, Progress& progress) {
    const raytrace::Illumination illumination = illumination_of(direction.at, design_);
    const raytrace::Optics& optics = light(wavelength).optics;
    const raytrace::Sampling sampling = sampling_of(request_, light(wavelength).weight, wavelength);
    if (design_.balls())
      return keep(direction, wavelength,
                  raytrace::BallTracer(*design_.balls())
                      .trace(optics, illumination, cones(), sampling, paths_, cancel_, nullptr, &progress),
                  "balls");
    return keep(direction, wavelength,
                ray_tracer().trace(optics, illumination, cones(), sampling, paths_, cancel_, nullptr, &progress),
                name_of(ray_engine()));
  }

  bool trace_beams(Direction& direction, std::size_t wavelength, Progress& progress) {
    const raytrace::Illumination illumination = illumination_of(direction.at, design_);
    BeamAnswer answer =
        follow_beams(beam_tracer(), model_.part, light(wavelength).optics, illumination, cones(), beams_,
                     {.footprint = request_.footprint, .far_field = request_.far_field}, cancel_, &progress);
    if (!keep(direction, wavelength, answer.traced)) return false;
    direction.footprint = std::move(answer.footprint);
    direction.far_field = std::move(answer.far_field);
    return !request_.derivatives ||
           add_derivatives({design_, model_, beam_tracer(), illumination, beams_, answer.traced}, cancel_,
                           direction.spectral[wavelength]);
  }

  bool keep(Direction& direction, std::size_t wavelength, const BeamRace& traced) const {
    return traced.is_exact() ? keep(direction, wavelength, traced.exact())
                             : keep(direction, wavelength, traced.stochastic());
  }

  bool keep(Direction& direction, std::size_t wavelength, const raytrace::StochasticBeams& traced) const {
    if (!keep(direction, wavelength, traced.result(), "stochastic")) return false;
    for (RrePoint& point : direction.spectral[wavelength]) point.beams = traced.beams();
    return true;
  }

  /// Returns the object that computes the light scattered by rough facets. Null if facets do not scatter.
  std::unique_ptr<raytrace::ScatteredLight> scattered_light(const raytrace::Optics& optics,
                                                            const raytrace::Illumination& illumination) {
    const raytrace::BeamTracer& tracer = beam_tracer();
    if (!scattering_) return nullptr;
    return std::make_unique<raytrace::ScatteredLightByRays>(tracer, *scattering_, optics, illumination, cones());
  }

  bool trace_stochastic(Direction& direction, std::size_t wavelength, Progress& progress) {
    const raytrace::Optics& optics = light(wavelength).optics;
    const raytrace::Illumination illumination = illumination_of(direction.at, design_);
    const std::unique_ptr<raytrace::ScatteredLight> scattered = scattered_light(optics, illumination);
    raytrace::StochasticBeams beams(beam_tracer(), scattered.get(), optics, illumination, cones(),
                                    sampling_of(request_, light(wavelength).weight, wavelength), cancel_);
    while (!beams.advance()) progress.at(beams.work() / beams.expected_work());
    return keep(direction, wavelength, beams);
  }

  /// State of beam tracing for one direction: exact and stochastic beams (see BeamRace), and the light that rough
  /// facets scatter.
  struct Beams {
    std::unique_ptr<raytrace::ScatteredLight> scattered;
    std::optional<BeamRace> race;
    bool is_given_up = false;
  };

  void begin(Beams& beams, const raytrace::Optics& optics, const raytrace::Illumination& illumination,
             const raytrace::Sampling& sampling) {
    beams.scattered = scattered_light(optics, illumination);
    beams.race.emplace(beam_tracer(), beams.scattered.get(), optics, illumination, cones(), beams_, sampling,
                       BeamRace::Options{.may_resample = !request_.cutoff}, cancel_);
  }

  /// Traces beams for one step. Beams that exceed a budget are abandoned, because rays can be traced instead.
  /// \return true if the beams have reached their goal
  static bool advance(Beams& beams) {
    try {
      return beams.race->advance();
    } catch (const BudgetError&) {
      beams.race.reset();
      beams.is_given_up = true;
      return false;
    }
  }

  /// Traces with the method (beams or rays) that is expected to reach the goal first. The method is selected before
  /// every round. A method continues where it stopped if another method turns out to be slower than expected.
  bool trace_fastest(Direction& direction, std::size_t wavelength, Progress& progress) {
    const raytrace::Illumination illumination = illumination_of(direction.at, design_);
    const raytrace::Optics& optics = light(wavelength).optics;
    const raytrace::Sampling sampling = sampling_of(request_, light(wavelength).weight, wavelength);
    const double ns_per_segment = ns_of_segment();
    Beams beams;
    std::optional<raytrace::MonteCarlo::Run> rays;
    while (!is_cancelled(cancel_)) {
      const double rays_take = ns_per_segment * (rays ? rays->expected_segments() : kSegmentsOfFirstRound);
      const double rays_took = rays ? ns_per_segment * static_cast<double>(rays->result().segments) : 0.0;
      const bool begins = !beams.race && !beams.is_given_up && *tracer_ns_ <= kMaxTracerShare * (rays_take - rays_took);
      if (begins) begin(beams, optics, illumination, sampling);
      if (beams.race && beams.race->expected_ns() <= rays_take) {
        if (advance(beams)) return keep(direction, wavelength, *beams.race);
        if (beams.race) progress.at(beams.race->share_done());
      } else {
        if (!rays) rays.emplace(ray_tracer(), optics, illumination, cones(), sampling, paths_, cancel_);
        if (rays->advance()) return keep(direction, wavelength, rays->result(), name_of(ray_engine()));
        progress.at(static_cast<double>(rays->result().segments) / rays->expected_segments());
      }
    }
    return false;
  }

  const Design& design_;
  const OpticalModel& model_;
  const RreSettings& request_;
  const Cancellation* cancel_;
  raytrace::BeamPolicy beams_;
  raytrace::PathPolicy paths_;
  bool follows_beams_ = false;  ///< true: light may be traced as beams or rays; false: only as rays
  /// Expected time, in ns, for constructing `beam_tracer_`, divided by the number of combinations of direction and
  /// wavelength.
  std::optional<double> tracer_ns_;
  std::once_flag beam_tracer_is_made_;
  std::optional<raytrace::BeamTracer> beam_tracer_;
  std::optional<raytrace::BackSurface> scattering_;  ///< for the light that rough facets scatter out of beams
  std::once_flag ray_tracer_is_made_;
  std::optional<raytrace::MonteCarlo> ray_tracer_;
};

bool may_follow_beams(const RreSettings& request) {
  const bool asks_for_rays = request.rays || request.sampling == raytrace::Sampling::Kind::plain;
  return request.engine == Engine::exact || request.engine == Engine::stochastic ||
         (request.engine == Engine::automatic && !asks_for_rays);
}

bool may_follow_beams(const Design& design, const OpticalModel& model, const RreSettings& request) {
  return may_follow_beams(request) && !design.balls() && !model.entrance &&
         raytrace::StochasticBeams::serves(model.optics);
}

bool must_be_exact(const RreSettings& request) {
  return request.engine == Engine::exact || asks_for_more(request);
}

DirectionTracing::DirectionTracing(const std::vector<Design>& designs, const std::vector<OpticalModel>& models,
                                   const RreSettings& request, const Cancellation* cancel)
    : designs_(designs), models_(models), request_(request), cancel_(cancel), tracings_(designs.size()) {}

DirectionTracing::~DirectionTracing() = default;

void DirectionTracing::trace(std::vector<Direction>& directions, Progress* progress) {
  if (progress != nullptr) progress->at(0.0);
  TaskProgress all(progress, unit_count(directions));
  for (auto first = directions.begin(); first != directions.end();) {
    const std::size_t d = first->at.design;
    const std::size_t wavelengths = models_[d].spectral.size();
    const auto last = std::find_if(first, directions.end(), [&](const Direction& at) { return at.at.design != d; });
    if (!tracings_[d]) tracings_[d] = std::make_unique<DesignTracing>(designs_[d], models_[d], request_, cancel_);
    DesignTracing& tracing = *tracings_[d];
    const auto trace_unit = [&](std::size_t k) {
      Direction& direction = first[static_cast<std::ptrdiff_t>(k / wavelengths)];
      TaskProgress::Task task(all);
      const bool is_traced = tracing.trace(direction, k % wavelengths, task);
      if (is_traced) task.finish();
      return is_traced;
    };
    const std::size_t units = static_cast<std::size_t>(last - first) * wavelengths;
    tracing.expect(units);
    if (tracing.takes_several()) for_each_within_memory(units, trace_unit);
    for (std::size_t k = 0; !tracing.takes_several() && k < units; ++k)
      if (!trace_unit(k)) return;
    if (request_.incidence_spans.empty()) tracings_[d].reset();
    first = last;
  }
}

}  // namespace retrace::studies
