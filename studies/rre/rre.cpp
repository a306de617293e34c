#include "studies/rre/rre.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "core/error.h"
#include "core/number_format.h"
#include "raytrace/exact/stochastic_beams.h"
#include "raytrace/paths/monte_carlo.h"
#include "studies/design/request_limits.h"
#include "studies/rre/request_tracing.h"
#include "studies/rre/tracing.h"

namespace retrace::studies {
namespace {

void check_incidence(double deg) {
  if (!(std::abs(deg) < 90.0))
    throw InputError({"", 0, "--incidence"}, fmt::format("must lie between -90 and 90 degrees, got {}", shortest(deg)));
}

void check(const RreRequest& request) {
  if (request.sampling == raytrace::Sampling::Kind::plain)
    if (request.engine != Engine::automatic && request.engine != Engine::montecarlo && request.engine != Engine::embree)
      throw InputError({"", 0, "--sampling"},
                       fmt::format("plain needs --engine montecarlo or embree, got {}", engine_name(request.engine)));
  for (const auto& [asked, option] : {std::pair{request.footprint, "--footprint"},
                                      {request.far_field, "--far-field"},
                                      {request.derivatives, "--derivatives"}}) {
    check_has_effect(option, asked, request.engine, kExactEngines);
    if (asked && !may_follow_beams(request)) throw InputError({"", 0, option}, "needs --engine exact");
  }
  check_has_effect("--samples", request.rays.has_value(), request.engine, kRayEngines);
  check_has_effect("--cutoff", request.cutoff.has_value(), request.engine, kCutoffEngines);
  if (request.target_error && request.rays) throw InputError({"", 0, "--target-error"}, "not together with --samples");
  if (request.target_error && request.cutoff && must_be_exact(request))
    throw InputError({"", 0, "--target-error"}, "not together with --cutoff where only the exact engine is used");
  if (request.target_error) check_share(*request.target_error, false, "--target-error");
  if (request.cutoff) check_share(*request.cutoff, true, "--cutoff");
  if (request.rays) check_rays(*request.rays);
  for (const double p : request.azimuth_deg) check_azimuth(p);
  for (const double t : request.incidence_deg) check_incidence(t);
  for (const CurveSpan& span : request.incidence_spans) {
    check_incidence(span.low);
    check_incidence(span.high);
    if (!(span.low < span.high))
      throw InputError({"", 0, "--incidence"}, fmt::format("a range must have start < stop, got {} and {}",
                                                           shortest(span.low), shortest(span.high)));
  }
}

/// Refuses derivatives for parts with individual facet planes or a mask. Derivatives rebuild the part with changed
/// sizes, but a table of facet planes or a mask does not change with the size.
void check_planes(const Design& design, const RreRequest& request) {
  if (request.derivatives && design.facet_planes())
    throw InputError(design.where("part.facets"), "has no derivatives: leave out --derivatives");
  if (request.derivatives && design.mask())
    throw InputError(design.where("array.mask"), "has no derivatives: leave out --derivatives");
}

/// Refuses results that are defined at a single wavelength for light with a spectrum. Averaging them over a spectrum is
/// meaningless.
void check_light(const Design& design, const OpticalModel& model, const RreRequest& request) {
  if (model.spectral.size() < 2) return;
  for (const auto& [asked, option] : {std::pair{request.footprint, "--footprint"},
                                      {request.far_field, "--far-field"},
                                      {request.derivatives, "--derivatives"}})
    if (asked)
      throw InputError(design.where("light.spectrum"),
                       fmt::format("{} takes one wavelength and this light has {}: give light.wavelength_nm instead, "
                                   "or --set light.spectrum=[[{:.0f},1]]",
                                   option, model.spectral.size(), model.wavelength_nm));
}

std::string missed_target_text(const Design& design, const RrePoint& at, const RreRequest& request) {
  return fmt::format("{}: the standard error at incidence {}, azimuth {} is above the target of {}",
                     design.source_name(), shortest(at.incidence_deg), shortest(at.azimuth_deg),
                     shortest(target_error_of(request)));
}

}  // namespace

double target_error_of(const RreRequest& request) {
  return request.target_error.value_or(request.incidence_spans.empty() ? kUsualTargetError : 0.5 * kCurveTolerance);
}

namespace {

/// Refuses engines that support only plane entrance faces if the design has a curved one.
void check_entrance(const Design& design, const RreRequest& request) {
  if (!design.entrance) return;
  if (request.engine == Engine::exact || request.engine == Engine::stochastic || request.engine == Engine::cell)
    throw InputError({"", 0, "--engine"}, fmt::format("{} takes a plane entrance face alone, {} has a [front]: use "
                                                      "--engine embree",
                                                      engine_name(request.engine), design.source_name()));
  for (const auto& [asked, option] : {std::pair{request.footprint, "--footprint"},
                                      {request.far_field, "--far-field"},
                                      {request.derivatives, "--derivatives"}})
    if (asked) check_taken(design, {.what = option, .solids = true});
}

/// Refuses results and engines that require the same medium behind all elements.
void check_backs(const Design& design, const OpticalModel& model, const RreRequest& request) {
  if (model.optics.has_one_back()) return;
  for (const auto& [asked, option] : {std::pair{request.footprint, "--footprint"},
                                      {request.far_field, "--far-field"},
                                      {request.derivatives, "--derivatives"}})
    if (asked) check_taken(design, {.what = option, .solids = true});
  if (request.engine == Engine::exact || request.engine == Engine::stochastic || request.engine == Engine::cell)
    throw InputError({"", 0, "--engine"}, fmt::format("{} takes backs that are all alike, {} has a [wet_back] behind "
                                                      "some elements: use --engine embree",
                                                      engine_name(request.engine), design.source_name()));
}

/// Refuses engines that trace beams if facets or the entrance face split or bend beams. Stochastic beams are allowed if
/// some of the light stays specular.
void check_beams(const Design& design, const raytrace::Optics& optics, Engine engine) {
  const bool may_resample = raytrace::StochasticBeams::serves(optics);
  if (engine == Engine::stochastic ? may_resample : optics.keeps_beams()) return;
  const auto refused = [&](const InputLocation& where, std::string_view what) {
    return InputError(where, fmt::format("{} a beam into infinitely many: use --engine {}montecarlo, without "
                                         "--footprint, --far-field and --derivatives",
                                         what, may_resample ? "stochastic or " : ""));
  };
  if (!optics.has_plane_facets())
    throw refused(design.where_facets(), optics.is_smooth() ? "facets with a form bend" : "rough facets split");
  throw refused(design.where_entrance_scatters(), "entrance faces that scatter split");
}

/// Returns the model of a design. Balls have their own tracer. Therefore most options are refused for them.
OpticalModel model_of(const Design& design, const materials::MaterialLibrary& library, const RreRequest& request) {
  if (!design.balls()) {
    check_entrance(design, request);
    return make_model(design, library, Entrances::any);
  }
  if (request.engine != Engine::automatic && request.engine != Engine::montecarlo)
    throw InputError({"", 0, "--engine"},
                     fmt::format("must be auto or montecarlo for balls, got {}", engine_name(request.engine)));
  if (request.sampling == raytrace::Sampling::Kind::plain)
    throw InputError({"", 0, "--sampling"}, "must be stratified for balls, got plain");
  for (const auto& [asked, option] : {std::pair{request.footprint, "--footprint"},
                                      {request.far_field, "--far-field"},
                                      {request.derivatives, "--derivatives"}})
    if (asked) throw InputError(design.where("element.kind"), fmt::format("balls have no {}", option));
  return make_light_model(design, library);
}

}  // namespace

struct RreStudy::Prepared {
  std::vector<Design> designs;
  RreRequest request;
  std::vector<OpticalModel> models;
};

RreStudy::RreStudy(std::vector<Design> designs, RreRequest request) : prepared_(std::make_unique<Prepared>()) {
  check(request);
  const auto library = materials::MaterialLibrary::shipped();
  for (const Design& design : designs) {
    prepared_->models.push_back(model_of(design, library, request));
    check_light(design, prepared_->models.back(), request);
    check_planes(design, request);
    if (design.balls()) continue;
    if (request.derivatives) check_taken(design, {.what = "--derivatives"});
    check_backs(design, prepared_->models.back(), request);
    if (must_be_exact(request) || request.engine == Engine::stochastic)
      check_beams(design, prepared_->models.back().optics, request.engine);
    if (request.engine == Engine::cell && !raytrace::MonteCarlo::cell_serves(prepared_->models.back().part))
      throw InputError({"", 0, "--engine"},
                       fmt::format("cell takes endless arrays, and arrays of equal elements that reach more than two "
                                   "elements from every border; {} is neither: use --engine embree",
                                   design.source_name()));
  }
  prepared_->designs = std::move(designs);
  prepared_->request = std::move(request);
}

RreStudy::~RreStudy() = default;

namespace {

/// Adds a warning if more power was truncated than the target error allows. If the request gives a cut-off power, the
/// limit is 1e-6, because tables show no smaller changes.
void warn_of_truncation(const RreRequest& request, RreResult& result) {
  constexpr double kShows = 1e-6;
  const double allowed = request.cutoff ? kShows : std::max(kShows, target_error_of(request));
  const auto truncated = [](const RrePoint& p) { return p.ledger[raytrace::Account::truncated]; };
  const auto worst =
      std::max_element(result.points.begin(), result.points.end(),
                       [&](const RrePoint& a, const RrePoint& b) { return truncated(a) < truncated(b); });
  if (worst == result.points.end() || truncated(*worst) <= allowed) return;
  result.warnings.push_back(
      {"power_truncated", fmt::format("{}: {:.2g} % of the power is cut off at incidence {}, azimuth {}, so that RRE "
                                      "may be too low by up to this amount; a smaller "
                                      "--cutoff reduces the error",
                                      result.designs[worst->design].source_name(), 100.0 * truncated(*worst),
                                      shortest(worst->incidence_deg), shortest(worst->azimuth_deg))});
}

/// Returns the engine of all points. If points have different engines, returns `montecarlo` if all engines trace rays,
/// otherwise `mixed`.
std::string engine_of(const std::vector<RrePoint>& points) {
  const auto all = [&](const auto& fits) { return std::all_of(points.begin(), points.end(), fits); };
  if (points.empty()) return "none";
  if (all([&](const RrePoint& p) { return p.engine == points.front().engine; })) return points.front().engine;
  const bool all_are_of_rays = all(
      [](const RrePoint& p) { return p.engine != "exact" && p.engine != "stochastic" && p.engine != kMixedEngines; });
  return all_are_of_rays ? "montecarlo" : std::string(kMixedEngines);
}

}  // namespace

RreResult RreStudy::begun() const {
  const auto& [designs, request, models] = *prepared_;
  RreResult result;
  result.designs = designs;
  result.engine_requested = engine_name(request.engine);
  result.seed = request.seed;
  for (const OpticalModel& model : models) result.light.push_back(model.spectral);
  for (const OpticalModel& model : models)
    result.warnings.insert(result.warnings.end(), model.warnings.begin(), model.warnings.end());
  return result;
}

void RreStudy::finish(RreResult& result) const {
  if (prepared_->request.footprint)
    for (const OpticalModel& model : prepared_->models) result.faces.push_back(entrance_face_of(model.part));
  result.engine = engine_of(result.points);
  warn_of_truncation(prepared_->request, result);
}

RreResult RreStudy::run(std::optional<std::size_t> design, Progress* progress, const Cancellation* cancel) const {
  const auto start = std::chrono::steady_clock::now();
  const auto& [designs, request, models] = *prepared_;
  RreResult result = begun();
  TracedRequest traced = trace_request(designs, models, request, design, progress, cancel);
  result.complete = traced.complete;
  if (!traced.warning.empty()) result.warnings.push_back({"curve_not_resolved", traced.warning});
  for (Direction& direction : traced.directions) {
    for (const std::uint64_t rays : direction.rays) result.rays += rays;
    const bool missed_target = std::count(direction.missed_target.begin(), direction.missed_target.end(), 1) > 0;
    if (missed_target)
      result.warnings.push_back(
          {"target_missed", missed_target_text(designs[direction.at.design], direction.at, request)});
    for (RrePoint& point : direction.points) point.missed_target = missed_target;
    result.points.insert(result.points.end(), direction.points.begin(), direction.points.end());
    if (!direction.points.empty() && (direction.footprint || direction.far_field))
      result.returned.push_back(
          {direction.points.back(), std::move(direction.footprint), std::move(direction.far_field)});
  }
  finish(result);
  result.elapsed_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

RreResult RreStudy::run(Progress* progress, const Cancellation* cancel) const {
  return run(std::nullopt, progress, cancel);
}

RreResult RreStudy::run_design(std::size_t design, const Cancellation* cancel) const {
  return run(design, nullptr, cancel);
}

RreResult RreStudy::result_of(std::vector<RrePoint> points) const {
  RreResult result = begun();
  for (const RrePoint& point : points)
    if (point.missed_target)
      result.warnings.push_back(
          {"target_missed", missed_target_text(result.designs[point.design], point, prepared_->request)});
  result.points = std::move(points);
  finish(result);
  return result;
}

}  // namespace retrace::studies
