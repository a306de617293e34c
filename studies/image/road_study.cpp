#include "studies/image/road_study.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>

#include "core/error.h"
#include "core/task_progress.h"
#include "core/threads.h"
#include "materials/io/spectrum_reader.h"
#include "requests/descriptions.h"
#include "studies/image/io/lamp_reader.h"
#include "studies/photometry/io/standard_reader.h"
#include "studies/photometry/photometer.h"

namespace retrace::studies {
namespace {

using geometry::Vec2, geometry::Vec3, std::numbers::pi;

// Number of sample points of a pixel along each side.
constexpr int kFiner = 4;

// Diffuse reflectances, typical of dark paint, glass, tyres, asphalt, and white paint on plates and lines.
constexpr double kPaint = 0.025, kGlass = 0.004, kTyre = 0.012, kAsphalt = 0.05, kWhite = 0.3;
constexpr double kNightSky = 0.002;   ///< luminance of an overcast sky over inhabited land, cd/m^2
constexpr double kNightLight = 0.02;  ///< illuminance by the night sky from all directions, lx

/// Returns the luminance of light scattered in the eye, per illuminance at the pupil, in 1/sr. It is 10 / theta^2 with
/// theta in degrees (W. S. Stiles 1929, L. L. Holladay 1927; CIE 146:2002). Below 0.2 degrees, it is constant.
double veil_per_lx(double theta_deg) {
  constexpr double kLeast = 0.2;
  return 10.0 / std::pow(std::max(theta_deg, kLeast), 2.0);
}

struct Quad {
  Vec2 lower;
  Vec2 upper;
  bool holds(const Vec2& p) const {
    return p.x() >= lower.x() && p.y() >= lower.y() && p.x() <= upper.x() && p.y() <= upper.y();
  }
};

Quad quad(double x, double y, double half_width, double half_height) {
  return {{x - half_width, y - half_height}, {x + half_width, y + half_height}};
}

std::array<Vec3, 2> lamps_at(const RoadScene& s, double distance_m) {
  return {Vec3(-s.lamp_half_gap, s.lamp_height, distance_m), Vec3(s.lamp_half_gap, s.lamp_height, distance_m)};
}

Vec3 eye_at(const RoadScene& s, double distance_m) {
  return {s.eye_right, s.eye_height, distance_m + s.eye_behind};
}

Vec3 reflector_position(const RoadScene& s, std::size_t side) {
  return {side == 0 ? -s.reflector_half_gap : s.reflector_half_gap, s.reflector_height, 0.0};
}

/// Returns the reflectance of the car's rear at a point. Returns nothing if the point is outside the outline of the
/// car.
std::optional<double> car_reflectance(const RoadScene& s, const Vec2& p) {
  const double half = 0.5 * s.car_width;
  for (const double side : {-1.0, 1.0})
    if (quad(side * (half - 0.16), 0.16, 0.11, 0.16).holds(p)) return kTyre;
  const double sill = 0.22;
  const double shoulder = 0.92;
  if (p.y() < sill || p.y() > s.car_tall) return std::nullopt;
  // The cabin becomes narrower towards the roof.
  const double slope = p.y() > shoulder ? 0.28 * (p.y() - shoulder) / (s.car_tall - shoulder) : 0.0;
  // The corners are round.
  const double corner = 0.12;
  const double down = std::max(0.0, sill + corner - p.y());
  const double up = std::max(0.0, p.y() - s.car_tall + corner);
  const double inset = corner - std::sqrt(std::max(0.0, corner * corner - std::pow(std::max(down, up), 2.0)));
  if (std::abs(p.x()) > half - slope - inset) return std::nullopt;
  if (p.y() > shoulder + 0.06 && p.y() < s.car_tall - 0.09 && std::abs(p.x()) < half - slope - 0.13) return kGlass;
  if (quad(0.0, 0.72, 0.26, 0.055).holds(p)) return kWhite;  // licence plate
  for (const double side : {-1.0, 1.0})
    if (quad(side * (half - 0.17), 0.78, 0.13, 0.10).holds(p)) return 0.5 * kPaint;  // unlit lamps
  return kPaint;
}

double road_reflectance(const RoadScene& s, const Vec3& p) {
  const double lane = 3.5;
  const bool on_edge = std::abs(p.x() - 0.5 * lane) < 0.06;
  const bool on_middle = std::abs(p.x() + 0.5 * lane) < 0.06 && std::fmod(std::abs(p.z()) + 1000.0, 12.0) < 4.0;
  static_cast<void>(s);
  return on_edge || on_middle ? kWhite : kAsphalt;
}

/// Returns the intensity of a headlamp towards a point. Without a lamp file, it is that of a dipped beam, which falls
/// to one tenth above the horizon.
double intensity(const RoadScene& s, const Vec3& lamp, const Vec3& at) {
  const Vec3 way = at - lamp;
  if (s.lamp) return s.lamp->intensity.cd(from_aimed(way, s.lamp_aim_deg));
  const double rise_deg = std::atan2(way.y(), std::abs(way.z())) * 180.0 / pi;
  return way.z() < 0.0 ? std::clamp(0.55 - 1.5 * rise_deg, 0.1, 1.0) * s.lamp_cd : 0.0;
}

/// Returns the illuminance of a surface by the headlamps and the night sky.
double illuminance(const RoadScene& s, const std::array<Vec3, 2>& lamps, const Vec3& at, const Vec3& normal) {
  double sum = kNightLight;
  for (const Vec3& lamp : lamps) {
    const Vec3 way = lamp - at;
    const double cosine = std::max(0.0, normal.dot(way.normalized()));
    sum += intensity(s, lamp, at) * cosine / way.squaredNorm();
  }
  return sum;
}

struct Seen {
  double luminance = 0.0;
  double coloured = 0.0;
};

Seen seen_along(const RoadScene& s, const RoadView& view, const std::array<Vec3, 2>& lamps, const Vec3& eye,
                const Vec3& direction) {
  if (direction.z() < 0.0) {
    const Vec3 at = eye - eye.z() / direction.z() * direction;
    const Vec2 on_rear = at.head<2>();
    for (std::size_t side = 0; side < 2; ++side) {
      const Vec3 position = reflector_position(s, side);
      if (quad(position.x(), position.y(), 0.5 * s.reflector_width, 0.5 * s.reflector_tall).holds(on_rear))
        return {view.reflectors[side].luminance, view.reflectors[side].luminance};
    }
    if (const auto reflectance = car_reflectance(s, on_rear))
      return {*reflectance / pi * illuminance(s, lamps, at, Vec3::UnitZ()), 0.0};
  }
  if (direction.y() >= 0.0) return {kNightSky, 0.0};
  const Vec3 ground = eye - eye.y() / direction.y() * direction;
  return {road_reflectance(s, ground) / pi * illuminance(s, lamps, ground, Vec3::UnitY()), 0.0};
}

/// Adds the veil, which is light from the reflectors that is scattered in the eye.
void add_veil(const RoadScene& s, RoadView& view, double degrees_per_pixel,
              const std::function<Vec2(const Vec3&)>& pixel_of) {
  const Vec3 eye = eye_at(s, view.distance_m);
  const double area = s.reflector_width * s.reflector_tall;
  for (std::size_t side = 0; side < 2; ++side) {
    const Vec3 position = reflector_position(s, side);
    const Vec3 way = position - eye;
    const double at_pupil_lx =
        view.reflectors[side].luminance * area * std::abs(way.normalized().z()) / way.squaredNorm();
    const Vec2 centre = pixel_of(position);
    for (std::size_t k = 0; k < view.luminance.size(); ++k) {
      const Vec2 pixel(static_cast<double>(k % s.columns) + 0.5, static_cast<double>(k / s.columns) + 0.5);
      const double veil = at_pupil_lx * veil_per_lx((pixel - centre).norm() * degrees_per_pixel);
      view.luminance[k] += veil;
      view.coloured[k] += veil;
    }
  }
}

}  // namespace

void draw_road(const RoadScene& s, RoadView& view) {
  const std::array<Vec3, 2> lamps = lamps_at(s, view.distance_m);
  const Vec3 eye = eye_at(s, view.distance_m);
  // The view is horizontal and towards the centre of the car. The horizon is a little above the centre of the picture.
  const double pixel = 2.0 * std::tan(0.5 * s.field_deg * pi / 180.0) / static_cast<double>(s.columns);
  const double middle_row = 0.42 * static_cast<double>(s.rows);
  const double half_columns = 0.5 * static_cast<double>(s.columns);
  const Vec3 forward = Vec3(-eye.x(), 0.0, -eye.z()).normalized();
  const Vec3 right = forward.cross(Vec3::UnitY());
  const Vec2 level(half_columns, middle_row);
  view.luminance.assign(s.columns * s.rows, 0.0);
  view.coloured.assign(s.columns * s.rows, 0.0);
  for_each_in_parallel(s.rows, [&](std::size_t row) {
    for (std::size_t column = 0; column < s.columns; ++column) {
      Seen sum;
      for (int k = 0; k < kFiner * kFiner; ++k) {
        const Vec2 at(static_cast<double>(column) + (k % kFiner + 0.5) / kFiner,
                      static_cast<double>(row) + (k / kFiner + 0.5) / kFiner);
        const Vec2 off = pixel * (at - level);
        const Vec3 direction = (forward + off.x() * right - off.y() * Vec3::UnitY()).normalized();
        const Seen seen = seen_along(s, view, lamps, eye, direction);
        sum.luminance += seen.luminance / (kFiner * kFiner);
        sum.coloured += seen.coloured / (kFiner * kFiner);
      }
      view.luminance[row * s.columns + column] = sum.luminance;
      view.coloured[row * s.columns + column] = sum.coloured;
    }
  });
  add_veil(s, view, s.field_deg / static_cast<double>(s.columns), [&](const Vec3& position) {
    const Vec3 way = position - eye;
    const double along = way.dot(forward);
    return Vec2(level + Vec2(way.dot(right), -way.y()) / along / pixel);
  });
}

RoadStudy::RoadStudy(design::Design design, RoadRequest request)
    : design_(std::move(design)), request_(std::move(request)) {
  design::require_supported(design_, {.what = "retrace image", .solids = true, .wet_backs = true});
  requests::check(request_);
  scene_.lamp_height = request_.lamp_height_m;
  scene_.lamp_cd = request_.lamp_cd;
  scene_.lamp_aim_deg = request_.lamp_aim_deg;
  if (!request_.lamp.empty()) scene_.lamp = read_lamp(request_.lamp, Field{"lamp"});
  const std::filesystem::path dye = dye_file_of(request_.dye, false, {});
  if (dye.empty()) return;
  scene_.dye = request_.dye;
  dye_absorption_per_mm_ = materials::read_spectral_absorption(dye);
}

namespace {

struct Pair {
  std::size_t side = 0;
  std::size_t lamp = 0;
};

PhotometrySettings photometry_at(const RoadScene& s, double distance_m, std::uint32_t seed) {
  PhotometrySettings request;
  request.area_cm2 = 1e4 * s.reflector_width * s.reflector_tall;
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

}  // namespace

RoadResult RoadStudy::run(Progress* progress, const Cancellation* cancel) const {
  const auto start = std::chrono::steady_clock::now();
  RoadResult result;
  result.design = design_;
  result.request = request_;
  result.scene = scene_;
  const double share = 1.0 / static_cast<double>(request_.distance_m.size());
  for (const double distance_m : request_.distance_m) {
    PhotometrySettings photometry = photometry_at(scene_, distance_m, request_.seed);
    photometry.dye_absorption_per_mm = dye_absorption_per_mm_;
    photometry.dye = scene_.dye;
    Photometer photometer(design_, photometry, 1);
    const std::array<Vec3, 2> lamps = lamps_at(result.scene, distance_m);
    const Vec3 eye = eye_at(result.scene, distance_m);
    std::vector<PhotometerSetting> settings;
    for (const auto& [side, lamp] : {Pair{0, 0}, Pair{0, 1}, Pair{1, 0}, Pair{1, 1}}) {
      // The reflector is mounted on the car without rotation, so that its axes are those of the scene.
      const Vec3 reflector = reflector_position(result.scene, side);
      settings.push_back(setting_of({(lamps[lamp] - reflector).normalized(), (eye - reflector).normalized()}));
    }
    const auto done = static_cast<double>(result.views.size());
    PartProgress part(progress, share * done, share * (done + 1.0));
    const auto readings = measured(photometer, settings, &part, cancel);
    if (!readings) {
      result.complete = false;
      break;
    }
    RoadView view;
    view.distance_m = distance_m;
    for (std::size_t k = 0; k < 4; ++k) {
      const std::size_t side = k / 2;
      const std::size_t lamp = k % 2;
      RoadReflector& reflector = view.reflectors[side];
      reflector.observation_deg[lamp] = settings[k].observation_deg.front();
      reflector.r_a[lamp] = (*readings)[k].r_a.front();
      const Vec3 position = reflector_position(result.scene, side);
      // Without a lamp file, `lamp_cd` is the intensity towards the reflectors.
      const double cd = scene_.lamp ? intensity(scene_, lamps[lamp], position) : scene_.lamp_cd;
      reflector.illuminance_lx[lamp] = cd / (lamps[lamp] - position).squaredNorm();
      reflector.luminance += (*readings)[k].r_l.front() * reflector.illuminance_lx[lamp];
    }
    draw_road(result.scene, view);
    result.views.push_back(std::move(view));
    result.engine = photometer.engine_name();
    result.warnings = photometer.warnings();
  }
  result.elapsed_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

}  // namespace retrace::studies
