#include "studies/rre/rre.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>
#include <map>
#include <tuple>
#include <utility>

#include "core/error.h"
#include "core/number_format.h"
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
  raytrace::EngineFacts facts;
  facts.needs_plain_sampling = request.needs_plain_sampling();
  if (raytrace::obstacle_for(request.engine, facts))
    throw InputError(Field{"sampling"}, fmt::format("plain sampling requires {} montecarlo or embree, got {}", engine,
                                                    engine_name(request.engine)));
  for (const Field result : exact_results(request))
    if (!raytrace::may_be_exact(request.engine) || !may_use_beams(request))
      throw InputError(result, fmt::format("requires {} exact", engine));
}

/// Refuses derivatives for parts with individual facet planes or a mask. Derivatives rebuild the part with changed
/// sizes, but a table of facet planes or a mask does not change with the size.
void check_planes(const design::Design& design, const RreSettings& request) {
  if (request.derivatives && design.facet_planes())
    throw InputError(design.where("part.facets"), "not allowed together with " + reference({"derivatives"}));
  if (request.derivatives && design.mask())
    throw InputError(design.where("array.mask"), "not allowed together with " + reference({"derivatives"}));
}

/// Refuses results that are defined at a single wavelength for light with a spectrum. Averaging them over a spectrum is
/// meaningless.
void check_light(const design::Design& design, const design::OpticalModel& model, const RreSettings& request) {
  if (model.spectral.size() < 2) return;
  for (const Field result : exact_results(request))
    throw InputError(design.where("light.spectrum"),
                     fmt::format("{} requires a single wavelength, but this spectrum has {}: give light.wavelength_nm "
                                 "instead, or --set light.spectrum=[[{:.0f},1]]",
                                 reference(result), model.spectral.size(), model.wavelength_nm));
}

std::string missed_target_text(const design::Design& design, const RrePoint& at, const RreSettings& request) {
  return fmt::format("{}: the standard error at incidence {}, azimuth {} is above the target of {}",
                     design.source_name(), shortest(at.incidence_deg), shortest(at.azimuth_deg),
                     shortest(target_error_of(request)));
}

}  // namespace

double target_error_of(const RreSettings& request) {
  if (request.target_error) return *request.target_error;
  if (request.map) return kCurveTolerance;
  return request.incidence_spans.empty() ? kDefaultTargetError : 0.5 * kCurveTolerance;
}

namespace {

/// Refuses an engine that cannot trace a design.
void check_engine(const design::Design& design, const raytrace::EngineFacts& facts, raytrace::Engine engine,
                  const RreSettings& request) {
  using raytrace::Obstacle;
  const std::optional<Obstacle> obstacle = raytrace::obstacle_for(engine, facts);
  if (!obstacle) return;
  const std::string_view name = raytrace::engine_name(request.engine);
  const std::string source = design.source_name();
  const std::string option = reference({"engine"});
  const auto refused_beams = [&](std::string_view what) {
    const bool may_resample = !raytrace::obstacle_for(raytrace::Engine::stochastic, facts);
    return InputError(
        design::position_of(design, *obstacle),
        fmt::format("{} a beam into infinitely many directions: use {} {}montecarlo, without {}, {} and {}", what,
                    option, may_resample ? "stochastic or " : "", reference({"footprint"}), reference({"far_field"}),
                    reference({"derivatives"})));
  };
  switch (*obstacle) {
    case Obstacle::balls:
      throw InputError(Field{"engine"},
                       fmt::format("must be auto or montecarlo for element.kind = \"ball\", got {}", name));
    case Obstacle::plain_sampling:
      throw InputError(Field{"sampling"}, "must be stratified for element.kind = \"ball\", got plain");
    case Obstacle::curved_entrance:
      throw InputError(
          Field{"engine"},
          fmt::format(
              "the engine {} supports only plane entrance faces, but {} has an [entrance_surface]: use {} embree", name,
              source, option));
    case Obstacle::deflecting_shells:
      throw InputError(Field{"engine"},
                       fmt::format("the engine {} supports only plane-parallel shells, but a [[shell]] of {} changes "
                                   "the direction of light: use {} embree",
                                   name, source, option));
    case Obstacle::unequal_backs:
      throw InputError(Field{"engine"}, fmt::format("the engine {} requires the same medium behind all elements, but "
                                                    "{} has a [wet_back] behind some elements: use {} embree",
                                                    name, source, option));
    case Obstacle::unequal_cells:
      throw InputError(Field{"engine"},
                       fmt::format("the engine cell supports infinite arrays and large arrays of equal elements (more "
                                   "than two elements from every border), but {} has another array: use {} embree",
                                   source, option));
    case Obstacle::texture: throw refused_beams("rough facets scatter");
    case Obstacle::form: throw refused_beams("facets with a form deflect");
    case Obstacle::scattering_entrance: throw refused_beams("contaminated or rough entrance faces scatter");
    default:
      throw InputError(
          design::position_of(design, *obstacle),
          fmt::format("the engine {} cannot trace {}: use {} embree", name, raytrace::subject_of(*obstacle), option));
  }
}

/// Refuses results that the exact engine does not compute for a kind of designs.
void check_results(const design::Design& design, const raytrace::EngineFacts& facts, const RreSettings& request) {
  for (const Field result : exact_results(request)) {
    if (facts.has_balls)
      throw InputError(design.where("element.kind"),
                       "element.kind = \"ball\" is not supported by " + reference(result));
    if (facts.has_curved_entrance || facts.has_deflecting_shells || facts.has_unequal_backs)
      design::require_supported(design, {.what = reference(result), .solids = true});
  }
}

/// Returns the model of a design.
/// \throw InputError if the engine does not support its shape
design::OpticalModel model_of(const design::Design& design, const materials::MaterialLibrary& library,
                              const RreSettings& request) {
  const raytrace::EngineFacts facts = engine_facts(design, nullptr, request);
  check_engine(design, facts, request.engine, request);
  check_results(design, facts, request);
  return design.balls() ? design::make_light_model(design, library) : design::make_model(design, library);
}

}  // namespace

struct RreStudy::Prepared {
  std::vector<design::Design> designs;
  RreSettings request;
  std::vector<design::OpticalModel> models;
};

RreStudy::RreStudy(std::vector<design::Design> designs, RreSettings request) : prepared_(std::make_unique<Prepared>()) {
  check(request);
  const auto library = materials::MaterialLibrary::shipped();
  for (const design::Design& design : designs) {
    prepared_->models.push_back(model_of(design, library, request));
    check_light(design, prepared_->models.back(), request);
    check_planes(design, request);
    if (design.balls()) continue;
    if (request.derivatives) design::require_supported(design, {.what = reference({"derivatives"}), .shells = true});
    const raytrace::EngineFacts facts = engine_facts(design, &prepared_->models.back(), request);
    check_results(design, facts, request);
    check_engine(design, facts, must_be_exact(request) ? raytrace::Engine::exact : request.engine, request);
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
      {"power_truncated",
       fmt::format("{}: beams with {:.2g} % of the power are cut off at an incidence of {} degrees and an azimuth of "
                   "{} degrees; RRE may be too low by up to this amount. Reduce the cut-off to reduce this error",
                   result.designs[worst->design].source_name(), 100.0 * truncated(*worst),
                   shortest(worst->incidence_deg), shortest(worst->azimuth_deg))});
}

/// Points of one curve of RRE over incidence, by incidence.
using CurvePoints = std::map<double, const RrePoint*>;

/// Returns the point that deviates most from the straight line between its neighbours, and this deviation as a fraction
/// of the maximum of the curve. Twice the standard errors are subtracted from the deviation.
std::pair<double, const RrePoint*> largest_bend(const CurvePoints& curve) {
  double highest = 0.0;
  for (const auto& [incidence_deg, point] : curve) highest = std::max(highest, point->rre);
  std::pair<double, const RrePoint*> largest = {0.0, nullptr};
  if (curve.size() < 3 || highest <= 0.0) return largest;
  for (auto at = std::next(curve.begin()); std::next(at) != curve.end(); ++at) {
    const auto& [low_deg, low] = *std::prev(at);
    const auto& [high_deg, high] = *std::next(at);
    const double share = (at->first - low_deg) / (high_deg - low_deg);
    const double line = (1.0 - share) * low->rre + share * high->rre;
    const double std_error = std::hypot(at->second->std_error, (1.0 - share) * low->std_error, share * high->std_error);
    const double bend = (std::abs(at->second->rre - line) - 2.0 * std_error) / highest;
    if (bend > largest.first) largest = {bend, at->second};
  }
  return largest;
}

/// Returns true if the light that the entrance face reflects is within the acceptance cone. It causes a narrow peak
/// around normal incidence, which no list of angles resolves.
bool has_entrance_reflection(const RrePoint& point) {
  return std::abs(point.incidence_deg) <= 0.5 * point.acceptance_half_angle_deg;
}

/// Adds a warning if a list of incidences is too coarse for the curve of RRE. Lists of less than four angles are not
/// curves.
void warn_of_coarse_list(const RreSettings& request, RreResult& result) {
  constexpr std::size_t kShortestCurve = 4;
  constexpr double kAllowedBend = 0.03;
  const auto& angles = request.incidence_deg;
  if (!result.complete || request.map || !request.incidence_spans.empty() || angles.size() < kShortestCurve) return;
  std::map<std::tuple<std::size_t, double, double>, CurvePoints> curves;
  for (const RrePoint& p : result.points)
    if (!has_entrance_reflection(p))
      curves[{p.design, p.azimuth_deg, p.acceptance_half_angle_deg}].try_emplace(p.incidence_deg, &p);
  std::pair<double, const RrePoint*> worst = {kAllowedBend, nullptr};
  for (const auto& [key, curve] : curves)
    if (const auto bend = largest_bend(curve); bend.first > worst.first) worst = bend;
  if (worst.second == nullptr) return;
  const auto [low, high] = std::minmax_element(angles.begin(), angles.end());
  result.warnings.push_back(
      {"curve_coarse",
       fmt::format("{}: the angles of incidence do not resolve the curve: at incidence {}, azimuth {}, RRE deviates by "
                   "{:.2g} % of the maximum from the straight line between its neighbours; automatically chosen "
                   "angles resolve it ({}:{}:auto)",
                   result.designs[worst.second->design].source_name(), shortest(worst.second->incidence_deg),
                   shortest(worst.second->azimuth_deg), 100.0 * worst.first, shortest(*low), shortest(*high))});
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
  result.engine_requested = raytrace::engine_name(request.engine);
  result.seed = request.seed;
  result.has_map = request.map;
  for (const design::OpticalModel& model : models) result.light.push_back(model.spectral);
  for (const design::OpticalModel& model : models) append(result.warnings, model.warnings);
  return result;
}

void RreStudy::finish(RreResult& result) const {
  if (prepared_->request.footprint)
    for (const design::OpticalModel& model : prepared_->models) result.faces.push_back(entrance_face_of(model.part));
  result.engine = engine_of(result.points);
  warn_of_truncation(prepared_->request, result);
  warn_of_coarse_list(prepared_->request, result);
}

RreResult RreStudy::run(std::optional<std::size_t> design, Progress* progress, const Cancellation* cancel) const {
  const auto start = std::chrono::steady_clock::now();
  const auto& [designs, request, models] = *prepared_;
  RreResult result = begun();
  TracedRequest traced = trace_request(designs, models, request, design, progress, cancel);
  result.complete = traced.complete;
  result.traced_directions = traced.traced_directions;
  for (const std::string& text : traced.warnings) result.warnings.push_back({"curve_not_resolved", text});
  if (request.map && !traced.complete)
    result.warnings.push_back({"map_incomplete", "polar maps are left out, because not all directions are finished"});
  for (Direction& direction : traced.directions) {
    if (!direction.is_shared)
      for (const std::uint64_t rays : direction.rays) result.rays += rays;
    const bool missed_target = std::count(direction.missed_target.begin(), direction.missed_target.end(), 1) > 0;
    if (missed_target && !direction.is_shared)
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
