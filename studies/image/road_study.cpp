#include "studies/image/road_study.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <span>

#include "core/error.h"
#include "core/srgb.h"
#include "core/task_progress.h"
#include "design/optical_model.h"
#include "requests/descriptions.h"
#include "studies/image/camera_colours.h"
#include "studies/image/io/dye_reader.h"
#include "studies/image/io/lamp_reader.h"
#include "studies/photometry/photometer.h"

namespace retrace::studies {
namespace {

using geometry::Vec3;

// Number of spans of the spectrum, with two wavelengths each, for luminances and for the colour of the light.
constexpr std::size_t kSpansOfRoad = 1, kSpansOfTint = 2;
// Fraction of the progress for the computation of the colour of the light.
constexpr double kProgressOfColour = 0.3;

/// Returns the convex polygons that make up the entrance face of a finite design, in mm. Returns no polygons for an
/// infinite design.
std::vector<geometry::Polygon> face_of(const design::Design& design) {
  if (design.is_infinite()) return {};
  return geometry::entrance_polygons(design::make_model(design, materials::MaterialLibrary::shipped()).part);
}

PhotometrySettings photometry_at(const RoadScene& s, double distance_m, std::uint32_t seed) {
  PhotometrySettings request;
  request.area_cm2 = 1e4 * s.area();
  request.apertures.source = Angle::from_rad(s.lamp_diameter / distance_m);
  request.apertures.receiver = Angle::from_rad(s.pupil_diameter / (distance_m + s.eye_behind));
  request.window_deg = 10.0;
  request.seed = seed;
  return request;
}

/// Measures the reflectors with the exact engine, or by Monte Carlo if the exact engine needs too many beams.
std::optional<std::vector<PhotometerReading>> measured(Photometer& photometer,
                                                       const std::vector<PhotometerSetting>& settings,
                                                       Progress* progress, const Cancellation* cancel) {
  AttemptProgress attempt(progress);
  try {
    return photometer.measure(settings, &attempt, cancel);
  } catch (const BudgetError&) {
    if (!photometer.is_exact()) throw;
    photometer.use_monte_carlo();
    attempt.begin_again();
    return photometer.measure(settings, &attempt, cancel);
  }
}

/// Returns the settings of a photometer for each reflector and both headlamps. Each reflector has two settings, for the
/// left and the right headlamp.
std::vector<PhotometerSetting> settings_of(const RoadScene& scene, double distance_m) {
  std::vector<PhotometerSetting> settings;
  const Vec3 eye = eye_at(scene, distance_m);
  // Reflectors are mounted without rotation, so that their axes are parallel to the axes of the scene.
  for (const Vec3& reflector : scene.reflectors)
    for (const Vec3& lamp : lamps_at(scene, distance_m))
      settings.push_back(setting_of({(lamp - reflector).normalized(), (eye - reflector).normalized()}));
  return settings;
}

/// Returns the results for one reflector.
/// \param settings settings of the photometer for the left and the right headlamp
/// \param readings readings that were measured with `settings`
RoadReflector reflector_of(const RoadScene& scene, double distance_m, const Vec3& position,
                           std::span<const PhotometerSetting, 2> settings,
                           std::span<const PhotometerReading, 2> readings) {
  RoadReflector reflector;
  const std::array<Vec3, 2> lamps = lamps_at(scene, distance_m);
  for (std::size_t lamp = 0; lamp < 2; ++lamp) {
    const Vec3 to_lamp = lamps[lamp] - position;
    reflector.observation_deg[lamp] = settings[lamp].observation_deg.front();
    reflector.entrance_deg[lamp] = Angle::from_rad(std::atan2(std::hypot(to_lamp.x(), to_lamp.y()), to_lamp.z())).deg();
    reflector.r_a[lamp] = readings[lamp].r_a.front();
    reflector.illuminance_lx[lamp] = illuminance(scene, lamps[lamp], position);
    reflector.luminance += readings[lamp].r_l.front() * reflector.illuminance_lx[lamp];
    reflector.intensity_cd += reflector.r_a[lamp] * scene.area() * reflector.illuminance_lx[lamp];
  }
  return reflector;
}

/// Returns the colour of the light that a part returns, in linear sRGB with the luminance 1. Returns white if no light
/// returns, and nothing if the computation was cancelled.
std::optional<std::array<double, 3>> tint_of(const design::Design& design, const PhotometrySettings& photometry,
                                             const PhotometerSetting& setting, Progress* progress,
                                             const Cancellation* cancel) {
  using enum PhotometricResponse;
  std::array<double, 3> response{};
  constexpr std::array<PhotometricResponse, 3> kResponses = {x_bar, y_bar, z_bar};
  for (std::size_t k = 0; k < 3; ++k) {
    Photometer photometer(design, photometry, kSpansOfTint, kResponses[k]);
    PartProgress part(progress, static_cast<double>(k) / 3.0, static_cast<double>(k + 1) / 3.0);
    const auto readings = measured(photometer, {setting}, &part, cancel);
    if (!readings) return std::nullopt;
    response[k] = readings->front().r_a.front();
  }
  if (!(response[1] > 0.0)) return std::array{1.0, 1.0, 1.0};
  const CameraColours colours{{response[0] / response[1]}, {response[2] / response[1]}, lamp_colour(photometry.light)};
  return colours.rgb(1.0, 0);
}

}  // namespace

RoadStudy::RoadStudy(design::Design design, RoadRequest request)
    : design_(std::move(design)), request_(std::move(request)) {
  design::require_supported(
      design_, {.what = "retrace image", .solids = true, .entrances = true, .shells = true, .wet_backs = true});
  requests::check(request_);
  scene_ = scene_of(request_, face_of(design_));
  if (!request_.lamp.empty()) scene_.lamp = read_lamp(request_.lamp, Field{"lamp"});
  dye_absorption_per_mm_ = read_dye(request_.dye);
  if (!dye_absorption_per_mm_.values.empty()) scene_.dye = request_.dye;
}

RoadResult RoadStudy::run(Progress* progress, const Cancellation* cancel) const {
  const auto start = std::chrono::steady_clock::now();
  RoadResult result;
  result.design = design_;
  result.request = request_;
  result.scene = scene_;
  const bool is_coloured = !scene_.dye.empty() || design_.substance.is_coloured();
  const double end = is_coloured ? 1.0 - kProgressOfColour : 1.0;
  const double fraction = end / static_cast<double>(request_.distance_m.size());
  double brightest = 0.0;
  PhotometerSetting brightest_setting;
  PhotometrySettings brightest_photometry;
  for (const double distance_m : request_.distance_m) {
    PhotometrySettings photometry = photometry_at(scene_, distance_m, request_.seed);
    photometry.dye_absorption_per_mm = dye_absorption_per_mm_;
    photometry.dye = scene_.dye;
    Photometer photometer(design_, photometry, kSpansOfRoad);
    const std::vector<PhotometerSetting> settings = settings_of(scene_, distance_m);
    const auto done = static_cast<double>(result.views.size());
    PartProgress part(progress, fraction * done, fraction * (done + 1.0));
    const auto readings = measured(photometer, settings, &part, cancel);
    if (!readings) {
      result.complete = false;
      break;
    }
    RoadView view;
    view.distance_m = distance_m;
    for (std::size_t k = 0; k < scene_.reflectors.size(); ++k)
      view.reflectors.push_back(reflector_of(scene_, distance_m, scene_.reflectors[k],
                                             std::span(settings).subspan(2 * k).first<2>(),
                                             std::span(*readings).subspan(2 * k).first<2>()));
    for (std::size_t k = 0; k < settings.size(); ++k)
      if ((*readings)[k].r_a.front() > brightest) {
        brightest = (*readings)[k].r_a.front();
        brightest_setting = settings[k];
        brightest_photometry = photometry;
      }
    result.views.push_back(std::move(view));
    result.engine = photometer.engine_name();
    result.warnings = photometer.warnings();
  }
  if (is_coloured && brightest > 0.0 && !is_cancelled(cancel)) {
    PartProgress part(progress, end, 1.0);
    const auto tint = tint_of(design_, brightest_photometry, brightest_setting, &part, cancel);
    if (tint) result.scene.tint = *tint;
    result.complete = result.complete && tint;
  }
  for (RoadView& view : result.views) draw_road(result.scene, view);
  result.elapsed_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

}  // namespace retrace::studies
