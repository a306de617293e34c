#include "studies/image/camera_setup.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <string_view>

#include "core/error.h"
#include "core/number_format.h"
#include "raytrace/observers/photometric_geometry.h"

namespace retrace::studies {
namespace {

using geometry::Vec2, geometry::Vec3;

// Width and height, in mm, of the sheet that is shown for an infinite part if the request contains no size.
constexpr std::array<double, 2> kDefaultFilmMm = {100.0, 100.0};
// Ratio of the width shown in the picture to the width of the part.
constexpr double kMargin = 1.15;
// Maximum luminance of the lamp and of the surroundings, in cd/m^2. OpenEXR files can store values up to 3.4e38.
constexpr double kMaxLuminance = 1e30;

Vec3 to_vec(const std::array<double, 3>& a) {
  return {a[0], a[1], a[2]};
}

std::string text_of(const Vec3& p) {
  return fmt::format("{},{},{}", shortest(p.x()), shortest(p.y()), shortest(p.z()));
}

/// Returns the height of the entrance face above a point in plan. The point must be within the outline of the part.
double face_height(const design::OpticalModel& model, const Vec2& at_mm) {
  return model.entrance ? geometry::height_mm(*model.entrance, at_mm) : model.part.thickness_mm;
}

bool is_inside(const design::OpticalModel& model, const Vec3& p) {
  const geometry::Part& part = model.part;
  if (p.z() < -part.element_depth_mm) return false;
  const geometry::Rectangle box = geometry::bounding_box(part.outline);
  const Vec2 at = p.head<2>() + box.centre();
  for (std::size_t k = 0; k < part.outline.size(); ++k) {
    const Vec2& a = part.outline[k];
    const Vec2 along = part.outline[(k + 1) % part.outline.size()] - a;
    if (along.x() * (at.y() - a.y()) - along.y() * (at.x() - a.x()) < 0.0) return false;
  }
  return p.z() <= face_height(model, at);
}

/// Returns true if a point is on the back side of the sheet, where the body of the part is located.
bool is_behind(const raytrace::Film& film, double thickness_mm, const Vec3& p) {
  if (!film.radius_mm) return p.z() <= thickness_mm;
  const double from_axis = std::hypot(p.x(), p.z() - thickness_mm + *film.radius_mm);
  return *film.radius_mm > 0.0 ? from_axis <= *film.radius_mm : from_axis >= -*film.radius_mm;
}

double shown_width(const CameraRequest& r, const geometry::Part& part) {
  if (r.field_mm) return *r.field_mm;
  const auto [film_x_mm, film_y_mm] = film_of(r);
  const Vec2 size = part.period_mm ? Vec2(film_x_mm, film_y_mm) : geometry::bounding_box(part.outline).size();
  const double aspect = static_cast<double>(r.columns) / static_cast<double>(r.rows);
  return kMargin * std::max(size.x(), size.y() * aspect);
}

}  // namespace

std::array<double, 2> film_of(const CameraRequest& r) {
  return r.film_mm.value_or(kDefaultFilmMm);
}

void check_film(const CameraRequest& r, bool is_infinite) {
  if (!is_infinite) {
    constexpr std::string_view need = "requires a design with array.extent = \"infinite\": ";
    if (r.cylinder_mm)
      throw InputError(Field{"cylinder_mm"}, fmt::format("{}finite parts are always plane in this version", need));
    if (r.film_mm) throw InputError(Field{"film_mm"}, fmt::format("{}a finite part is shown in its own size", need));
    return;
  }
  const double least = film_of(r)[0] / std::numbers::pi;
  if (r.cylinder_mm && std::abs(*r.cylinder_mm) < least)
    throw InputError(
        Field{"cylinder_mm"},
        fmt::format(
            "must be at least {0} or at most -{0}, so that the sheet covers at most half of the cylinder, got {1}",
            shortest(least), shortest(*r.cylinder_mm)));
}

raytrace::CameraScene scene_of(const CameraRequest& r, const std::optional<PhotometricLamp>& lamp,
                               const design::OpticalModel& model, const Vec3& reference_axis) {
  const geometry::Part& part = model.part;
  raytrace::CameraScene scene;
  const raytrace::PhotometricGeometry geometry =
      raytrace::geometry_from({Angle::from_deg(r.v_deg), Angle::from_deg(r.h_deg)}, Angle::from_deg(r.observation_deg),
                              Angle::from_deg(r.rotation_deg));
  const raytrace::PhotometricDirections towards =
      raytrace::in_part_frame(raytrace::directions_of(geometry), reference_axis);
  const Vec2 centre = part.period_mm ? Vec2(Vec2::Zero()) : geometry::bounding_box(part.outline).centre();
  const Vec3 target(0.0, 0.0, face_height(model, centre));
  const double distance_mm = 1e3 * r.distance_m;
  scene.view.target_mm = target;
  scene.view.eye_mm = r.eye_mm ? to_vec(*r.eye_mm) : Vec3(target + distance_mm * towards.to_observer);
  scene.view.up = raytrace::in_part_frame(raytrace::return_frame(geometry), reference_axis).up;
  scene.view.columns = r.columns;
  scene.view.rows = r.rows;
  scene.view.width_mm = shown_width(r, part);
  scene.view.pupil = Angle::from_deg(r.pupil_arcmin / 60.0);
  scene.lamp.position_mm = r.lamp_mm ? to_vec(*r.lamp_mm) : Vec3(target + distance_mm * towards.to_source);
  const double lamp_m = 1e-3 * (scene.lamp.position_mm - target).norm();
  scene.lamp.illuminance_lx =
      lamp ? lamp->intensity.cd(from_aimed(-Vec3::UnitZ(), r.lamp_aim_deg)) / (lamp_m * lamp_m) : r.illuminance_lx;
  scene.lamp.diameter = Angle::from_deg(r.lamp_arcmin / 60.0);
  // A plane that is illuminated by a half space of uniform luminance L has the illuminance pi L.
  scene.surroundings = {r.ambient_lx / std::numbers::pi, r.backlight_lx / std::numbers::pi};
  const auto [film_x_mm, film_y_mm] = film_of(r);
  if (part.period_mm) scene.film = raytrace::Film{film_x_mm, film_y_mm, r.cylinder_mm};
  return scene;
}

double angle_deg(const Vec3& a, const Vec3& b) {
  return Angle::from_rad(std::atan2(a.cross(b).norm(), a.dot(b))).deg();
}

Vec3 to_eye(const raytrace::CameraScene& scene) {
  return scene.view.eye_mm - scene.view.target_mm;
}

Vec3 to_lamp(const raytrace::CameraScene& scene) {
  return scene.lamp.position_mm - scene.view.target_mm;
}

void check_position(const design::OpticalModel& model, const raytrace::CameraScene& scene, const Vec3& position,
                    Field field, const char* what) {
  const bool bad = scene.film ? is_behind(*scene.film, model.part.thickness_mm, position) : is_inside(model, position);
  if (bad)
    throw InputError(field,
                     fmt::format("the {} must be outside the {}, got {} mm", what,
                                 scene.film ? "body, in front of the entrance face" : "part", text_of(position)));
  if (position == scene.view.target_mm) throw InputError(field, "must differ from the point that the camera looks at");
}

void check_luminances(const raytrace::CameraScene& scene, bool has_file) {
  const double width_rad = std::max(scene.lamp.diameter.rad(), scene.view.pupil.rad());
  const double lamp = scene.lamp.illuminance_lx / (0.25 * std::numbers::pi * width_rad * width_rad);
  const auto check = [](double luminance, std::string_view field, std::string_view what) {
    if (!(luminance > kMaxLuminance)) return;
    throw InputError(Field{field}, fmt::format("the luminance of {} must be at most {} cd/m2, so that pictures can "
                                               "contain it, got {:.3g} cd/m2",
                                               what, shortest(kMaxLuminance), luminance));
  };
  check(scene.surroundings.entrance_side, "ambient_lx", "the surroundings");
  check(scene.surroundings.back_side, "backlight_lx", "the surroundings");
  check(lamp, has_file ? "lamp" : "illuminance_lx", "the lamp");
}

}  // namespace retrace::studies
