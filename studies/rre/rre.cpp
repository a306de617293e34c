#include "studies/rre/rre.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <mutex>
#include <utility>

#include "core/error.h"
#include "core/number_format.h"
#include "raytrace/beads/ball_tracer.h"
#include "raytrace/beam_tracer.h"
#include "raytrace/monte_carlo.h"
#include "raytrace/threads.h"
#include "studies/rre/spectral_mean.h"

namespace retrace::studies {
namespace {

constexpr std::array<std::pair<std::string_view, Engine>, 5> kEngines = {{{"auto", Engine::automatic},
                                                                          {"exact", Engine::exact},
                                                                          {"montecarlo", Engine::montecarlo},
                                                                          {"cell", Engine::cell},
                                                                          {"embree", Engine::embree}}};

// Beams of a direction up to which the choice is the exact engine: about a second.
constexpr std::uint64_t kBeamsOfAutomatic = 1'000'000;

/// Rays can only be asked of Monte Carlo.
bool may_be_exact(const RreRequest& request) {
  const bool asks_for_rays = request.rays || request.sampling == raytrace::Sampling::Kind::plain;
  return request.engine == Engine::exact || (request.engine == Engine::automatic && !asks_for_rays);
}

/// What only the exact engine can tell must not depend on how many beams that takes.
bool must_be_exact(const RreRequest& request) {
  return request.engine == Engine::exact || request.footprint || request.far_field || request.derivatives;
}

void check(const RreRequest& request) {
  if (request.sampling == raytrace::Sampling::Kind::plain)
    if (request.engine == Engine::cell || request.engine == Engine::exact)
      throw InputError({"", 0, "--sampling"},
                       fmt::format("plain needs --engine montecarlo or embree, got {}", engine_name(request.engine)));
  for (const auto& [asked, option] : {std::pair{request.footprint, "--footprint"},
                                      {request.far_field, "--far-field"},
                                      {request.derivatives, "--derivatives"}})
    if (asked && !may_be_exact(request)) throw InputError({"", 0, option}, "needs --engine exact");
  for (const double t : request.incidence_deg)
    if (!(std::abs(t) < 90.0))
      throw InputError({"", 0, "--incidence"}, fmt::format("must lie between -90 and 90 degrees, got {}", shortest(t)));
}

/// A slope asks for the part at neighbouring sizes, which planes of single facets do not say.
void check_planes(const Design& design, const RreRequest& request) {
  if (request.derivatives && design.facet_planes)
    throw InputError(design.facet_planes->location, "has no derivatives: leave out --derivatives");
  if (request.derivatives && design.mask)
    throw InputError(design.mask->location, "has no derivatives: leave out --derivatives");
}

/// A slope, a footprint or a far field is that of one wavelength: a mean of them over others would show none of them.
void check_light(const Design& design, const OpticalModel& model, const RreRequest& request) {
  if (model.spectral.size() < 2) return;
  for (const auto& [asked, option] : {std::pair{request.footprint, "--footprint"},
                                      {request.far_field, "--far-field"},
                                      {request.derivatives, "--derivatives"}})
    if (asked)
      throw InputError(design.spectrum->location,
                       fmt::format("{} takes one wavelength and this light has {}: give light.wavelength_nm instead, "
                                   "or --set light.spectrum=[[{:.0f},1]]",
                                   option, model.spectral.size(), model.wavelength_nm));
}

std::string missed_target(const Design& design, const RrePoint& at, const RreRequest& request) {
  return fmt::format("{}: the standard error at incidence {}, azimuth {} is above the target of {}",
                     design.source_name(), shortest(at.incidence_deg), shortest(at.azimuth_deg),
                     shortest(request.target_error));
}

}  // namespace

Engine engine_from_name(std::string_view name) {
  for (const auto& [known, engine] : kEngines)
    if (known == name) return engine;
  throw InputError({"", 0, "--engine"}, fmt::format("must be auto, exact, montecarlo, cell or embree, got {}", name));
}

raytrace::Sampling::Kind sampling_from_name(std::string_view name) {
  if (name == "stratified") return raytrace::Sampling::Kind::stratified;
  if (name == "plain") return raytrace::Sampling::Kind::plain;
  throw InputError({"", 0, "--sampling"}, fmt::format("must be stratified or plain, got {}", name));
}

std::string_view engine_name(Engine engine) {
  for (const auto& [name, known] : kEngines)
    if (known == engine) return name;
  return "";
}

namespace {

/// Beams and cells know plane entrance faces alone.
void check_front(const Design& design, const RreRequest& request) {
  if (!design.front) return;
  if (request.engine == Engine::exact || request.engine == Engine::cell)
    throw InputError({"", 0, "--engine"}, fmt::format("{} takes a plane entrance face alone, {} has a [front]: use "
                                                      "--engine embree",
                                                      engine_name(request.engine), design.source_name()));
  for (const auto& [asked, option] : {std::pair{request.footprint, "--footprint"},
                                      {request.far_field, "--far-field"},
                                      {request.derivatives, "--derivatives"}})
    if (asked) design.require_plane_front(option);
}

/// Balls have one engine of their own.
OpticalModel model_of(const Design& design, const materials::MaterialLibrary& library, const RreRequest& request) {
  if (!design.balls) {
    check_front(design, request);
    return make_model(design, library, Fronts::any);
  }
  if (request.engine != Engine::automatic && request.engine != Engine::montecarlo)
    throw InputError({"", 0, "--engine"},
                     fmt::format("must be auto or montecarlo for balls, got {}", engine_name(request.engine)));
  if (request.sampling == raytrace::Sampling::Kind::plain)
    throw InputError({"", 0, "--sampling"}, "must be stratified for balls, got plain");
  for (const auto& [asked, option] : {std::pair{request.footprint, "--footprint"},
                                      {request.far_field, "--far-field"},
                                      {request.derivatives, "--derivatives"}})
    if (asked) throw InputError(design.balls_location, fmt::format("balls have no {}", option));
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
    if (design.balls) continue;
    if (request.derivatives) design.require_elements("--derivatives");
    if (must_be_exact(request) && !prepared_->models.back().optics.is_smooth())
      throw InputError(design.texture.location,
                       "rough facets split a beam into infinitely many: use --engine montecarlo, without --footprint, "
                       "--far-field and --derivatives");
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

/// One direction of one design, and what was found there.
struct Direction {
  RrePoint at;
  std::vector<std::vector<RrePoint>> spectral;  ///< by wavelength and cone; those not traced yet are empty
  std::vector<RrePoint> points;                 ///< one a cone; empty until all wavelengths are traced
  std::optional<Footprint> footprint;
  std::optional<FarField> far_field;
};

std::vector<Direction> directions_of(const std::vector<OpticalModel>& models, const RreRequest& request) {
  std::vector<Direction> directions;
  for (std::size_t d = 0; d < models.size(); ++d)
    for (const double azimuth : request.azimuth_deg)
      for (const double incidence : request.incidence_deg) {
        RrePoint at;
        at.design = d;
        at.incidence_deg = incidence;
        at.azimuth_deg = azimuth;
        at.wavelength_nm = models[d].wavelength_nm;
        Direction direction;
        direction.at = at;
        direction.spectral.resize(models[d].spectral.size());
        directions.push_back(std::move(direction));
      }
  return directions;
}

raytrace::Illumination illumination_of(const RrePoint& at, const Design& design) {
  return {Angle::from_deg(at.incidence_deg), Angle::from_deg(at.azimuth_deg), design.polarisation};
}

/// Reports the share of finished directions, whichever thread finishes one.
class Counter {
 public:
  Counter(Progress* progress, std::size_t total) : progress_(progress), total_(static_cast<double>(total)) {
    if (progress_ != nullptr) progress_->at(0.0);
  }
  void finished() {
    const std::lock_guard lock(mutex_);
    if (progress_ != nullptr) progress_->at(++done_ / total_);
  }

 private:
  Progress* progress_;
  double total_;
  double done_ = 0.0;
  std::mutex mutex_;
};

/// Says so if a cut-off took more than shows in a table.
void warn_of_truncation(RreResult& result) {
  constexpr double kShows = 1e-6;
  const auto truncated = [](const RrePoint& p) { return p.ledger[raytrace::Account::truncated]; };
  const auto worst =
      std::max_element(result.points.begin(), result.points.end(),
                       [&](const RrePoint& a, const RrePoint& b) { return truncated(a) < truncated(b); });
  if (worst == result.points.end() || truncated(*worst) <= kShows) return;
  result.warnings.push_back(fmt::format(
      "{}: {:.2g} % of the power is cut off at incidence {}, azimuth {}, and RRE up to that much too low; a smaller "
      "--cutoff follows more",
      result.designs[worst->design].source_name(), 100.0 * truncated(*worst), shortest(worst->incidence_deg),
      shortest(worst->azimuth_deg)));
}

/// Each wavelength of a direction by itself.
struct Unit {
  std::size_t direction = 0;
  std::size_t wavelength = 0;
};

std::vector<Unit> units_of(const std::vector<Direction>& directions) {
  std::vector<Unit> units;
  for (std::size_t d = 0; d < directions.size(); ++d)
    for (std::size_t w = 0; w < directions[d].spectral.size(); ++w) units.push_back({d, w});
  return units;
}

/// Makes points of a direction whose wavelengths are all traced.
void finish(Direction& direction, const Design& design, const OpticalModel& model) {
  const auto& spectral = direction.spectral;
  if (std::any_of(spectral.begin(), spectral.end(), [](const auto& cones) { return cones.empty(); })) return;
  if (!design.spectrum) {
    direction.points = spectral.front();
    return;
  }
  for (std::size_t cone = 0; cone < spectral.front().size(); ++cone) {
    RrePoint at = direction.at;
    at.acceptance_half_angle_deg = spectral.front()[cone].acceptance_half_angle_deg;
    std::vector<SpectralPoint> points;
    for (std::size_t w = 0; w < spectral.size(); ++w) points.push_back({model.spectral[w].weight, spectral[w][cone]});
    direction.points.push_back(spectral_mean(at, points));
    direction.points.back().derivatives = spectral.front()[cone].derivatives;
  }
}

/// The sampling of one wavelength. Rays are shared in proportion to the weights w: variances v / (w N) of the estimates
/// then make w^2 v / (w N) each and v / N in all, as if all N rays were of one wavelength. A target t becomes
/// t / sqrt(w) in the same way. Seeds differ, so that the estimates are independent; the first is the one asked for.
raytrace::Sampling sampling_of(const RreRequest& request, double weight, std::size_t wavelength) {
  constexpr std::uint32_t kGolden = 0x9e3779b9U;  // odd: no two wavelengths share a seed
  raytrace::Sampling sampling;
  sampling.kind = request.sampling;
  sampling.seed = request.seed + kGolden * static_cast<std::uint32_t>(wavelength);
  sampling.target_error = request.target_error / std::sqrt(weight);
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
RrePoint spectral_point(const Direction& direction, const SpectralOptics& light) {
  RrePoint at = direction.at;
  at.wavelength_nm = light.wavelength_nm;
  return at;
}

raytrace::MonteCarlo::Engine engine_for(const OpticalModel& model, const RreRequest& request) {
  using raytrace::MonteCarlo;
  const bool may_be_cell =
      !model.front && request.engine != Engine::embree && request.sampling == raytrace::Sampling::Kind::stratified;
  return may_be_cell && MonteCarlo::cell_serves(model.part) ? MonteCarlo::Engine::cell : MonteCarlo::Engine::embree;
}

bool is_ball(const Design& design) {
  return design.balls.has_value();
}

/// The engine that Monte Carlo takes, one for all designs or several.
std::string monte_carlo_name(const std::vector<Design>& designs, const std::vector<OpticalModel>& models,
                             const RreRequest& request) {
  if (std::all_of(designs.begin(), designs.end(), is_ball)) return "balls";
  if (std::any_of(designs.begin(), designs.end(), is_ball)) return "montecarlo";
  const auto is_cell = [&](const OpticalModel& model) {
    return engine_for(model, request) == raytrace::MonteCarlo::Engine::cell;
  };
  if (std::all_of(models.begin(), models.end(), is_cell)) return "cell";
  return std::none_of(models.begin(), models.end(), is_cell) ? "embree" : "montecarlo";
}

/// Directions and wavelengths one after the other, each on all threads.
void trace_by_monte_carlo(const std::vector<Design>& designs, const std::vector<OpticalModel>& models,
                          const RreRequest& request, std::vector<Direction>& directions, Progress* progress,
                          const Cancellation* cancel, RreResult& result) {
  const std::vector<Unit> units = units_of(directions);
  Counter counter(progress, units.size());
  raytrace::PathPolicy policy;
  policy.cutoff = request.cutoff.value_or(policy.cutoff);
  std::optional<raytrace::MonteCarlo> tracer;
  std::size_t traced_design = designs.size();
  bool reached_target = true;
  for (const auto& [d, w] : units) {
    Direction& direction = directions[d];
    const Design& design = designs[direction.at.design];
    const OpticalModel& model = models[direction.at.design];
    const SpectralOptics& light = model.spectral[w];
    if (direction.at.design != traced_design && !design.balls)
      tracer.emplace(model.part, engine_for(model, request), model.front ? &*model.front : nullptr);
    traced_design = direction.at.design;
    const raytrace::Illumination illumination = illumination_of(direction.at, design);
    const raytrace::Sampling sampling = sampling_of(request, light.weight, w);
    const std::vector<double>& cones = design.acceptance_half_angle_deg;
    const raytrace::MonteCarloResult traced =
        design.balls
            ? raytrace::BallTracer(*design.balls).trace(light.optics, illumination, cones, sampling, policy, cancel)
            : tracer->trace(light.optics, illumination, cones, sampling, policy, cancel);
    if (!traced.complete) return;  // an unfinished point is no point
    direction.spectral[w] = points_of(spectral_point(direction, light), traced);
    result.rays += traced.rays;
    reached_target = (w == 0 || reached_target) && traced.reached_target;
    if (w + 1 == direction.spectral.size() && !reached_target)
      result.warnings.push_back(missed_target(design, direction.at, request));
    counter.finished();
  }
}

/// Gathers the returned beams of one direction, as far as they were asked for.
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

/// Several directions and wavelengths at a time, each on one thread but for its derivatives.
void trace_exactly(const std::vector<Design>& designs, const std::vector<OpticalModel>& models,
                   const RreRequest& request, std::vector<Direction>& directions, Progress* progress,
                   const Cancellation* cancel) {
  const std::vector<Unit> units = units_of(directions);
  Counter counter(progress, units.size());
  raytrace::BeamPolicy policy;
  policy.cutoff = request.cutoff;
  if (!must_be_exact(request)) policy.max_beams = kBeamsOfAutomatic;
  std::vector<raytrace::BeamTracer> tracers;
  for (const OpticalModel& model : models) tracers.emplace_back(model.part);
  raytrace::for_each_in_parallel(units.size(), [&](std::size_t k) {
    Direction& direction = directions[units[k].direction];
    const std::size_t d = direction.at.design;
    const SpectralOptics& light = models[d].spectral[units[k].wavelength];
    const std::vector<double>& cones = designs[d].acceptance_half_angle_deg;
    const raytrace::Illumination illumination = illumination_of(direction.at, designs[d]);
    Collector collector(request, models[d], cones.size(), illumination);
    const raytrace::BeamResult traced =
        tracers[d].trace(light.optics, illumination, cones, policy, cancel, collector.observer());
    if (!traced.complete) return;
    collector.finish(direction);
    std::vector<RrePoint> points = points_of(spectral_point(direction, light), cones, traced);
    if (request.derivatives &&
        !add_derivatives({designs[d], models[d], tracers[d], illumination, policy, traced}, cancel, points))
      return;
    direction.spectral[units[k].wavelength] = std::move(points);
    counter.finished();
  });
}

/// Leaves the directions as they were and returns false if the engine may be chosen and too many beams are needed.
bool trace_exactly_if_cheap(const std::vector<Design>& designs, const std::vector<OpticalModel>& models,
                            const RreRequest& request, std::vector<Direction>& directions, Progress* progress,
                            const Cancellation* cancel) {
  const bool all_smooth = std::all_of(models.begin(), models.end(), [](const auto& m) { return m.optics.is_smooth(); });
  const bool has_balls = std::any_of(designs.begin(), designs.end(), is_ball);
  const bool has_fronts = std::any_of(models.begin(), models.end(), [](const auto& m) { return m.front.has_value(); });
  if (!may_be_exact(request) || !all_smooth || has_balls || has_fronts) return false;
  try {
    trace_exactly(designs, models, request, directions, progress, cancel);
    return true;
  } catch (const BudgetError&) {
    if (must_be_exact(request)) throw;
    directions = directions_of(models, request);
    return false;
  }
}

}  // namespace

RreResult RreStudy::run(Progress* progress, const Cancellation* cancel) const {
  const auto start = std::chrono::steady_clock::now();
  const auto& [designs, request, models] = *prepared_;
  RreResult result;
  result.designs = designs;
  result.engine_requested = engine_name(request.engine);
  result.seed = request.seed;
  for (const OpticalModel& model : models) result.light.push_back(model.spectral);
  for (const OpticalModel& model : models)
    result.warnings.insert(result.warnings.end(), model.warnings.begin(), model.warnings.end());

  std::vector<Direction> directions = directions_of(models, request);
  const bool exact = trace_exactly_if_cheap(designs, models, request, directions, progress, cancel);
  if (!exact) trace_by_monte_carlo(designs, models, request, directions, progress, cancel, result);
  result.engine = exact ? "exact" : monte_carlo_name(designs, models, request);
  for (Direction& direction : directions) {
    finish(direction, designs[direction.at.design], models[direction.at.design]);
    result.complete = result.complete && !direction.points.empty();
    result.points.insert(result.points.end(), direction.points.begin(), direction.points.end());
    if (!direction.points.empty() && (direction.footprint || direction.far_field))
      result.returned.push_back(
          {direction.points.back(), std::move(direction.footprint), std::move(direction.far_field)});
  }
  if (request.footprint)
    for (const OpticalModel& model : models) result.faces.push_back(entrance_face_of(model.part));
  warn_of_truncation(result);
  result.elapsed_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

}  // namespace retrace::studies
