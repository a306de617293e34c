#include "studies/image/road_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <string_view>
#include <utility>

#include "core/error.h"
#include "core/number_format.h"
#include "geometry/outline/convex_decomposition.h"

namespace retrace::studies {
namespace {

using geometry::Polygon, geometry::Vec2, geometry::Vec3, std::numbers::pi;

// Heights and distance that define R_L of the road, in m. This is the 30 m geometry of retroreflectometers for
// markings.
constexpr double kReferenceLamp = 0.65, kReferenceEye = 1.2, kReferenceDistance = 30.0;
// Distances of the outer and the inner side of the black line from the border of a sign, as fractions of the smaller
// side of the sign.
constexpr double kLineFrom = 0.02, kLineTo = 0.05;

struct Defaults {
  Vec2 size_mm;
  double height_m;
  double lateral_m;
  std::string_view outline;
};

Defaults defaults_of(RoadMount mount) {
  switch (mount) {
    case RoadMount::car: return {{120.0, 25.0}, 0.6, 0.72, "rectangle"};
    case RoadMount::sign: return {{600.0, 600.0}, 2.2, 4.0, "ellipse"};
  }
  return {};
}

/// Returns an outline in the square from -0.5 to 0.5.
Polygon unit_outline(std::string_view name) {
  if (name == "triangle") return {{-0.5, -0.5}, {0.5, -0.5}, {0.0, 0.5}};
  if (name == "rectangle") return {{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}};
  const bool is_octagon = name == "octagon";
  const int count = is_octagon ? 8 : 72;
  // The sides of the octagon, not its corners, touch the square.
  const double radius = is_octagon ? 0.5 / std::cos(pi / count) : 0.5;
  Polygon polygon;
  for (int k = 0; k < count; ++k) {
    const double angle = 2.0 * pi * (k + 0.5) / count;
    polygon.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
  }
  return polygon;
}

Polygon scaled(Polygon polygon, const Vec2& factors) {
  for (Vec2& point : polygon) point = point.cwiseProduct(factors);
  return polygon;
}

/// Returns a convex polygon whose sides are moved inwards.
/// \param by distance by which the sides are moved
Polygon inset(const Polygon& polygon, double by) {
  const std::size_t count = polygon.size();
  const auto side = [&](std::size_t k) {
    const Vec2 along = (polygon[(k + 1) % count] - polygon[k]).normalized();
    const Vec2 inwards(-along.y(), along.x());
    return std::pair<Vec2, Vec2>(polygon[k] + by * inwards, along);
  };
  Polygon result;
  for (std::size_t k = 0; k < count; ++k) {
    const auto [from, along] = side((k + count - 1) % count);
    const auto [to, next] = side(k);
    const double turn = along.x() * next.y() - along.y() * next.x();
    const Vec2 gap = to - from;
    result.push_back(turn > 0.0 ? Vec2(from + (gap.x() * next.y() - gap.y() * next.x()) / turn * along) : to);
  }
  return result;
}

/// Returns the distance from a point within a convex polygon to its nearest side.
double inner_radius(const Polygon& polygon, const Vec2& centre) {
  double radius = 1e9;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vec2 along = (polygon[(k + 1) % polygon.size()] - polygon[k]).normalized();
    const Vec2 to = centre - polygon[k];
    radius = std::min(radius, along.x() * to.y() - along.y() * to.x());
  }
  return radius;
}

/// Returns an arrow that points upwards and fits into a circle.
std::vector<Polygon> arrow(const Vec2& centre, double radius) {
  const Polygon shaft = {{-0.12, -0.66}, {0.12, -0.66}, {0.12, 0.08}, {-0.12, 0.08}};
  const Polygon head = {{-0.42, 0.08}, {0.42, 0.08}, {0.0, 0.76}};
  std::vector<Polygon> parts;
  for (const Polygon& part : {shaft, head}) parts.push_back(geometry::moved(scaled(part, {radius, radius}), centre));
  return parts;
}

void check_on_car(const RoadScene& scene, double height_m, double lateral_m) {
  const Vec2 half = 0.5 * scene.size();
  if (4.0 * half.x() > scene.car_width || 2.0 * half.y() > scene.car_tall)
    throw InputError(Field{"reflector_mm"}, fmt::format("must fit side by side on the rear of a car of {} m x {} m, "
                                                        "got {} mm x {} mm",
                                                        shortest(scene.car_width), shortest(scene.car_tall),
                                                        fixed(2e3 * half.x(), 1), fixed(2e3 * half.y(), 1)));
  if (lateral_m < half.x() || lateral_m > 0.5 * scene.car_width - half.x())
    throw InputError(Field{"lateral_m"},
                     fmt::format("must be {} to {}, so that the reflectors do not overlap and are on the car, got {}",
                                 fixed(half.x(), 4), fixed(0.5 * scene.car_width - half.x(), 4), shortest(lateral_m)));
  if (height_m > scene.car_tall - half.y())
    throw InputError(Field{"reflector_height_m"},
                     fmt::format("must be at most {}, so that the reflectors are on the car, got {}",
                                 fixed(scene.car_tall - half.y(), 4), shortest(height_m)));
}

/// Adds the position, the black line, the symbol and the mast of a sign to a scene that contains the sign's outline.
void add_sign(const RoadRequest& request, const Vec2& size_mm, double height_m, double lateral_m, RoadScene& scene) {
  if (!scene.pieces.empty())
    throw InputError(Field{"outline"},
                     "must be the outline of the sign, because the design has notches or holes, got \"auto\"");
  scene.reflectors = {{lateral_m, height_m, 0.0}};
  const double side = 1e-3 * size_mm.minCoeff();
  scene.black = {inset(scene.outline, kLineFrom * side)};
  scene.windows = {inset(scene.outline, kLineTo * side)};
  const Vec2 centre = geometry::centroid(scene.windows[0]);
  if (request.symbol == "arrow")
    for (const Polygon& part : arrow(centre, inner_radius(scene.windows[0], centre))) scene.black.push_back(part);
  scene.mast_height = request.mast_m.value_or(height_m + 0.5e-3 * size_mm.y());
  scene.mast_width = std::min(scene.mast_width, 0.4 * scene.size().x());
  if (scene.mast_height < height_m)
    throw InputError(Field{"mast_m"}, fmt::format("must be at least the height of the centre of the sign, {}, got {}",
                                                  shortest(height_m), shortest(scene.mast_height)));
}

/// Returns the convex hull of one or more convex polygons. A single polygon is returned unchanged.
Polygon hull_of(const std::vector<Polygon>& polygons) {
  if (polygons.size() == 1) return polygons.front();
  std::vector<Vec2> corners;
  for (const Polygon& polygon : polygons) corners.insert(corners.end(), polygon.begin(), polygon.end());
  return geometry::convex_hull(std::move(corners));
}

}  // namespace

Vec2 RoadScene::size() const {
  return geometry::bounding_box(outline).size();
}

double RoadScene::area() const {
  double sum = 0.0;
  for (const Polygon& part : face()) sum += geometry::area(part);
  for (const Polygon& part : black) sum -= geometry::area(part);
  for (const Polygon& part : windows) sum += geometry::area(part);
  return sum;
}

RoadScene scene_of(const RoadRequest& request, const std::vector<Polygon>& design_face_mm) {
  RoadScene scene;
  scene.mount = request.mount == "sign" ? RoadMount::sign : RoadMount::car;
  scene.lamp_height = request.lamp_height_m;
  scene.lamp_cd = request.lamp_cd;
  scene.lamp_aim_deg = request.lamp_aim_deg;
  scene.eye_height = request.eye_height_m;
  scene.asphalt_r_l = 1e-3 * request.asphalt_mcd;
  scene.marking_r_l = 1e-3 * request.marking_mcd;
  scene.columns = request.columns;
  scene.rows = request.rows;
  scene.field_deg = request.field_deg;

  const Defaults defaults = defaults_of(scene.mount);
  const bool is_own = request.outline == "auto" && !design_face_mm.empty();
  Vec2 size_mm = defaults.size_mm;
  Polygon unit = unit_outline(request.outline == "auto" ? defaults.outline : std::string_view(request.outline));
  std::vector<Polygon> unit_pieces;
  if (!design_face_mm.empty()) {
    const Polygon hull_mm = hull_of(design_face_mm);
    const geometry::Rectangle box = geometry::bounding_box(hull_mm);
    size_mm = box.size();
    const auto in_unit = [&](const Polygon& polygon) {
      return scaled(geometry::moved(polygon, -box.centre()), box.size().cwiseInverse());
    };
    if (is_own) unit = in_unit(hull_mm);
    if (is_own && design_face_mm.size() > 1)
      std::ranges::transform(design_face_mm, std::back_inserter(unit_pieces), in_unit);
  }
  if (request.reflector_mm) size_mm = {(*request.reflector_mm)[0], (*request.reflector_mm)[1]};
  scene.outline = scaled(unit, 1e-3 * size_mm);
  for (const Polygon& piece : unit_pieces) scene.pieces.push_back(scaled(piece, 1e-3 * size_mm));

  const double height_m = request.reflector_height_m.value_or(defaults.height_m);
  const double lateral_m = request.lateral_m.value_or(defaults.lateral_m);
  if (height_m < 0.5e-3 * size_mm.y())
    throw InputError(Field{"reflector_height_m"},
                     fmt::format("must be at least {}, so that the lower edge is above the road, got {}",
                                 fixed(0.5e-3 * size_mm.y(), 4), shortest(height_m)));
  if (scene.mount == RoadMount::car) {
    check_on_car(scene, height_m, lateral_m);
    scene.reflectors = {{-lateral_m, height_m, 0.0}, {lateral_m, height_m, 0.0}};
    return scene;
  }
  add_sign(request, size_mm, height_m, lateral_m, scene);
  return scene;
}

std::array<Vec3, 2> lamps_at(const RoadScene& s, double distance_m) {
  return {Vec3(-s.lamp_half_gap, s.lamp_height, distance_m), Vec3(s.lamp_half_gap, s.lamp_height, distance_m)};
}

Vec3 eye_at(const RoadScene& s, double distance_m) {
  return {s.eye_right, s.eye_height, distance_m + s.eye_behind};
}

double intensity(const RoadScene& s, const Vec3& lamp, const Vec3& at) {
  const Vec3 direction = at - lamp;
  if (direction.z() >= 0.0) return 0.0;
  return s.lamp ? s.lamp->intensity.cd(from_aimed(direction, s.lamp_aim_deg)) : s.lamp_cd;
}

double illuminance(const RoadScene& s, const Vec3& lamp, const Vec3& at) {
  return intensity(s, lamp, at) / (at - lamp).squaredNorm();
}

double road_luminance(const RoadScene& s, const Vec3& lamp, const Vec3& eye, const Vec3& at, double r_l) {
  // Fraction mu_0 / (mu_0 + mu), where mu_0 and mu are the cosines of the angles of lamp and eye from the vertical.
  const auto fraction = [](double lamp_cosine, double eye_cosine) { return lamp_cosine / (lamp_cosine + eye_cosine); };
  static const double reference = fraction(kReferenceLamp / std::hypot(kReferenceLamp, kReferenceDistance),
                                           kReferenceEye / std::hypot(kReferenceEye, kReferenceDistance));
  const double lamp_cosine = (lamp - at).normalized().y();
  const double eye_cosine = (eye - at).normalized().y();
  if (!(lamp_cosine > 0.0) || !(eye_cosine > 0.0)) return 0.0;
  return r_l * fraction(lamp_cosine, eye_cosine) / reference * illuminance(s, lamp, at);
}

}  // namespace retrace::studies
