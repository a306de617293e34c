#include "studies/rre/tracing.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>

#include "core/error.h"
#include "raytrace/balls/ball_tracer.h"
#include "raytrace/exact/beam_tracer.h"
#include "raytrace/exact/stochastic_beams.h"
#include "raytrace/faces/back_surface.h"
#include "raytrace/sampling/threads.h"

namespace retrace::studies {
namespace {

// What the counts of work of the tracers stand for, as benchmarks/engine_choice.cpp measured them: choices rest on
// counts and not on clocks, so that they are the same on every machine.
constexpr double kNsPerLook = 30.0;
/// Of stochastic beams, which are fewer and wider.
constexpr double kNsPerStochasticLook = 15.0;
/// Of a straight piece, and of each facet of an element besides; of a finite array Embree does what is near its
/// borders.
struct SegmentCost {
  double ns = 0.0;
  double ns_per_facet = 0.0;
};
constexpr SegmentCost kCell{50.0, 15.0};
constexpr SegmentCost kCellOfFinite{220.0, 25.0};
constexpr SegmentCost kEmbree{350.0, 25.0};
/// Straight pieces of a first round of Monte Carlo, before there was one.
constexpr double kSegmentsOfFirstRound = 8192.0 * 8.0;
/// Looks that stochastic beams take to the usual error, before there was a round. Light that enters prisms askew
/// wanders far, and little of it comes back.
constexpr double kLooksForCubes = 300'000.0;
constexpr double kLooksForPrisms = 1'000'000.0;
/// Facets of a cell beyond which they take more, as measured with rounded edges: 300 times as many at 24.
constexpr double kFewFacets = 4.0;
constexpr double kGrowthWithFacets = 3.0;
/// What beams may take below the error that was requested: some 3 ms.
constexpr std::uint64_t kSpareWork = 100'000;
/// Share of what rays are expected to take that beams may take, however long they are expected to.
constexpr double kHedge = 0.2;
/// Work after which the engines are compared for the first time: a millisecond.
constexpr double kFirstLook = 30'000.0;
constexpr double kNever = std::numeric_limits<double>::infinity();

raytrace::Illumination illumination_of(const RrePoint& at, const Design& design) {
  return {Angle::from_deg(at.incidence_deg), Angle::from_deg(at.azimuth_deg), design.light.polarisation};
}

/// The sampling of one wavelength. Rays are shared in proportion to the weights w: variances v / (w N) of the estimates
/// then make w^2 v / (w N) each and v / N in all, as if all N rays were of one wavelength. A target t becomes
/// t / sqrt(w) in the same way. Seeds differ, so that the estimates are independent; the first is the one requested.
raytrace::Sampling sampling_of(const RreRequest& request, double weight, std::size_t wavelength) {
  constexpr std::uint32_t kGolden = 0x9e3779b9U;  // odd: no two wavelengths share a seed
  raytrace::Sampling sampling;
  sampling.kind = request.sampling;
  sampling.seed = request.seed + kGolden * static_cast<std::uint32_t>(wavelength);
  sampling.target_error = target_error_of(request) / std::sqrt(weight);
  if (request.rays)
    sampling.rays = std::max<std::uint64_t>(
        1, static_cast<std::uint64_t>(std::llround(weight * static_cast<double>(*request.rays))));
  return sampling;
}

std::vector<RrePoint> points_of(const RrePoint& at, const raytrace::MonteCarloResult& traced) {
  std::vector<RrePoint> points;
  for (const raytrace::ConeResult& cone : traced.cones) {
    RrePoint point = at;
    point.acceptance_half_angle_deg = cone.half_angle_deg;
    point.rre = cone.rre;
    point.std_error = cone.std_error;
    point.stokes = cone.stokes;
    point.ledger = cone.ledger;
    points.push_back(point);
  }
  return points;
}

std::vector<RrePoint> points_of(const RrePoint& at, const std::vector<double>& cones,
                                const raytrace::BeamResult& traced) {
  std::vector<RrePoint> points;
  for (std::size_t cone = 0; cone < cones.size(); ++cone) {
    RrePoint point = at;
    point.acceptance_half_angle_deg = cones[cone];
    point.ledger = traced.ledgers[cone];
    point.rre = point.ledger[raytrace::Account::retroreflected];
    point.stokes = traced.stokes[cone];
    point.beams = traced.beams;
    point.depth = traced.depth;
    points.push_back(point);
  }
  return points;
}

/// The point of a direction at one of its wavelengths, before it is traced.
RrePoint spectral_point(const Direction& direction, const SpectralOptics& light, std::string_view engine) {
  RrePoint at = direction.at;
  at.wavelength_nm = light.wavelength_nm;
  at.engine = engine;
  return at;
}

bool asks_for_more(const RreRequest& request) {
  return request.footprint || request.far_field || request.derivatives;
}

/// How far beams are followed: as far as is requested, and to the finest goal where the exact engine was requested by
/// name and nothing else.
raytrace::BeamPolicy beam_policy(const RreRequest& request) {
  raytrace::BeamPolicy policy;
  policy.cutoff = request.cutoff;
  const bool is_free = request.engine == Engine::automatic && !asks_for_more(request);
  if (request.target_error || is_free) policy.truncated_goal = target_error_of(request);
  if (is_free) policy.spare_work = kSpareWork;
  return policy;
}

/// Gathers the returned beams of one direction, as far as they were requested.
class Collector {
 public:
  Collector(const RreRequest& request, const OpticalModel& model, std::size_t cones,
            const raytrace::Illumination& illumination) {
    if (request.footprint) footprint_.emplace(model.part, cones);
    if (request.far_field) far_field_.emplace(illumination);
  }

  raytrace::BeamObserver observer() {
    if (!footprint_ && !far_field_) return {};
    return [this](const raytrace::ReturnedBeam& beam) {
      if (footprint_) footprint_->add(beam);
      if (far_field_) far_field_->add(beam);
    };
  }
  void finish(Direction& direction) const {
    if (footprint_) direction.footprint = footprint_->finish();
    if (far_field_) direction.far_field = far_field_->finish();
  }

 private:
  std::optional<FootprintBuilder> footprint_;
  std::optional<FarFieldBuilder> far_field_;
};

/// False if it was cancelled.
bool add_derivatives(const TracedDirection& traced, const Cancellation* cancel, std::vector<RrePoint>& points) {
  const auto by_cone = rre_derivatives(traced, cancel);
  if (!by_cone) return false;
  for (std::size_t cone = 0; cone < points.size(); ++cone) points[cone].derivatives = (*by_cone)[cone];
  return true;
}

std::string_view name_of(raytrace::MonteCarlo::Engine engine) {
  return engine == raytrace::MonteCarlo::Engine::cell ? "cell" : "embree";
}

/// Reports the share of finished wavelengths, whichever thread finishes one.
class Counter {
 public:
  Counter(Progress* progress, const std::vector<Direction>& directions) : progress_(progress) {
    for (const Direction& direction : directions) total_ += static_cast<double>(direction.spectral.size());
    if (progress_ != nullptr) progress_->at(0.0);
  }
  void finished() {
    const std::lock_guard lock(mutex_);
    if (progress_ != nullptr) progress_->at(++done_ / total_);
  }

 private:
  Progress* progress_;
  double total_ = 0.0;
  double done_ = 0.0;
  std::mutex mutex_;
};

}  // namespace

/// All directions of one design at all its wavelengths.
class DesignTracing {
 public:
  DesignTracing(const Design& design, const OpticalModel& model, const RreRequest& request, const Cancellation* cancel)
      : design_(design), model_(model), request_(request), cancel_(cancel), beams_(beam_policy(request)) {
    paths_.cutoff = request.cutoff.value_or(paths_.cutoff);
    if (design.balls()) return;
    if (!may_follow_beams(design, model, request)) return;
    beam_tracer_.emplace(model.part);
    if (!model.optics.is_smooth()) scattering_.emplace(model.part, beam_tracer_->centre_mm());
  }

  /// Whether directions are shared out among the threads; else each takes all of them.
  bool takes_several() const { return beam_tracer_.has_value(); }

  /// False if it was cancelled: an unfinished point is no point.
  bool trace(Direction& direction, std::size_t wavelength) {
    if (!beam_tracer_) return trace_rays(direction, wavelength);
    if (must_be_exact(request_)) return trace_beams(direction, wavelength);
    if (request_.engine == Engine::stochastic) return trace_stochastic(direction, wavelength);
    return trace_fastest(direction, wavelength);
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
    return cost.ns + cost.ns_per_facet * facets_of_cell();
  }

  double facets_of_cell() const {
    const geometry::SurfacePatch& patch = model_.part.patches.front();
    return static_cast<double>(patch.facets.size()) / static_cast<double>(patch.cells.size());
  }

  double looks_of_stochastic() const {
    const double looks =
        std::holds_alternative<geometry::RtpElement>(model_.part.spec.element) ? kLooksForPrisms : kLooksForCubes;
    return looks * std::max(1.0, std::pow(facets_of_cell() / kFewFacets, kGrowthWithFacets));
  }

  const raytrace::BackSurface* scattering() const { return scattering_ ? &*scattering_ : nullptr; }

  /// Made when it is first needed, by whichever thread needs it.
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

  bool trace_rays(Direction& direction, std::size_t wavelength) {
    const raytrace::Illumination illumination = illumination_of(direction.at, design_);
    const raytrace::Optics& optics = light(wavelength).optics;
    const raytrace::Sampling sampling = sampling_of(request_, light(wavelength).weight, wavelength);
    if (design_.balls())
      return keep(
          direction, wavelength,
          raytrace::BallTracer(*design_.balls()).trace(optics, illumination, cones(), sampling, paths_, cancel_),
          "balls");
    return keep(direction, wavelength, ray_tracer().trace(optics, illumination, cones(), sampling, paths_, cancel_),
                name_of(ray_engine()));
  }

  bool trace_beams(Direction& direction, std::size_t wavelength) {
    const raytrace::Illumination illumination = illumination_of(direction.at, design_);
    Collector collector(request_, model_, cones().size(), illumination);
    const raytrace::BeamResult traced =
        beam_tracer_->trace(light(wavelength).optics, illumination, cones(), beams_, cancel_, collector.observer());
    if (!keep(direction, wavelength, traced)) return false;
    collector.finish(direction);
    return !request_.derivatives || add_derivatives({design_, model_, *beam_tracer_, illumination, beams_, traced},
                                                    cancel_, direction.spectral[wavelength]);
  }

  bool keep(Direction& direction, std::size_t wavelength, const raytrace::StochasticBeams& traced) const {
    if (!keep(direction, wavelength, traced.result(), "stochastic")) return false;
    for (RrePoint& point : direction.spectral[wavelength]) point.beams = traced.beams();
    return true;
  }

  bool trace_stochastic(Direction& direction, std::size_t wavelength) {
    raytrace::StochasticBeams beams(*beam_tracer_, scattering(), light(wavelength).optics,
                                    illumination_of(direction.at, design_), cones(),
                                    sampling_of(request_, light(wavelength).weight, wavelength), cancel_);
    while (!beams.advance())
      ;
    return keep(direction, wavelength, beams);
  }

  /// By the engine that is expected to reach the goal first, round by round: each goes on where it was left when
  /// another turns out to be slower than expected.
  bool trace_fastest(Direction& direction, std::size_t wavelength) {
    const raytrace::Illumination illumination = illumination_of(direction.at, design_);
    const raytrace::Optics& optics = light(wavelength).optics;
    const raytrace::Sampling sampling = sampling_of(request_, light(wavelength).weight, wavelength);
    const double ns_per_segment = ns_of_segment();
    const double first_looks = looks_of_stochastic();
    std::optional<raytrace::BeamTrace> beams;
    if (optics.is_smooth()) beams.emplace(*beam_tracer_, optics, illumination, cones(), beams_);
    std::optional<raytrace::StochasticBeams> stochastic;
    bool stochastic_may_do = !request_.cutoff;
    std::optional<raytrace::MonteCarlo::Run> rays;
    for (;;) {
      const double beams_take = beams ? kNsPerLook * std::min(beams->expected_work(), beams->work() / kHedge) : kNever;
      const double rays_take = ns_per_segment * (rays ? rays->expected_segments() : kSegmentsOfFirstRound);
      const double stochastic_takes =
          !stochastic_may_do ? kNever : kNsPerStochasticLook * (stochastic ? stochastic->expected_work() : first_looks);
      if (beams_take <= std::min(rays_take, stochastic_takes)) {
        const double look = std::max(kFirstLook, 1.1 * beams->work());
        if (beams->advance(static_cast<std::uint64_t>(look), cancel_))
          return keep(direction, wavelength, beams->result());
      } else if (stochastic_takes <= rays_take) {
        if (!stochastic)
          stochastic.emplace(*beam_tracer_, scattering(), optics, illumination, cones(), sampling, cancel_);
        stochastic_may_do = !stochastic->advance();
        if (stochastic->result().reached_target) return keep(direction, wavelength, *stochastic);
      } else {
        if (!rays) rays.emplace(ray_tracer(), optics, illumination, cones(), sampling, paths_, cancel_);
        if (rays->advance()) return keep(direction, wavelength, rays->result(), name_of(ray_engine()));
      }
      if (is_cancelled(cancel_)) return false;
    }
  }

  const Design& design_;
  const OpticalModel& model_;
  const RreRequest& request_;
  const Cancellation* cancel_;
  raytrace::BeamPolicy beams_;
  raytrace::PathPolicy paths_;
  std::optional<raytrace::BeamTracer> beam_tracer_;  ///< none: rays alone
  std::optional<raytrace::BackSurface> scattering_;  ///< for what rough facets take from beams
  std::once_flag ray_tracer_is_made_;
  std::optional<raytrace::MonteCarlo> ray_tracer_;
};

bool may_follow_beams(const RreRequest& request) {
  const bool asks_for_rays = request.rays || request.sampling == raytrace::Sampling::Kind::plain;
  return request.engine == Engine::exact || request.engine == Engine::stochastic ||
         (request.engine == Engine::automatic && !asks_for_rays);
}

bool may_follow_beams(const Design& design, const OpticalModel& model, const RreRequest& request) {
  return may_follow_beams(request) && !design.balls() && !model.entrance &&
         raytrace::StochasticBeams::serves(model.optics);
}

bool must_be_exact(const RreRequest& request) {
  return request.engine == Engine::exact || asks_for_more(request);
}

DirectionTracing::DirectionTracing(const std::vector<Design>& designs, const std::vector<OpticalModel>& models,
                                   const RreRequest& request, const Cancellation* cancel)
    : designs_(designs), models_(models), request_(request), cancel_(cancel), tracings_(designs.size()) {}

DirectionTracing::~DirectionTracing() = default;

void DirectionTracing::trace(std::vector<Direction>& directions, Progress* progress) {
  Counter counter(progress, directions);
  for (auto first = directions.begin(); first != directions.end();) {
    const std::size_t d = first->at.design;
    const std::size_t wavelengths = models_[d].spectral.size();
    const auto last = std::find_if(first, directions.end(), [&](const Direction& at) { return at.at.design != d; });
    if (!tracings_[d]) tracings_[d] = std::make_unique<DesignTracing>(designs_[d], models_[d], request_, cancel_);
    DesignTracing& tracing = *tracings_[d];
    const auto trace_unit = [&](std::size_t k) {
      Direction& direction = first[static_cast<std::ptrdiff_t>(k / wavelengths)];
      const bool is_traced = tracing.trace(direction, k % wavelengths);
      if (is_traced) counter.finished();
      return is_traced;
    };
    const std::size_t units = static_cast<std::size_t>(last - first) * wavelengths;
    if (tracing.takes_several()) raytrace::for_each_in_parallel(units, trace_unit);
    for (std::size_t k = 0; !tracing.takes_several() && k < units; ++k)
      if (!trace_unit(k)) return;
    if (request_.incidence_spans.empty()) tracings_[d].reset();
    first = last;
  }
}

}  // namespace retrace::studies
