#include "studies/rre/rre.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "core/error.h"
#include "core/number_format.h"
#include "raytrace/exact/stochastic_beams.h"
#include "raytrace/paths/monte_carlo.h"
#include "studies/rre/request_tracing.h"
#include "studies/rre/tracing.h"

namespace retrace::studies {
namespace {

/// Returns the fields of those requested results that only the exact engine can compute.
std::vector<Field> exact_results(const RreSettings& request) {
  std::vector<Field> fields;
  if (request.footprint) fields.push_back({"footprint"});
  if (request.far_field) fields.push_back({"far_field"});
  if (request.derivatives) fields.push_back({"derivatives"});
  return fields;
}

/// Checks that the engine supports the requested sampling and the requested results.
/// \throw InputError at the field that needs another engine
void check(const RreSettings& request) {
  const std::string engine = reference({"engine"});
  if (request.sampling == raytrace::Sampling::Kind::plain && !is_one_of(request.engine, kRayEnginesOfParts))
    throw InputError(Field{"sampling"},
                     fmt::format("plain needs {} montecarlo or embree, got {}", engine, engine_name(request.engine)));
  for (const Field result : exact_results(request))
    if (!is_one_of(request.engine, kExactEngines) || !may_follow_beams(request))
      throw InputError(result, fmt::format("needs {} exact", engine));
}

/// Refuses derivatives for parts with individual facet planes or a mask. Derivatives rebuild the part with changed
/// sizes, but a table of facet planes or a mask does not change with the size.
void check_planes(const Design& design, const RreSettings& request) {
  if (request.derivatives && design.facet_planes())
    throw InputError(design.where("part.facets"), "has no derivatives: leave out " + reference({"derivatives"}));
  if (request.derivatives && design.mask())
    throw InputError(design.where("array.mask"), "has no derivatives: leave out " + reference({"derivatives"}));
}

/// Refuses results that are defined at a single wavelength for light with a spectrum. Averaging them over a spectrum is
/// meaningless.
void check_light(const Design& design, const OpticalModel& model, const RreSettings& request) {
  if (model.spectral.size() < 2) return;
  for (const Field result : exact_results(request))
    throw InputError(design.where("light.spectrum"),
                     fmt::format("{} takes one wavelength and this light has {}: give light.wavelength_nm instead, "
                                 "or --set light.spectrum=[[{:.0f},1]]",
                                 reference(result), model.spectral.size(), model.wavelength_nm));
}

std::string missed_target_text(const Design& design, const RrePoint& at, const RreSettings& request) {
  return fmt::format("{}: the standard error at incidence {}, azimuth {} is above the target of {}",
                     design.source_name(), shortest(at.incidence_deg), shortest(at.azimuth_deg),
                     shortest(target_error_of(request)));
}

}  // namespace

double target_error_of(const RreSettings& request) {
  return request.target_error.value_or(request.incidence_spans.empty() ? kUsualTargetError : 0.5 * kCurveTolerance);
}

namespace {

/// Refuses engines that support only plane entrance faces if the design has a curved one.
void check_entrance(const Design& design, const RreSettings& request) {
  if (!design.entrance) return;
  if (request.engine == Engine::exact || request.engine == Engine::stochastic || request.engine == Engine::cell)
    throw InputError(Field{"engine"},
                     fmt::format("{} supports only plane entrance faces, but {} has a [front]: use {} embree",
                                 engine_name(request.engine), design.source_name(), reference({"engine"})));
  for (const Field result : exact_results(request)) check_taken(design, {.what = reference(result), .solids = true});
}

/// Refuses results and engines that require the same medium behind all elements.
void check_backs(const Design& design, const OpticalModel& model, const RreSettings& request) {
  if (model.optics.has_one_back()) return;
  for (const Field result : exact_results(request)) check_taken(design, {.what = reference(result), .solids = true});
  if (request.engine == Engine::exact || request.engine == Engine::stochastic || request.engine == Engine::cell)
    throw InputError(
        Field{"engine"},
        fmt::format("{} takes backs that are all alike, {} has a [wet_back] behind some elements: use {} embree",
                    engine_name(request.engine), design.source_name(), reference({"engine"})));
}

/// Refuses engines that trace beams if facets or the entrance face split or bend beams. Stochastic beams are allowed if
/// some of the light stays specular.
void check_beams(const Design& design, const raytrace::Optics& optics, Engine engine) {
  const bool may_resample = raytrace::StochasticBeams::serves(optics);
  if (engine == Engine::stochastic ? may_resample : optics.keeps_beams()) return;
  const auto refused = [&](const InputLocation& where, std::string_view what) {
    return InputError(where,
                      fmt::format("{} a beam into infinitely many: use {} {}montecarlo, without {}, {} and {}", what,
                                  reference({"engine"}), may_resample ? "stochastic or " : "", reference({"footprint"}),
                                  reference({"far_field"}), reference({"derivatives"})));
  };
  if (!optics.has_plane_facets())
    throw refused(design.where_facets(), optics.is_smooth() ? "facets with a form bend" : "rough facets split");
  throw refused(design.where_entrance_scatters(), "entrance faces that scatter split");
}

/// Returns the model of a design. Balls have their own tracer. Therefore most options are refused for them.
OpticalModel model_of(const Design& design, const materials::MaterialLibrary& library, const RreSettings& request) {
  if (!design.balls()) {
    check_entrance(design, request);
    return make_model(design, library, Entrances::any);
  }
  if (request.engine != Engine::automatic && request.engine != Engine::montecarlo)
    throw InputError(Field{"engine"},
                     fmt::format("must be auto or montecarlo for balls, got {}", engine_name(request.engine)));
  if (request.sampling == raytrace::Sampling::Kind::plain)
    throw InputError(Field{"sampling"}, "must be stratified for balls, got plain");
  for (const Field result : exact_results(request))
    throw InputError(design.where("element.kind"), "balls have no " + reference(result));
  return make_light_model(design, library);
}

}  // namespace

struct RreStudy::Prepared {
  std::vector<Design> designs;
  RreSettings request;
  std::vector<OpticalModel> models;
};

RreStudy::RreStudy(std::vector<Design> designs, RreSettings request) : prepared_(std::make_unique<Prepared>()) {
  check(request);
  const auto library = materials::MaterialLibrary::shipped();
  for (const Design& design : designs) {
    prepared_->models.push_back(model_of(design, library, request));
    check_light(design, prepared_->models.back(), request);
    check_planes(design, request);
    if (design.balls()) continue;
    if (request.derivatives) check_taken(design, {.what = reference({"derivatives"})});
    check_backs(design, prepared_->models.back(), request);
    if (must_be_exact(request) || request.engine == Engine::stochastic)
      check_beams(design, prepared_->models.back().optics, request.engine);
    if (request.engine == Engine::cell && !raytrace::MonteCarlo::cell_serves(prepared_->models.back().part))
      throw InputError(Field{"engine"},
                       fmt::format("cell takes endless arrays, and arrays of equal elements that reach more than two "
                                   "elements from every border; {} is neither: use {} embree",
                                   design.source_name(), reference({"engine"})));
  }
  prepared_->designs = std::move(designs);
  prepared_->request = std::move(request);
}

RreStudy::~RreStudy() = default;

namespace {

/// Adds a warning if more power was truncated than the target error allows. If the request gives a cut-off power, the
/// limit is 1e-6, because tables show no smaller changes.
void warn_of_truncation(const RreSettings& request, RreResult& result) {
  constexpr double kShows = 1e-6;
  const double allowed = request.cutoff ? kShows : std::max(kShows, target_error_of(request));
  const auto truncated = [](const RrePoint& p) { return p.ledger[raytrace::Account::truncated]; };
  const auto worst =
      std::max_element(result.points.begin(), result.points.end(),
                       [&](const RrePoint& a, const RrePoint& b) { return truncated(a) < truncated(b); });
  if (worst == result.points.end() || truncated(*worst) <= allowed) return;
  result.warnings.push_back(
      {"power_truncated", fmt::format("{}: {:.2g} % of the power is cut off at incidence {}, azimuth {}, so that RRE "
                                      "may be too low by up to this amount; a smaller cut-off reduces the error",
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
