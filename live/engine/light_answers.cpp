// Answers requests that trace light: one direction of incidence, or a curve of the RRE (retroreflective efficiency).
#include <algorithm>
#include <nlohmann/json.hpp>

#include "live/engine/answers.h"
#include "live/engine/request.h"
#include "raytrace/engines/beam_race.h"
#include "raytrace/engines/wavelengths.h"
#include "studies/rre/beam_tracing.h"
#include "studies/rre/spectral_mean.h"

namespace retrace::live {
namespace {

using studies::RrePoint;

constexpr double kMovingError = 1e-4;

/// Result for one wavelength, or the mean over all wavelengths. `points` has one element per acceptance cone.
struct Found {
  std::vector<RrePoint> points;
  RrePoint at_middle;  ///< result for the widest cone, at the wavelength of the footprint and the far field
  std::optional<studies::Footprint> footprint;
  std::optional<studies::FarField> far_field;
};

RrePoint point_at(const OpenedDesign& opened, const studies::SceneLight& light) {
  RrePoint at;
  at.incidence_deg = light.incidence_deg;
  at.azimuth_deg = light.azimuth_deg;
  at.wavelength_nm = opened.require_model().wavelength_nm;
  return at;
}

/// Settings for tracing one direction of incidence.
struct TraceSettings {
  /// Maximum truncated power (exact engine), or target standard error of the RRE (resampled beams).
  double target_error = kMovingError;
  bool is_exact = false;  ///< true if resampled beams must not be used
  studies::BeamOutputRequest question = {};
};

/// Traces a design for one direction of incidence and one wavelength.
class Tracing {
 public:
  Tracing(const OpenedDesign& opened, const RrePoint& at, std::size_t wavelength)
      : opened_(opened),
        lit_(opened.require_model().spectral[wavelength]),
        wavelength_(wavelength),
        at_(at),
        illumination_(studies::illumination_of(at, opened.design())) {
    at_.wavelength_nm = lit_.wavelength_nm;
  }

  /// Traces with the exact engine or with resampled beams, whichever is faster. Returns nothing if the time limit is
  /// reached.
  /// \param limit null if there is no limit
  std::optional<Found> trace(const TraceSettings& way, const TimeLimit* limit) {
    studies::BeamCollector collector(way.question, part(), cones().size(), illumination_);
    raytrace::Sampling of_spectrum;
    of_spectrum.target_error = way.target_error;
    const raytrace::Sampling sampling = raytrace::sampling_at(of_spectrum, lit_.weight, wavelength_);
    raytrace::BeamPolicy policy;
    policy.truncated_goal = way.target_error;
    raytrace::BeamRace race(opened_.require_tracer(), nullptr, lit_.optics, illumination_, cones(), policy, sampling,
                            {.may_resample = !way.is_exact, .observer = collector.observer()}, nullptr);
    while (!race.advance())
      if (limit != nullptr && limit->is_over()) return std::nullopt;
    return race.is_exact() ? exact(race.exact(), way.question) : stochastic(race.stochastic(), collector);
  }

 private:
  const geometry::Part& part() const { return opened_.require_model().part; }
  const std::vector<double>& cones() const { return opened_.design().detector.acceptance_half_angle_deg; }

  Found exact(const raytrace::BeamResult& traced, const studies::BeamOutputRequest& question) {
    at_.engine = "exact";
    Found found{studies::points_of(at_, cones(), traced), {}, {}, {}};
    if (!question.footprint && !question.far_field) return found;
    raytrace::BeamPolicy again;
    again.cutoff = traced.cutoff;
    studies::BeamOutputs answer = studies::trace_exact_beams(opened_.require_tracer(), part(), lit_.optics,
                                                             illumination_, cones(), again, question, nullptr, nullptr);
    found.footprint = std::move(answer.footprint);
    found.far_field = std::move(answer.far_field);
    return found;
  }

  Found stochastic(const raytrace::StochasticBeams& traced, const studies::BeamCollector& collector) {
    at_.engine = "stochastic";
    Found found{studies::points_of(at_, traced.result()), {}, collector.footprint(), collector.far_field()};
    for (RrePoint& point : found.points) point.beams = traced.beams();
    return found;
  }

  const OpenedDesign& opened_;
  const design::SpectralOptics& lit_;
  std::size_t wavelength_;  ///< index of the wavelength in the spectrum
  RrePoint at_;
  raytrace::Illumination illumination_;
};

/// Traces one direction of incidence at all wavelengths. The footprint and the far field are computed only at the
/// wavelength with the index OpticalModel::nearest_wavelength(). Returns nothing if the time limit is reached.
std::optional<Found> traced(const OpenedDesign& opened, const studies::SceneLight& light, const TraceSettings& way,
                            const TimeLimit* limit) {
  const design::OpticalModel& model = opened.require_model();
  const RrePoint at = point_at(opened, light);
  const std::size_t middle = model.nearest_wavelength();
  Found all;
  std::vector<std::vector<studies::SpectralPoint>> spectral(opened.design().detector.acceptance_half_angle_deg.size());
  for (std::size_t k = 0; k < model.spectral.size(); ++k) {
    TraceSettings of_wavelength = way;
    if (k != middle) of_wavelength.question = {};
    std::optional<Found> found = Tracing(opened, at, k).trace(of_wavelength, limit);
    if (!found) return std::nullopt;
    for (std::size_t cone = 0; cone < spectral.size(); ++cone)
      spectral[cone].push_back({model.spectral[k].weight, found->points[cone]});
    if (k != middle) continue;
    all.at_middle = found->points.back();
    all.footprint = std::move(found->footprint);
    all.far_field = std::move(found->far_field);
  }
  for (const std::vector<studies::SpectralPoint>& points : spectral) {
    all.points.push_back(points.size() == 1 ? points.front().point : studies::spectral_mean(at, points));
    all.points.back().acceptance_half_angle_deg = points.front().point.acceptance_half_angle_deg;
  }
  return all;
}

TraceSettings way_of(const Json& request) {
  const auto engine = get<std::string>(request, "engine", std::string("auto"));
  if (engine != "auto" && engine != "exact") throw InputError({"", 0, "engine"}, "must be auto or exact");
  return {fraction_of(request, "target_error", kMovingError), engine == "exact"};
}

Json flat(const geometry::Polygon& outline) {
  Json list = Json::array();
  for (const geometry::Vec2& p : outline) {
    list.push_back(p.x());
    list.push_back(p.y());
  }
  return list;
}

Json footprint_json(const studies::Footprint& footprint) {
  Json regions = Json::array();
  for (const studies::ActiveRegion& region : footprint.regions)
    regions.push_back({{"outline", flat(region.outline_mm)}, {"efficiency", region.efficiency}});
  return {{"active_fraction", footprint.active_fraction()},
          {"shown", footprint.rre_contribution()},
          {"regions", std::move(regions)}};
}

/// Returns the spots of the far field, the power outside these spots, and the total power.
/// \param point result for the same direction of incidence; its ledger also includes weak beams, which `far_field`
/// omits
Json far_field_json(const studies::FarField& far_field, const RrePoint& point) {
  using raytrace::Account;
  Json spots = Json::array();
  double total = 0.0;
  for (const Account account :
       {Account::retroreflected, Account::front_specular, Account::scattered_out, Account::returned_elsewhere})
    total += point.ledger[account];
  double shown = 0.0;
  for (const studies::FarFieldSpot& spot : far_field.spots) {
    shown += spot.stokes.i;
    spots.push_back({{"deviation_deg", spot.deviation.deg()},
                     {"orientation_deg", spot.orientation.deg()},
                     {"power", spot.stokes.i},
                     {"depth", spot.min_depth}});
  }
  return {{"spots", std::move(spots)}, {"other_power", std::max(0.0, total - shown)}, {"total_power", total}};
}

Json cones_json(const std::vector<RrePoint>& points) {
  Json cones = Json::array();
  for (const RrePoint& point : points)
    cones.push_back({{"acceptance_half_angle_deg", point.acceptance_half_angle_deg},
                     {"rre", point.rre},
                     {"std_error", point.std_error},
                     {"ledger", point.ledger.power}});
  return cones;
}

Json by_wavelength_json(const RrePoint& point) {
  Json list = Json::array();
  for (const studies::SpectralRre& at : point.by_wavelength)
    list.push_back({{"wavelength_nm", at.wavelength_nm}, {"weight", at.weight}, {"rre", at.rre}});
  return list;
}

[[noreturn]] void fail_on_time() {
  throw BudgetError(
      "the computation of this direction exceeds its time limit: choose a lower accuracy, or use the program retrace");
}

}  // namespace

Json direction_json(const OpenedDesign& opened, const Json& request, const TimeLimit& limit) {
  TraceSettings way = way_of(request);
  way.question = {.footprint = true, .far_field = true};
  const std::optional<Found> found = traced(opened, light_of(request), way, &limit);
  if (!found) fail_on_time();
  const RrePoint& widest = found->points.back();
  Json json = {{"rre", widest.rre},
               {"std_error", widest.std_error},
               {"truncated", widest.ledger[raytrace::Account::truncated]},
               {"engine", widest.engine},
               {"acceptance_half_angle_deg", widest.acceptance_half_angle_deg},
               {"ledger", widest.ledger.power},
               {"beams", widest.beams},
               {"depth", widest.depth},
               {"stokes", widest.stokes.values()},
               {"cones", cones_json(found->points)}};
  if (found->footprint) json["footprint"] = footprint_json(*found->footprint);
  if (found->far_field) json["far_field"] = far_field_json(*found->far_field, found->at_middle);
  if (!widest.by_wavelength.empty()) json["by_wavelength"] = by_wavelength_json(widest);
  return json;
}

Json rre_json(const OpenedDesign& opened, const Json& request, const TimeLimit& limit) {
  const TraceSettings way = way_of(request);
  const auto directions = get<std::vector<std::vector<double>>>(request, "directions");
  Json points = Json::array();
  for (const std::vector<double>& direction : directions) {
    if (direction.size() != 2) throw InputError({"", 0, "directions"}, "must be pairs [incidence_deg, azimuth_deg]");
    // The first direction has no time limit. Every request therefore returns at least one point.
    const std::optional<Found> found =
        traced(opened, checked(direction[0], direction[1]), way, points.empty() ? nullptr : &limit);
    if (!found) break;
    const RrePoint& widest = found->points.back();
    points.push_back({widest.rre, widest.ledger[raytrace::Account::truncated], widest.std_error});
    if (limit.is_over()) break;
  }
  const bool is_complete = points.size() == directions.size();
  return {{"points", std::move(points)}, {"complete", is_complete}};
}

}  // namespace retrace::live
