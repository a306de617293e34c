#include "studies/image/detector_study.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "core/error.h"
#include "core/task_progress.h"
#include "design/cell_interference_of_design.h"
#include "design/light_and_index.h"
#include "materials/spectral_bands.h"
#include "raytrace/engines/wavelengths.h"
#include "requests/descriptions.h"

namespace retrace::studies {
namespace {

using geometry::Rectangle, geometry::Vec2;

// Maximum fraction of the power that remains untraced if light is traced as beams. It is too small to be visible in a
// picture.
constexpr double kTruncatedGoal = 1e-5;
// Maximum number of beams up to which the engine `auto` uses exact tracing. Tracing this number takes some seconds.
constexpr std::uint64_t kBeamsOfAutomatic = 1'000'000;
// Maximum number of beams for diffraction, which are kept in memory.
constexpr std::uint64_t kBeamsOfDiffraction = 4'000'000;
// Maximum product of diffracted polygons and bins of directions. It takes some seconds.
constexpr double kPolygonsTimesBins = 4e7;
// Ratio of the angle within which beams are diffracted to the half width of the angular map.
constexpr double kDiffractedAround = 1.5;
// Minimum number of finished replicates for which an interrupted computation returns maps.
constexpr std::uint32_t kMinReplicates = 8;
// Number of rays that determine the half width of the angular map.
constexpr std::uint64_t kPilotRays = std::uint64_t{1} << 16;
// Fraction of the light near the source that the angular map contains, without diffraction.
constexpr double kFractionInWindow = 0.999;
constexpr double kAroundLight = 1.1;      // ratio of the half width of the map to the half angle of the light
constexpr double kFringesInWindow = 6.0;  // width that diffraction adds to the map, in wavelengths per cell
constexpr double kMinWindowDeg = 0.05;
constexpr double kWindowWithoutLightDeg = 1.0;

raytrace::Illumination illumination_of(const design::Design& design, const DetectorRequest& request) {
  return {Angle::from_deg(request.incidence_deg), Angle::from_deg(request.azimuth_deg), design.light.polarisation};
}

raytrace::ReturnFrame frame_of(const raytrace::Illumination& light) {
  raytrace::ReturnFrame frame;
  frame.to_source = raytrace::direction_to_source(light);
  frame.right = raytrace::source_axis(frame.to_source);
  frame.up = frame.to_source.cross(frame.right);
  return frame;
}

/// Returns a grid of square pixels over the face, with `longer` pixels along its longer side.
raytrace::PixelGrid face_grid(const geometry::Part& part, std::size_t longer) {
  const Rectangle bounds =
      part.period_mm ? Rectangle{Vec2::Zero(), *part.period_mm} : geometry::bounding_box(part.outline);
  const double pixel = bounds.size().maxCoeff() / static_cast<double>(longer);
  const auto count = [&](double length) {
    return std::max<std::size_t>(1, static_cast<std::size_t>(std::lround(length / pixel)));
  };
  return {bounds, count(bounds.size().x()), count(bounds.size().y())};
}

/// Returns the smallest number of two digits, in steps that suit an axis, that is not less than the value.
double rounded_up(double value) {
  const double exponent = std::floor(std::log10(value));
  // Division by a whole number gives the double that is nearest to the decimal number.
  const auto scaled = [&](double step) {
    return exponent < 0.0 ? step / std::pow(10.0, -exponent) : step * std::pow(10.0, exponent);
  };
  for (const double step : {1.0, 1.2, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0})
    if (scaled(step) >= value * (1.0 - 1e-9)) return scaled(step);
  return scaled(10.0);
}

void add(std::vector<double>& sum, const std::vector<double>& more, double weight) {
  if (sum.empty()) sum.assign(more.size(), 0.0);
  for (std::size_t k = 0; k < more.size(); ++k) sum[k] += weight * more[k];
}

void add(raytrace::PixelValues& sum, const raytrace::PixelValues& more, double weight) {
  add(sum.value, more.value, weight);
  if (more.std_error.empty()) return;
  if (sum.std_error.empty()) sum.std_error.assign(more.value.size(), 0.0);
  for (std::size_t k = 0; k < more.std_error.size(); ++k)
    sum.std_error[k] = std::hypot(sum.std_error[k], weight * more.std_error[k]);
}

void add(raytrace::DetectorMaps& sum, const raytrace::DetectorMaps& more, double weight) {
  add(sum.leaving, more.leaving, weight);
  add(sum.entering, more.entering, weight);
  add(sum.per_sr, more.per_sr, weight);
  add(sum.rings.power, more.rings.power, weight);
  sum.outside += weight * more.outside;
  sum.rre += weight * more.rre;
  sum.truncated += weight * more.truncated;
  sum.std_error = std::hypot(sum.std_error, weight * more.std_error);
  sum.rays += more.rays;
  sum.complete = sum.complete && more.complete;
}

}  // namespace

DetectorStudy::DetectorStudy(design::Design design, DetectorRequest request, std::uint64_t rays_per_pass)
    : design_(std::move(design)), request_(std::move(request)), rays_per_pass_(rays_per_pass) {
  requests::check(request_);
  engine_ = raytrace::engine_from_name(request_.engine);
  design::require_supported(design_, {.what = "retrace image", .solids = true, .entrances = true, .wet_backs = true});
  model_ = design::make_model(design_, materials::MaterialLibrary::shipped());
  facts_ = design::engine_facts(design_, &model_.optics);
  if (const auto obstacle = raytrace::obstacle_for(raytrace::Engine::exact, facts_);
      obstacle && engine_ == raytrace::Engine::exact)
    throw InputError(design::position_of(design_, *obstacle),
                     fmt::format("{} cannot be traced exactly: use {} montecarlo", raytrace::subject_of(*obstacle),
                                 reference({"engine"})));
}

raytrace::BeamPolicy DetectorStudy::beam_policy() const {
  raytrace::BeamPolicy policy;
  policy.cutoff = request_.cutoff;
  policy.truncated_goal = kTruncatedGoal;
  if (engine_ == raytrace::Engine::automatic) policy.max_beams = kBeamsOfAutomatic;
  return policy;
}

raytrace::DetectorSetting DetectorStudy::setting_of(const raytrace::PixelGrid& face, double window_deg) const {
  return {face,
          {raytrace::DirectionGrid::Layout::square, Angle::from_deg(window_deg).rad(), request_.angle_pixels,
           request_.angle_pixels},
          frame_of(illumination_of(design_, request_)),
          design_.detector.acceptance_half_angle_deg.back(),
          {request_.bin_error, kDarkFace},
          {request_.bin_error, kDarkAngles}};
}

raytrace::DetectorMaps DetectorStudy::trace_beams(const raytrace::DetectorSetting& setting, Progress* progress,
                                                  const Cancellation* cancel) const {
  raytrace::DetectorMaps maps;
  const std::size_t wavelengths = model_.spectral.size();
  TaskProgress all(progress, wavelengths);
  raytrace::trace_wavelengths(1, wavelengths, false, all, [&](std::size_t, std::size_t k, Progress&) {
    const design::SpectralOptics& light = model_.spectral[k];
    add(maps,
        raytrace::exact_detector_maps(model_.part, light.optics, illumination_of(design_, request_), setting,
                                      beam_policy(), cancel),
        light.weight);
    return maps.complete;
  });
  if (maps.complete) return maps;
  maps = {};
  maps.complete = false;
  return maps;
}

std::vector<raytrace::DetectorLight> DetectorStudy::lights() const {
  std::vector<raytrace::DetectorLight> all;
  for (std::size_t k = 0; k < model_.spectral.size(); ++k)
    all.push_back({&model_.spectral[k].optics, model_.spectral[k].weight, raytrace::seed_at(request_.seed, k)});
  return all;
}

raytrace::AngularRings DetectorStudy::pilot_rings(const raytrace::PixelGrid& face, const Cancellation* cancel) const {
  const raytrace::DetectorSetting setting = setting_of({face.bounds_mm(), 1, 1}, kWindowWithoutLightDeg);
  const std::uint64_t rays = std::min(request_.samples.value_or(kPilotRays), kPilotRays);
  const std::vector<raytrace::DetectorLight> lights = this->lights();
  raytrace::DetectorSampler sampler(model_.part, lights, illumination_of(design_, request_), setting, rays, {},
                                    model_.curved_entrance());
  if (!sampler.add_pass(nullptr, cancel)) return {};
  return sampler.maps().rings;
}

void DetectorStudy::trace_rays(const raytrace::DetectorSetting& setting, Progress* progress, const Cancellation* cancel,
                               DetectorResult& result) const {
  const std::vector<raytrace::DetectorLight> lights = this->lights();
  raytrace::DetectorSampler sampler(model_.part, lights, illumination_of(design_, request_), setting,
                                    request_.samples.value_or(rays_per_pass_), {}, model_.curved_entrance());
  // One pass is sufficient if pixels are not merged, because no error is then requested.
  const bool is_fixed = request_.samples || !(request_.bin_error > 0.0);
  const std::uint32_t passes = is_fixed ? 1 : kMaxDetectorPasses;
  const auto is_small = [](std::size_t bin, std::size_t width) {
    return static_cast<double>(bin) <= std::max(1.0, kSmallBin * static_cast<double>(width));
  };
  for (std::uint32_t pass = 1; pass <= passes; ++pass) {
    PartProgress part(progress, (pass - 1.0) / passes, static_cast<double>(pass) / passes);
    const bool done = sampler.add_pass(&part, cancel);
    result.maps = sampler.replicates() >= kMinReplicates ? sampler.maps() : raytrace::DetectorMaps();
    result.maps.complete = done;
    result.face_bin_pixels =
        std::max(bin_width(result.maps.leaving, kLightInSmallBins), bin_width(result.maps.entering, kLightInSmallBins));
    result.angle_bin_pixels = bin_width(result.maps.per_sr, kLightInSmallBins);
    const bool is_reached = is_small(result.face_bin_pixels, std::max(setting.face.columns(), setting.face.rows())) &&
                            is_small(result.angle_bin_pixels, setting.angles.columns());
    if (!done || is_reached) return;
  }
  result.is_limit_reached = !is_fixed;
}

/// Returns the half width of the angular map. It is the given one, or such that the map contains 99.9 % of the light
/// near the source as it is without diffraction. Diffraction adds the widths of some fringes.
double DetectorStudy::window_deg(const raytrace::AngularRings& rings, bool with_diffraction) const {
  if (request_.window_deg) return *request_.window_deg;
  const std::optional<double> half_angle_deg = rings.half_angle_deg(kFractionInWindow);
  if (!half_angle_deg) return kWindowWithoutLightDeg;
  double wanted_deg = std::max(kMinWindowDeg, kAroundLight * *half_angle_deg);
  if (with_diffraction) {
    double wavelength_nm = 0.0;
    for (const design::SpectralOptics& light : model_.spectral)
      wavelength_nm = std::max(wavelength_nm, light.wavelength_nm);
    const double fringe_deg = Angle::from_rad(1e-6 * wavelength_nm / model_.part.size_mm).deg();
    wanted_deg = std::max(kAroundLight * *half_angle_deg, *half_angle_deg + kFringesInWindow * fringe_deg);
  }
  return std::min(rounded_up(wanted_deg), 90.0);
}

/// Returns the parameters with which the fields of different cells are added, at one wavelength. Returns nothing if
/// their intensities are added.
std::optional<raytrace::CellInterference> DetectorStudy::cell_interference(const design::SpectralOptics& light) const {
  const design::CellSpread* const spread = design_.cell_spread();
  if (spread == nullptr) return std::nullopt;
  raytrace::CellInterference cells = design::interference_of(*spread, light.optics.index);
  const design::LightSpectrum* const lamp = design_.light.spectrum();
  if (lamp == nullptr || lamp->kind == design::LightSpectrum::Kind::lines) return cells;
  materials::Spectrum traced;
  for (const design::SpectralOptics& one : model_.spectral) {
    traced.wavelengths_nm.push_back(one.wavelength_nm);
    traced.weights.push_back(one.weight);
  }
  cells.band_nm = materials::spectral_bands(
      traced, design::flux_of(design_))[static_cast<std::size_t>(&light - model_.spectral.data())];
  return cells;
}

/// Returns the far field of one wavelength with diffraction: the power per steradian in each bin of directions, and
/// then the power outside of the bins. Returns nothing if the computation was cancelled.
std::optional<std::vector<double>> DetectorStudy::diffracted_map(const design::SpectralOptics& light,
                                                                 const raytrace::DetectorSetting& setting,
                                                                 const Cancellation* cancel) const {
  const raytrace::DirectionGrid& angles = setting.angles;
  raytrace::BeamPolicy beams = beam_policy();
  beams.max_beams = std::min(beams.max_beams, kBeamsOfDiffraction);
  raytrace::FarFieldPolicy policy;
  policy.wavelength_nm = light.wavelength_nm;
  policy.window_rad = kDiffractedAround * angles.half_width_rad();
  // Patterns that are narrower than the bins are not visible.
  policy.finest_detail_rad = 2.0 * angles.half_width_rad() / static_cast<double>(angles.columns());
  policy.max_polygons =
      static_cast<std::size_t>(std::clamp(kPolygonsTimesBins / static_cast<double>(angles.size()), 100.0, 20'000.0));
  policy.cancel = cancel;
  policy.interference = cell_interference(light);
  std::vector<raytrace::FarFieldRay> specular;
  const auto field = raytrace::detector_far_field(model_.part, light.optics, illumination_of(design_, request_),
                                                  setting.acceptance_deg, beams, policy, specular);
  if (!field) return std::nullopt;
  std::vector<double> map = field->binned(setting.frame, angles);
  for (const raytrace::FarFieldRay& ray : specular)
    map[angles.bin_of(setting.frame.angles_rad(ray.direction)).value_or(angles.size())] += ray.power;
  if (is_cancelled(cancel)) return std::nullopt;
  for (std::size_t bin = 0; bin < angles.size(); ++bin) map[bin] /= angles.solid_angle_sr(bin);
  return map;
}

/// Replaces the angular map by the far field with diffraction. Returns false if this is not possible; the map is then
/// unchanged, and the result contains the reason.
bool DetectorStudy::add_diffraction(DetectorResult& result, const raytrace::DetectorSetting& setting,
                                    const Cancellation* cancel) const {
  if (facts_.has_texture) {
    result.without_diffraction = "rough facets";
    return false;
  }
  std::vector<double> sum;
  try {
    for (const design::SpectralOptics& light : model_.spectral) {
      const std::optional<std::vector<double>> map = diffracted_map(light, setting, cancel);
      if (!map) {
        result.maps = {};
        result.maps.complete = false;
        return true;
      }
      add(sum, *map, light.weight);
    }
  } catch (const BudgetError&) {
    result.without_diffraction = "too many beams";
    return false;
  }
  result.maps.outside = sum.back();
  sum.pop_back();
  result.maps.per_sr = {std::move(sum), {}};
  result.has_diffraction = true;
  return true;
}

DetectorResult DetectorStudy::run(Progress* progress, const Cancellation* cancel) const {
  const auto start = std::chrono::steady_clock::now();
  DetectorResult result;
  result.design = design_;
  result.request = request_;
  result.warnings = model_.warnings;
  result.acceptance_half_angle_deg = design_.detector.acceptance_half_angle_deg.back();
  result.face = face_grid(model_.part, request_.pixels);
  result.is_period = model_.part.period_mm.has_value();
  bool exact = raytrace::is_exact(engine_, facts_);
  AttemptProgress attempt(progress);
  const double first_window_deg = request_.window_deg.value_or(kWindowWithoutLightDeg);
  result.window_deg = first_window_deg;
  if (exact) {
    try {
      result.maps = trace_beams(setting_of(result.face, first_window_deg), &attempt, cancel);
    } catch (const BudgetError&) {
      if (engine_ == raytrace::Engine::exact) throw;
      exact = false;  // the exact engine needs too many beams
      attempt.begin_again();
    }
  }
  if (exact && result.maps.complete) {
    result.window_deg = window_deg(result.maps.rings, true);
    if (!add_diffraction(result, setting_of(result.face, result.window_deg), cancel)) {
      result.window_deg = window_deg(result.maps.rings, false);
      attempt.begin_again();
      // The maps already have this window if the window was requested.
      if (result.window_deg != first_window_deg)
        result.maps = trace_beams(setting_of(result.face, result.window_deg), &attempt, cancel);
    }
  } else if (!exact) {
    result.without_diffraction = "rays";
    if (!request_.window_deg) result.window_deg = window_deg(pilot_rings(result.face, cancel), false);
    trace_rays(setting_of(result.face, result.window_deg), &attempt, cancel, result);
  }
  result.face_error = std::max(raytrace::largest_relative_error(result.maps.leaving, kDarkFace),
                               raytrace::largest_relative_error(result.maps.entering, kDarkFace));
  result.angle_error = raytrace::largest_relative_error(result.maps.per_sr, kDarkAngles);
  if (design_.cell_spread() != nullptr && result.maps.complete && !result.has_diffraction)
    result.warnings.push_back(
        {"no_cell_interference", fmt::format("{}: array.depth_spread_nm has no effect, because the far field does not "
                                             "include diffraction",
                                             design_.source_name())});
  result.engine = exact ? "exact" : "embree";
  result.complete = result.maps.complete;
  result.elapsed_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

}  // namespace retrace::studies
