#include "studies/rre/rre.h"

#include <fmt/format.h>

#include <array>
#include <chrono>
#include <cmath>
#include <utility>

#include "core/error.h"
#include "core/number_format.h"
#include "raytrace/monte_carlo.h"
#include "studies/design/optical_model.h"

namespace retrace::studies {
namespace {

constexpr std::array<std::pair<std::string_view, Engine>, 5> kEngines = {{{"auto", Engine::automatic},
                                                                          {"exact", Engine::exact},
                                                                          {"montecarlo", Engine::montecarlo},
                                                                          {"cell", Engine::cell},
                                                                          {"embree", Engine::embree}}};

void check(const RreRequest& request) {
  if (request.engine == Engine::exact || request.engine == Engine::cell)
    throw InputError({"", 0, "--engine"},
                     fmt::format("{} is not available in this version; there are auto, montecarlo, embree",
                                 engine_name(request.engine)));
  for (const double t : request.incidence_deg)
    if (!(std::abs(t) < 90.0))
      throw InputError({"", 0, "--incidence"}, fmt::format("must lie between -90 and 90 degrees, got {}", shortest(t)));
}

void append(RreResult& result, const raytrace::MonteCarloResult& traced, const RrePoint& at) {
  for (const raytrace::ConeResult& cone : traced.cones) {
    RrePoint point = at;
    point.acceptance_half_angle_deg = cone.half_angle_deg;
    point.rre = cone.rre;
    point.std_error = cone.std_error;
    point.ledger = cone.ledger;
    result.points.push_back(point);
  }
  result.rays += traced.rays;
}

std::string missed_target(const Design& design, const RrePoint& at, const RreRequest& request) {
  return fmt::format("{}: the standard error at incidence {}, azimuth {} is above the target of {}", design.source,
                     shortest(at.incidence_deg), shortest(at.azimuth_deg), shortest(request.target_error));
}

}  // namespace

Engine engine_from_name(std::string_view name) {
  for (const auto& [known, engine] : kEngines)
    if (known == name) return engine;
  throw InputError({"", 0, "--engine"}, fmt::format("must be auto, exact, montecarlo, cell or embree, got {}", name));
}

std::string_view engine_name(Engine engine) {
  for (const auto& [name, known] : kEngines)
    if (known == engine) return name;
  return "";
}

struct RreStudy::Prepared {
  std::vector<Design> designs;
  RreRequest request;
  std::vector<OpticalModel> models;
};

RreStudy::RreStudy(std::vector<Design> designs, RreRequest request) : prepared_(std::make_unique<Prepared>()) {
  check(request);
  const auto library = materials::MaterialLibrary::shipped();
  for (const Design& design : designs) prepared_->models.push_back(make_model(design, library));
  prepared_->designs = std::move(designs);
  prepared_->request = std::move(request);
}

RreStudy::~RreStudy() = default;

RreResult RreStudy::run(Progress* progress, const Cancellation* cancel) const {
  const auto start = std::chrono::steady_clock::now();
  const auto& [designs, request, models] = *prepared_;
  RreResult result;
  result.designs = designs;
  result.engine_requested = engine_name(request.engine);
  result.seed = request.seed;
  for (const OpticalModel& model : models)
    result.warnings.insert(result.warnings.end(), model.warnings.begin(), model.warnings.end());
  raytrace::Sampling sampling;
  sampling.seed = request.seed;
  sampling.rays = request.rays;
  sampling.target_error = request.target_error;
  raytrace::PathPolicy policy;
  policy.cutoff = request.cutoff;

  const double total = static_cast<double>(designs.size() * request.azimuth_deg.size() * request.incidence_deg.size());
  double done = 0.0;
  if (progress != nullptr) progress->at(0.0);
  for (std::size_t d = 0; d < designs.size() && result.complete; ++d) {
    const raytrace::MonteCarlo tracer(models[d].part);
    for (std::size_t a = 0; a < request.azimuth_deg.size() && result.complete; ++a) {
      for (const double incidence : request.incidence_deg) {
        const RrePoint at{d, incidence, request.azimuth_deg[a], designs[d].wavelength_nm, 0.0, 0.0, 0.0, {}};
        const raytrace::MonteCarloResult traced =
            tracer.trace(models[d].optics, {Angle::from_deg(incidence), Angle::from_deg(at.azimuth_deg)},
                         designs[d].acceptance_half_angle_deg, sampling, policy, cancel);
        result.complete = traced.complete;
        if (!result.complete) break;  // an unfinished point is no point
        append(result, traced, at);
        if (!traced.reached_target) result.warnings.push_back(missed_target(designs[d], at, request));
        if (progress != nullptr) progress->at(++done / total);
      }
    }
  }
  result.elapsed_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

}  // namespace retrace::studies
