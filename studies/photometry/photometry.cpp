#include "studies/photometry/photometry.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <numeric>

#include "core/error.h"
#include "core/message_text.h"
#include "core/number_format.h"
#include "core/task_progress.h"
#include "studies/photometry/advice.h"
#include "studies/photometry/coefficient_map.h"
#include "studies/photometry/colour.h"
#include "studies/photometry/measurement_plan.h"
#include "studies/photometry/photometer.h"
#include "studies/rre/angle_list.h"

namespace retrace::studies {
namespace {

/// Minimum diameter of the larger of the two apertures, source and receiver. If both were points, computed intensities
/// would be infinite or 0.
constexpr double kMinApertureArcmin = 0.006;
// Number of spans of the spectrum for pictures. Each span has two wavelengths.
constexpr std::size_t kPictureParts = 1;
// Number of spans of the spectrum for preliminary readings. Each span has two wavelengths.
constexpr std::size_t kFirstAnswerParts = 1;
// Minimum number of rays for preliminary readings.
constexpr double kMinRaysOfFirstAnswer = 4096.0;
constexpr std::size_t kMapColumns = 97;
constexpr std::size_t kMaxMaps = 6;
// Entrance angles of the curves over the observation angle.
constexpr std::array<double, 4> kCurveEntranceDeg = {0.0, 10.0, 20.0, 30.0};
// Number of observation angles of a curve.
constexpr std::size_t kCurvePoints = 41;

void check_discs(const raytrace::PhotometricApertures& apertures) {
  const double source = arcmin_of(apertures.source), receiver = arcmin_of(apertures.receiver);
  if (std::max(source, receiver) >= kMinApertureArcmin) return;
  const std::string of_receiver = reference({"receiver_arcmin"});
  throw InputError(
      Field{"source_arcmin"},
      fmt::format("must be at least {0} arcmin unless {1} is at least {0} arcmin, because the intensities of a point "
                  "source at a point receiver are infinite or 0; got {2} arcmin, and {1} is {3} arcmin",
                  shortest(kMinApertureArcmin), of_receiver, shortest(source), shortest(receiver)));
}

void check(const PhotometrySettings& settings) {
  check_discs(settings.apertures);
  // Settings that come from sweeps and other studies may contain an engine or a cut-off that is valid for RRE but not
  // for photometry.
  if (settings.engine == raytrace::Engine::cell || settings.engine == raytrace::Engine::stochastic)
    throw InputError(Field{"engine"}, fmt::format("must be auto, exact, montecarlo or embree, got {}",
                                                  raytrace::engine_name(settings.engine)));
  if (settings.cutoff == 0.0) throw InputError(Field{"cutoff"}, "must be > 0 for photometry, got 0");
  for (const TestPoint& point : settings.test_plan.points)
    if (!(point.observation_deg <= settings.window_deg))
      throw InputError({settings.limits_source, point.line, "observation_deg"},
                       fmt::format("must be within the computed far field ({} {}), got {}", reference({"window_deg"}),
                                   shortest(settings.window_deg), shortest(point.observation_deg)));
}

/// Returns settings for the far-field maps: one for each measured direction of light at the first rotation of the part,
/// up to kMaxMaps.
std::vector<PhotometerSetting> map_settings(const PhotometrySettings& request, const MeasurementPlan& plan) {
  std::vector<PhotometerSetting> settings;
  for (const PhotometerSetting& measured : plan.settings)
    if (measured.rotation_deg == request.rotation_deg.front() && settings.size() < kMaxMaps)
      settings.push_back({measured.v_deg, measured.h_deg, measured.rotation_deg, {}, kMapColumns, false});
  return settings;
}

std::vector<PhotometerSetting> curve_settings(const PhotometrySettings& request) {
  std::vector<PhotometerSetting> settings;
  for (const double entrance_deg : kCurveEntranceDeg) {
    settings.push_back(
        {0.0, -entrance_deg, request.rotation_deg.front(), equidistant(request.window_deg, kCurvePoints), 0, false});
  }
  return settings;
}

bool add_pictures(const design::Design& design, const PhotometrySettings& request, const MeasurementPlan& plan,
                  bool exact, Progress* progress, const Cancellation* cancel, PhotometryResult& result) {
  Photometer photometer(design, request, kPictureParts);
  if (!exact) photometer.use_monte_carlo();
  const std::vector<PhotometerSetting> maps = map_settings(request, plan);
  const std::vector<PhotometerSetting> curves = curve_settings(request);
  std::vector<PhotometerSetting> all = maps;
  all.insert(all.end(), curves.begin(), curves.end());
  const auto readings = photometer.measure(all, progress, cancel);
  if (!readings) return false;
  for (std::size_t k = 0; k < maps.size(); ++k)
    result.maps.push_back(
        {maps[k].v_deg, maps[k].h_deg, request.window_deg, maps[k].map_columns, (*readings)[k].map_r_a});
  for (std::size_t k = 0; k < curves.size(); ++k)
    result.curves.push_back({-curves[k].h_deg, curves[k].observation_deg, (*readings)[maps.size() + k].r_a});
  return true;
}

/// Measures the readings of a design at all test points. Returns nothing if the measurement was cancelled.
std::optional<std::vector<PhotometricPoint>> table_of(const Photometer& photometer, const PhotometrySettings& request,
                                                      MeasurementPlan plan, const Cancellation* cancel) {
  for (PhotometerSetting& setting : plan.settings) setting.split = false;
  const auto readings = photometer.measure(plan.settings, nullptr, cancel);
  if (!readings) return std::nullopt;
  return smallest_readings(readings_of_points(request, plan, {readings->begin(), readings->end()}));
}

/// Measures the readings of changed designs. Directions of light are measured one after the other. Directions for which
/// earlier designs failed come first.
class TablesOfChanges {
 public:
  TablesOfChanges(const PhotometrySettings& request, const MeasurementPlan& plan, bool exact,
                  const Cancellation* cancel)
      : request_(request), plan_(plan), exact_(exact), cancel_(cancel), order_(plan.settings.size()) {
    for (PhotometerSetting& setting : plan_.settings) setting.split = false;
    std::iota(order_.begin(), order_.end(), 0U);
  }

  /// Measures the readings of a changed design as described for TableOfDesign.
  std::optional<std::vector<PhotometricPoint>> table(const design::Design& design, std::size_t parts, double enough) {
    Photometer photometer(design, request_, parts);
    if (!exact_) photometer.use_monte_carlo();
    if (std::isfinite(enough)) photometer.set_effort(Photometer::Effort::search);
    Readings readings(plan_.settings.size());
    std::vector<PhotometricPoint> points;
    for (const EquivalentDirections& alike : in_order(photometer.group_equivalent_settings(plan_.settings))) {
      std::vector<PhotometerSetting> settings;
      for (const SharedDirection& one : alike) settings.push_back(plan_.settings[one.index]);
      const auto measured = photometer.measure(settings, nullptr, cancel_);
      if (!measured) return std::nullopt;
      for (std::size_t k = 0; k < alike.size(); ++k) readings[alike[k].index] = (*measured)[k];
      points = smallest_readings(readings_of_points(request_, plan_, readings));
      if (!(min_ratio(points) < enough)) continue;
      put_first(alike.front().index);
      break;
    }
    return points;
  }

 private:
  std::vector<EquivalentDirections> in_order(std::vector<EquivalentDirections> directions) const {
    const auto rank = [this](const EquivalentDirections& alike) {
      std::ptrdiff_t least = std::ssize(order_);
      for (const SharedDirection& one : alike)
        least = std::min(least, std::find(order_.begin(), order_.end(), one.index) - order_.begin());
      return least;
    };
    std::stable_sort(directions.begin(), directions.end(),
                     [&](const EquivalentDirections& a, const EquivalentDirections& b) { return rank(a) < rank(b); });
    return directions;
  }

  void put_first(std::size_t setting) {
    const auto at = std::find(order_.begin(), order_.end(), setting);
    std::rotate(order_.begin(), at, at + 1);
  }

  const PhotometrySettings& request_;
  MeasurementPlan plan_;
  bool exact_;
  const Cancellation* cancel_;
  std::vector<std::size_t> order_;  ///< order in which the settings are measured
};

/// Returns the settings of the compared design: its dye replaces that of the design of the study.
PhotometrySettings settings_of_compared(PhotometrySettings settings) {
  settings.dye = settings.compared->dye;
  settings.dye_absorption_per_mm = settings.compared->dye_absorption_per_mm;
  return settings;
}

}  // namespace

double arcmin_of(Angle diameter) {
  return std::round(60.0e12 * diameter.deg()) / 1e12;
}

std::string_view light_name(PhotometricLight light) {
  switch (light) {
    case PhotometricLight::illuminant_a: return "a";
    case PhotometricLight::illuminant_d65: return "d65";
    case PhotometricLight::of_design: return "design";
  }
  return {};
}

PhotometricLight light_from_name(std::string_view name) {
  using enum PhotometricLight;
  for (const PhotometricLight light : {illuminant_a, illuminant_d65, of_design})
    if (name == light_name(light)) return light;
  throw InputError(Field{"light"}, fmt::format("must be a, d65 or design, got {}", in_quotes(name)));
}

std::string text_of(const NoDiffraction& reason) {
  if (const auto* obstacle = std::get_if<raytrace::Obstacle>(&reason)) return raytrace::traced_by(*obstacle, "rays");
  switch (std::get<Undiffracted>(reason)) {
    case Undiffracted::not_requested: return "it was not requested";
    case Undiffracted::unequal_cells: return "the cells differ too much to compute the diffraction of each cell";
    case Undiffracted::strong_curvature:
      return "the entrance surface is curved too strongly within the light of one element";
    case Undiffracted::too_many_beams: return "the exact engine would need too many beams";
    case Undiffracted::shells: return "shells in front of the part are traced by rays";
    case Undiffracted::monte_carlo: return "the Monte-Carlo engine does not compute it";
  }
  return "";
}

std::vector<design::Design> PhotometryResult::map_designs() const {
  std::vector<design::Design> designs = {design};
  if (request.compared) designs.push_back(request.compared->design);
  return designs;
}

bool PhotometryResult::limits_are_r_i() const {
  const std::vector<TestPoint>& limits = request.test_plan.points;
  return !limits.empty() && limits.front().unit != PhotometricUnit::cd_per_lx_per_m2;
}

struct PhotometryStudy::Prepared {
  design::Design design;
  PhotometrySettings request;
  std::unique_ptr<Photometer> photometer;
  std::unique_ptr<Photometer> compared;  ///< photometer of the design for comparison, or null
  MeasurementPlan plan;
};

namespace {

/// Checks that light is traced as beams if the request selects the engine "exact".
/// \throw InputError if it is not, because faces of the design scatter light
void require_exact(const Photometer& photometer, const design::Design& design, raytrace::Engine engine) {
  if (engine == raytrace::Engine::exact && !photometer.is_exact())
    throw InputError(
        Field{"engine"},
        fmt::format(
            "the engine exact requires plane and smooth faces, but the faces of {} scatter light: use {} montecarlo",
            design.source_name(), reference({"engine"})));
}

/// Adds warnings if diffraction is requested but cannot be computed, and if cells can therefore not interfere.
void warn_of_diffraction(const Photometer& photometer, const design::Design& design, const PhotometrySettings& request,
                         Warnings& warnings) {
  if (request.diffraction && !photometer.has_diffraction())
    warnings.push_back(
        {"no_diffraction", fmt::format("{}: the Monte-Carlo engine does not include diffraction, which is significant "
                                       "for cells narrower than {} mm",
                                       design.source_name(), fixed(photometer.min_undiffracted_mm(), 1))});
  if (design.cell_spread() != nullptr && !photometer.adds_fields_of_cells())
    warnings.push_back({"no_cell_interference",
                        fmt::format("{}: array.depth_spread_nm has no effect, because the readings do not include "
                                    "diffraction",
                                    design.source_name())});
}

}  // namespace

PhotometryStudy::PhotometryStudy(design::Design design, PhotometrySettings settings)
    : prepared_(std::make_unique<Prepared>()) {
  check(settings);
  prepared_->photometer = std::make_unique<Photometer>(design, settings, materials::kSpectralParts);
  require_exact(*prepared_->photometer, design, settings.engine);
  if (settings.compared) {
    prepared_->compared = std::make_unique<Photometer>(settings.compared->design, settings_of_compared(settings),
                                                       materials::kSpectralParts);
    require_exact(*prepared_->compared, settings.compared->design, settings.engine);
  }
  prepared_->plan = measurement_plan(settings, mirrors_source(design));
  prepared_->design = std::move(design);
  prepared_->request = std::move(settings);
}

PhotometryStudy::~PhotometryStudy() = default;

double PhotometryStudy::cutoff() const {
  return prepared_->photometer->cutoff_of_element();
}

bool PhotometryStudy::uses_beams() const {
  return prepared_->photometer->is_exact();
}

namespace {

/// Replaces readings that lack diffraction by the readings of the mean field if these are above the limits. The mean
/// field, which excludes scattered light, gives lower bounds. Returns false if the computation was cancelled.
bool raise_to_mean_field(const Photometer& photometer, const PhotometrySettings& request, const MeasurementPlan& plan,
                         const Cancellation* cancel, std::vector<PhotometricPoint>& points) {
  const auto lacks = [](const PhotometricPoint& p) { return p.lacks_diffraction; };
  const std::optional<Photometer> mean_field = photometer.mean_field();
  if (!mean_field || std::none_of(points.begin(), points.end(), lacks)) return true;
  try {
    const auto bounds = table_of(*mean_field, request, plan, cancel);
    if (!bounds) return false;
    for (std::size_t k = 0; k < points.size(); ++k) {
      PhotometricPoint bound = (*bounds)[k];
      if (!lacks(points[k]) || bound.verdict() != Verdict::pass) continue;
      bound.is_lower_bound = true;
      points[k] = bound;
    }
  } catch (const BudgetError&) {  // too many beams for a lower bound
  }
  return true;
}

/// Returns why the verdict on some test points is undetermined. Returns an empty reason if there are no such points.
UndeterminedReason reason_of(const std::vector<PhotometricPoint>& points, const Photometer& photometer) {
  const auto is_open = [](const PhotometricPoint& p) { return p.verdict() == Verdict::undetermined; };
  if (std::none_of(points.begin(), points.end(), is_open)) return {};
  if (std::none_of(points.begin(), points.end(), [](const PhotometricPoint& p) { return p.lacks_diffraction; }))
    return {UndeterminedReason::Cause::noise, std::nullopt,
            "a photometric value is within two standard errors of its limit: " + photometer.remedy_for_noise()};
  const NoDiffraction why = photometer.why_undiffracted();
  return {UndeterminedReason::Cause::diffraction, why,
          fmt::format("diffraction is not included, because {}, but it is significant for cells narrower than {} mm",
                      text_of(why), fixed(photometer.min_undiffracted_mm(), 1))};
}

/// Measures with the exact engine, or by Monte Carlo if the exact engine needs too many beams and the request allows
/// both.
/// \param measure function that measures with the photometer and reports its progress
template <class Measure>
auto measure_within_budget(Photometer& photometer, const PhotometrySettings& request, Progress* progress,
                           const Measure& measure) {
  AttemptProgress attempt(progress);
  try {
    return measure(attempt);
  } catch (const BudgetError&) {
    if (request.engine == raytrace::Engine::exact || !photometer.is_exact()) throw;
    photometer.use_monte_carlo();
    attempt.begin_again();
    return measure(attempt);
  }
}

std::optional<std::vector<PhotometerReading>> readings_of(Photometer& photometer, const PhotometrySettings& request,
                                                          const MeasurementPlan& plan, Progress* progress,
                                                          const Cancellation* cancel) {
  return measure_within_budget(photometer, request, progress,
                               [&](Progress& attempt) { return photometer.measure(plan.settings, &attempt, cancel); });
}

/// Adds the maps of one design. Returns false if the computation was cancelled.
/// \param design index of the design, see CoefficientMap
bool add_design_maps(Photometer photometer, std::size_t design, Progress* progress, const Cancellation* cancel,
                     PhotometryResult& result) {
  const PhotometrySettings& request = result.request;
  std::optional<DesignMaps> measured = measure_within_budget(photometer, request, progress, [&](Progress& attempt) {
    return measure_maps(photometer, request, design, &attempt, cancel);
  });
  if (!measured) return false;
  for (CoefficientMap& map : measured->maps) result.coefficient_maps.push_back(std::move(map));
  result.map_directions += measured->directions;
  result.traced_map_directions += measured->traced_directions;
  return true;
}

/// Adds the maps over entrance and observation angle if they are requested. Returns false if the computation was
/// cancelled; the result then has no such maps.
/// \param compared photometer of the design with which the result is compared, or null
bool add_coefficient_maps(const Photometer& photometer, const Photometer* compared, Progress* progress,
                          const Cancellation* cancel, PhotometryResult& result) {
  if (!result.request.map_grid) return true;
  PartProgress first(progress, 0.0, compared != nullptr ? 0.5 : 1.0);
  bool is_complete = add_design_maps(photometer, 0, &first, cancel, result);
  if (is_complete && compared != nullptr) {
    PartProgress second(progress, 0.5, 1.0);
    is_complete = add_design_maps(*compared, 1, &second, cancel, result);
  }
  if (!is_complete) {
    result.coefficient_maps.clear();
    result.map_directions = result.traced_map_directions = 0;
  }
  return is_complete;
}

bool measures_colour(const PhotometrySettings& request) {
  return request.colour && request.light != PhotometricLight::of_design && !request.test_plan.points.empty();
}

/// Returns true if the study searches for a change with which the design passes, in case the design fails. The search
/// must be requested, and the design must have elements and a plane entrance face.
bool may_search_change(const design::Design& design, const PhotometrySettings& request) {
  return request.advice && design.elements() && !design.entrance;
}

/// Progress objects of the stages of PhotometryStudy::run(). Each stage fills a fraction of the whole progress.
struct StageProgress {
  PartProgress readings, colour, maps, pictures, change;
};

/// Divides the progress of a run among its stages, in proportion to estimates of their durations.
/// \param directions number of directions of light in which readings are measured
StageProgress stages_of(Progress* whole, const design::Design& design, const PhotometrySettings& request,
                        std::size_t directions) {
  const double colour = 1.0 + (measures_colour(request) ? 0.3 : 0.0);
  double maps = colour;
  if (request.map_grid) {
    const std::size_t map_directions =
        request.rotation_deg.size() * request.map_grid->presentation_deg.size() * request.map_grid->entrance_deg.size();
    maps += (request.compared ? 2.0 : 1.0) * static_cast<double>(map_directions) / static_cast<double>(directions);
  }
  const double pictures = maps + (request.pictures ? 0.3 : 0.0);
  const double change = pictures + (may_search_change(design, request) ? 1.0 : 0.0);
  return {{whole, 0.0, 1.0 / change},
          {whole, 1.0 / change, colour / change},
          {whole, colour / change, maps / change},
          {whole, maps / change, pictures / change},
          {whole, pictures / change, 1.0}};
}

/// Adds a proposal for a change with which a failing design passes. Returns false if the computation was cancelled.
bool add_change(const Photometer& photometer, const MeasurementPlan& plan, Progress* progress,
                const Cancellation* cancel, PhotometryResult& result) {
  const design::Design& design = result.design;
  const PhotometrySettings& request = result.request;
  const bool is_asked = may_search_change(design, request) &&
                        verdict_of(result.points, request.test_plan) == Verdict::fail &&
                        area_verdict(request.test_plan, request.area_cm2) != Verdict::fail;
  if (!is_asked) return true;
  TablesOfChanges tables(request, plan, photometer.is_exact(), cancel);
  result.change = change_that_passes(
      design, request.test_plan,
      [&](const design::Design& changed, std::size_t parts, double enough) {
        return tables.table(changed, parts, enough);
      },
      progress);
  if (result.change)
    result.change->verdict = std::max(result.change->verdict, area_verdict(request.test_plan, request.area_cm2));
  return !is_cancelled(cancel);
}

/// Adds the colour of the returned light if it is requested. Returns false if the computation was cancelled.
bool add_colour(const Photometer& photometer, Progress* progress, const Cancellation* cancel,
                PhotometryResult& result) {
  const PhotometrySettings& request = result.request;
  const TestPlan& test_plan = request.test_plan;
  if (!measures_colour(request)) return true;
  const bool mirrors = mirrors_source(result.design);
  const std::vector<double> v_deg = test_plan.boundaries.empty()
                                        ? measured_v_deg(test_plan.points.front(), mirrors)
                                        : measured_v_deg(test_plan.boundaries.front(), mirrors);
  result.colour = measured_colour(result.design, request, photometer, v_deg, progress, cancel);
  return result.colour.has_value();
}

/// Combines the models of a curved entrance surface from all readings. Each difference in the result is the largest one
/// of all readings. Returns nothing if no reading has a model.
std::optional<EntranceModel> worst_model(const std::vector<PhotometerReading>& readings) {
  std::optional<EntranceModel> worst;
  for (const PhotometerReading& reading : readings) {
    if (!reading.entrance_model) continue;
    if (!worst) worst = reading.entrance_model;
    worst->path_rms_waves = std::max(worst->path_rms_waves, reading.entrance_model->path_rms_waves);
    worst->angle_rms_arcmin = std::max(worst->angle_rms_arcmin, reading.entrance_model->angle_rms_arcmin);
    worst->max_angle_arcmin = std::max(worst->max_angle_arcmin, reading.entrance_model->max_angle_arcmin);
  }
  return worst;
}

}  // namespace

PhotometryResult PhotometryStudy::run(Progress* progress, const Cancellation* cancel) const {
  const auto start = std::chrono::steady_clock::now();
  const auto& [design, request, prepared_photometer, compared, plan] = *prepared_;
  Photometer photometer = *prepared_photometer;
  PhotometryResult result;
  result.design = design;
  result.request = request;
  result.warnings = photometer.warnings();
  result.wavelengths_nm = photometer.wavelengths_nm();
  StageProgress stages = stages_of(progress, design, request, std::max<std::size_t>(1, plan.settings.size()));
  const auto readings = readings_of(photometer, request, plan, &stages.readings, cancel);
  result.engine = photometer.engine_name();
  result.has_diffraction = photometer.has_diffraction();
  warn_of_diffraction(photometer, design, request, result.warnings);
  if (compared) {
    append(result.warnings, compared->warnings());
    warn_of_diffraction(*compared, request.compared->design, request, result.warnings);
  }
  result.complete = readings.has_value();
  if (readings) {
    for (const PhotometerReading& reading : *readings) result.directions.push_back(reading.direction);
    result.entrance_model = worst_model(*readings);
    result.readings = readings_of_points(request, plan, {readings->begin(), readings->end()});
    result.measured = smallest_readings(result.readings);
    result.points = result.measured;
    result.complete = raise_to_mean_field(photometer, request, plan, cancel, result.points);
    result.verdict =
        std::max(verdict_of(result.points, request.test_plan), area_verdict(request.test_plan, request.area_cm2));
    result.reason = reason_of(result.points, photometer);
  }
  if (result.complete) result.complete = add_colour(photometer, &stages.colour, cancel, result);
  if (result.complete) result.complete = add_coefficient_maps(photometer, compared.get(), &stages.maps, cancel, result);
  if (request.map_grid && result.coefficient_maps.empty())
    result.warnings.push_back({"map_incomplete", "the maps of R_A are left out, because they are not finished"});
  if (result.complete && request.pictures)
    result.complete = add_pictures(design, request, plan, photometer.is_exact(), &stages.pictures, cancel, result);
  if (result.complete) result.complete = add_change(photometer, plan, &stages.change, cancel, result);
  result.elapsed_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

std::optional<PhotometricFirstAnswer> PhotometryStudy::first_answer(double ray_fraction,
                                                                    const Cancellation* cancel) const {
  PhotometrySettings request = prepared_->request;
  const auto rays = static_cast<double>(request.rays.value_or(kDefaultRaysPerDirection));
  request.rays = static_cast<std::uint64_t>(std::min(rays, std::max(kMinRaysOfFirstAnswer, ray_fraction * rays)));
  MeasurementPlan plan = prepared_->plan;
  for (PhotometerSetting& setting : plan.settings) setting.split = false;
  Photometer photometer(prepared_->design, request, kFirstAnswerParts);
  photometer.set_effort(Photometer::Effort::first_answer);
  const auto readings = readings_of(photometer, request, plan, nullptr, cancel);
  if (!readings) return std::nullopt;
  PhotometricFirstAnswer answer;
  answer.points = smallest_readings(readings_of_points(request, plan, {readings->begin(), readings->end()}));
  answer.wavelengths_nm = photometer.wavelengths_nm();
  answer.lacks_diffraction = request.diffraction && !photometer.has_diffraction();
  return answer;
}

}  // namespace retrace::studies
