#include "studies/image/road_picture.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>

#include "core/srgb.h"
#include "core/threads.h"
#include "raytrace/observers/pixel_grid.h"

namespace retrace::studies {
namespace {

using geometry::Polygon, geometry::Vec2, geometry::Vec3, std::numbers::pi;

using Tint = std::array<double, 3>;

// Illustrative colours of surfaces in white light. Their luminances are set to 1 before use.
constexpr Tint kGrey{1.0, 1.0, 1.0}, kSkyBlue{0.55, 0.85, 1.9}, kGrass{0.85, 1.05, 0.60}, kNavy{0.62, 0.90, 1.55};
constexpr Tint kLens{2.6, 0.35, 0.30};
// Illustrative diffuse reflectances of paint, glass, tyres, plastics, licence plates, galvanised masts and black film.
constexpr double kPaint = 0.045, kGlass = 0.006, kTyre = 0.010, kPlastic = 0.014, kTailLamp = 0.022, kPlate = 0.35,
                 kMast = 0.22, kBlack = 0.02;
// Illustrative diffuse reflectances in the light of the sky, and R_L of the verge relative to that of the asphalt.
constexpr double kAsphalt = 0.07, kMarking = 0.3, kVerge = 0.06, kVergeOfAsphalt = 0.7;
// Illustrative luminances of the night sky near a town, at the zenith and at the horizon, and of distant trees, in
// cd/m^2.
constexpr double kZenith = 0.003, kHorizon = 0.06, kTrees = 0.0015;
constexpr double kGlowHeight_deg = 3.5;  ///< elevation at which the glow of the horizon has fallen to 1/e
constexpr double kNightLight = 0.02;     ///< illuminance by the night sky from all directions, lx
constexpr double kFarthest = 3000.0;     ///< length of the road, m
constexpr double kNearest = 0.5;         ///< distance from the eye at which surfaces are clipped, m

/// Returns the luminance of light scattered in the eye, per illuminance at the pupil, in 1/sr. It is 10 divided by the
/// squared angle in degrees (W. S. Stiles 1929, L. L. Holladay 1927; CIE 146:2002).
/// \param angle2 squared angle from the source, in rad^2
/// \param min_angle2 squared angle, in rad^2, that replaces all smaller values of `angle2`
double veil_per_lx(double angle2, double min_angle2) {
  constexpr double kDegPerRad = 180.0 / pi;
  return 10.0 / (std::max(angle2, min_angle2) * kDegPerRad * kDegPerRad);
}

/// Part of a reflector, as a source of light that is scattered in the eye.
struct Glow {
  Vec3 towards;           ///< direction of the part, as a unit vector
  double fraction = 0.0;  ///< fraction of the reflector's area
};

/// Divides a reflector into parts that are small compared with the range of scattered light.
/// \param cell_rad receives the angular size of a part
std::vector<Glow> glows_of(const RoadScene& s, const Vec3& centre, const Vec3& eye, double& cell_rad) {
  constexpr double kCell_deg = 0.1;
  constexpr double kMaxCells = 8.0;
  const double distance = (centre - eye).norm();
  const geometry::Rectangle box = geometry::bounding_box(s.outline);
  const auto cells_over = [&](double length) {
    return static_cast<int>(std::clamp(std::ceil(length / distance / (kCell_deg * pi / 180.0)), 1.0, kMaxCells));
  };
  const int columns = cells_over(box.size().x());
  const int rows = cells_over(box.size().y());
  const Vec2 cell = box.size().cwiseQuotient(Vec2(columns, rows));
  cell_rad = cell.maxCoeff() / distance;
  const std::vector<Polygon> face = s.face();
  std::vector<Glow> glows;
  for (int k = 0; k < columns * rows; ++k) {
    const Vec2 lower = box.lower + cell.cwiseProduct(Vec2(k % columns, k / columns));
    const geometry::Rectangle part{lower, lower + cell};
    const auto within = [&](const Polygon& polygon) { return geometry::area(geometry::clip(polygon, part, 0.0)); };
    double area = 0.0;
    for (const Polygon& polygon : face) area += within(polygon);
    for (const Polygon& polygon : s.black) area -= within(polygon);
    for (const Polygon& polygon : s.windows) area += within(polygon);
    const Vec2 middle = part.centre();
    if (area > 0.0) glows.push_back({(centre + Vec3(middle.x(), middle.y(), 0.0) - eye).normalized(), area / s.area()});
  }
  return glows;
}

Tint normalised(Tint tint) {
  const double luminance = srgb_luminance(tint);
  for (double& value : tint) value /= luminance;
  return tint;
}

RoadCamera camera_towards(const RoadScene& s, const Vec3& eye, const Vec3& direction) {
  RoadCamera camera;
  camera.eye = eye;
  camera.forward = direction.normalized();
  camera.right = camera.forward.cross(Vec3::UnitY()).normalized();
  camera.up = camera.right.cross(camera.forward);
  camera.columns = s.columns;
  camera.rows = s.rows;
  return camera;
}

/// Returns the camera of the inset. The last reflector, or the sign, fills half of the width or height of the inset.
RoadCamera inset_camera_at(const RoadScene& s, const RoadCamera& camera) {
  const Vec3& target = s.reflectors.back();
  RoadCamera inset = camera_towards(s, camera.eye, target - camera.eye);
  inset.columns = std::max<std::size_t>(1, static_cast<std::size_t>(0.27 * static_cast<double>(s.columns)));
  inset.rows = std::max<std::size_t>(1, 2 * inset.columns / 3);
  inset.ahead = 0.5 * Vec2(static_cast<double>(inset.columns), static_cast<double>(inset.rows));
  const Vec2 shown = s.size().cwiseQuotient(inset.ahead) / (target - camera.eye).norm();
  inset.pixel = std::min(shown.maxCoeff(), camera.pixel);
  return inset;
}

/// Paints surfaces onto a picture; later surfaces cover earlier ones. The fraction of a pixel that a surface covers is
/// computed exactly.
class Painter {
 public:
  /// Light that a surface sends to the eye.
  struct Light {
    double luminance = 0.0;
    Tint tint = kGrey;
  };
  /// Function that returns the light from the centre of a pixel, given its direction.
  using Surface = std::function<Light(const Vec3& direction)>;

  Painter(const RoadCamera& camera, RoadPixels& pixels)
      : camera_(camera),
        pixels_(pixels),
        grid_({Vec2::Zero(), Vec2(static_cast<double>(camera.columns), static_cast<double>(camera.rows))},
              camera.columns, camera.rows) {
    pixels.luminance.assign(grid_.size(), 0.0);
    pixels.reflected.assign(grid_.size(), 0.0);
    pixels.veil.assign(grid_.size(), 0.0);
    pixels.rgb.assign(grid_.size(), {0.0, 0.0, 0.0});
  }

  void background(const Surface& surface) {
    for_each_in_parallel(camera_.rows, [&](std::size_t row) {
      for (std::size_t k = row * camera_.columns; k < (row + 1) * camera_.columns; ++k)
        blend(k, 1.0, surface(camera_.direction_of(k)));
    });
  }
  /// \param polygon convex polygon in the picture, in pixels
  void area(const Polygon& polygon, const Surface& surface) {
    cover(polygon, [&](std::size_t k, double fraction) { blend(k, fraction, surface(camera_.direction_of(k))); });
  }
  /// \param polygon convex polygon in the scene
  void solid(const std::vector<Vec3>& polygon, const Surface& surface) { area(projected(polygon), surface); }
  /// Draws a reflector with black parts.
  /// \param face convex polygons that make up the reflector, in the scene
  /// \param black convex polygons within the reflector that return no light
  /// \param windows convex polygons within the black polygons that return light
  void reflector(const std::vector<std::vector<Vec3>>& face, const std::vector<std::vector<Vec3>>& black,
                 const std::vector<std::vector<Vec3>>& windows, const Light& light, const Surface& black_surface) {
    struct Fractions {
      double all = 0.0, bright = 0.0;
    };
    std::map<std::size_t, Fractions> fractions;
    for (const auto& part : face)
      cover(projected(part), [&](std::size_t k, double fraction) {
        Fractions& of_pixel = fractions[k];
        of_pixel.all = of_pixel.bright = std::min(1.0, of_pixel.all + fraction);
      });
    for (const auto& part : black)
      cover(projected(part), [&](std::size_t k, double fraction) { fractions[k].bright -= fraction; });
    for (const auto& part : windows)
      cover(projected(part), [&](std::size_t k, double fraction) { fractions[k].bright += fraction; });
    for (const auto& [k, of_pixel] : fractions) {
      const double bright = std::clamp(of_pixel.bright, 0.0, of_pixel.all);
      blend(k, of_pixel.all, {});
      add_to(k, bright, light);
      if (bright < of_pixel.all) add_to(k, of_pixel.all - bright, black_surface(camera_.direction_of(k)));
      pixels_.reflected[k] += bright * light.luminance;
    }
  }
  void add_veil(std::size_t k, const Light& light) {
    add_to(k, 1.0, light);
    pixels_.veil[k] += light.luminance;
  }

  const RoadCamera& camera() const { return camera_; }

 private:
  void blend(std::size_t k, double fraction, const Light& light) {
    pixels_.luminance[k] = std::lerp(pixels_.luminance[k], light.luminance, fraction);
    pixels_.reflected[k] *= 1.0 - fraction;
    for (std::size_t c = 0; c < 3; ++c)
      pixels_.rgb[k][c] = std::lerp(pixels_.rgb[k][c], light.luminance * light.tint[c], fraction);
  }
  void add_to(std::size_t k, double fraction, const Light& light) {
    pixels_.luminance[k] += fraction * light.luminance;
    for (std::size_t c = 0; c < 3; ++c) pixels_.rgb[k][c] += fraction * light.luminance * light.tint[c];
  }
  /// Calls `add` for each pixel that a polygon covers, with the covered fraction of its area.
  void cover(Polygon polygon, const std::function<void(std::size_t, double)>& add) const {
    if (polygon.size() < 3) return;
    for (Vec2& point : polygon) point.y() = static_cast<double>(camera_.rows) - point.y();
    if (geometry::area(polygon) < 0.0) std::ranges::reverse(polygon);
    grid_.cover(polygon, [&](std::size_t k, double fraction) { add(k, std::min(fraction, 1.0)); });
  }
  /// Returns a polygon in the picture, clipped at the smallest distance from the eye.
  Polygon projected(const std::vector<Vec3>& polygon) const {
    Polygon result;
    const auto distance = [&](const Vec3& point) { return (point - camera_.eye).dot(camera_.forward) - kNearest; };
    for (std::size_t k = 0; k < polygon.size(); ++k) {
      const Vec3& from = polygon[k];
      const Vec3& to = polygon[(k + 1) % polygon.size()];
      const double a = distance(from);
      const double b = distance(to);
      if (a >= 0.0) result.push_back(camera_.position_of(from));
      if ((a >= 0.0) != (b >= 0.0)) result.push_back(camera_.position_of(from + a / (a - b) * (to - from)));
    }
    return result;
  }

  const RoadCamera& camera_;
  RoadPixels& pixels_;
  raytrace::PixelGrid grid_;
};

/// Returns a polygon with round corners.
/// \param radius distance from a corner at which the rounding begins; at most half of a side
Polygon rounded(const Polygon& polygon, double radius) {
  constexpr int kSteps = 8;
  Polygon result;
  const std::size_t count = polygon.size();
  for (std::size_t k = 0; k < count; ++k) {
    const Vec2& corner = polygon[k];
    const auto towards = [&](const Vec2& other) {
      const double length = (other - corner).norm();
      return Vec2(corner + std::min(radius, 0.5 * length) / length * (other - corner));
    };
    const Vec2 from = towards(polygon[(k + count - 1) % count]);
    const Vec2 to = towards(polygon[(k + 1) % count]);
    for (int step = 0; step <= kSteps; ++step) {
      const double t = static_cast<double>(step) / kSteps;
      result.push_back((1.0 - t) * (1.0 - t) * from + 2.0 * t * (1.0 - t) * corner + t * t * to);
    }
  }
  return result;
}

Polygon box(double x, double y, double half_width, double half_height) {
  return {{x - half_width, y - half_height},
          {x + half_width, y - half_height},
          {x + half_width, y + half_height},
          {x - half_width, y + half_height}};
}

/// Returns a symmetric trapezoid.
Polygon trapezoid(double lower_half, double upper_half, double lower, double upper) {
  return {{-lower_half, lower}, {lower_half, lower}, {upper_half, upper}, {-upper_half, upper}};
}

/// The surfaces of a scene in the light of the headlamps and the night sky.
class Surfaces {
 public:
  Surfaces(const RoadScene& s, const RoadView& view, Painter& painter)
      : s_(s), view_(view), painter_(painter), lamps_(lamps_at(s, view.distance_m)), eye_(painter.camera().eye) {}

  void sky() {
    painter_.background([](const Vec3& d) {
      const double up_deg = std::max(0.0, std::asin(d.y())) * 180.0 / pi;
      return Painter::Light{kZenith + (kHorizon - kZenith) * std::exp(-up_deg / kGlowHeight_deg), normalised(kSkyBlue)};
    });
    trees();
  }

  void road() {
    const double horizon = row_of_horizon();
    const double columns = static_cast<double>(painter_.camera().columns);
    const double rows = static_cast<double>(painter_.camera().rows);
    if (horizon < rows)
      painter_.area({{0.0, horizon}, {columns, horizon}, {columns, rows + 1.0}, {0.0, rows + 1.0}},
                    ground(kVergeOfAsphalt * s_.asphalt_r_l, kVerge, normalised(kGrass)));
    const double right = 0.5 * s_.lane_width;
    const double left = -1.5 * s_.lane_width;
    const double near = eye_.z();
    strip(left - s_.shoulder_width, right + s_.shoulder_width, near, -kFarthest,
          ground(s_.asphalt_r_l, kAsphalt, kGrey));
    const Painter::Surface marking = ground(s_.marking_r_l, kMarking, kGrey);
    const double half_line = 0.5 * s_.line_width;
    for (const double x : {left, right}) strip(x - half_line, x + half_line, near, -kFarthest, marking);
    for (double z = s_.dash_period * std::floor(near / s_.dash_period); z > -kFarthest; z -= s_.dash_period)
      strip(-right - half_line, -right + half_line, z + s_.dash_length, z, marking);
  }

  void car() {
    const double half = 0.5 * s_.car_width;
    const double roof = s_.car_tall;
    const double waist = 0.95;
    for (const double side : {-1.0, 1.0}) {
      draw_diffuse(rounded(box(side * (half - 0.17), 0.17, 0.105, 0.17), 0.04), kTyre, kGrey);
      draw_diffuse(rounded(box(side * (half + 0.02), 0.985, 0.075, 0.045), 0.035), kPaint, kNavy);
    }
    draw_diffuse(rounded(trapezoid(half - 0.05, 0.60, waist - 0.12, roof), 0.14), kPaint, kNavy);
    draw_diffuse(rounded(trapezoid(half - 0.16, 0.555, waist + 0.04, roof - 0.085), 0.07), kGlass, kGrey);
    draw_diffuse(rounded(trapezoid(half - 0.03, half - 0.02, 0.20, waist + 0.03), 0.09), kPaint, kNavy);
    draw_diffuse(rounded(trapezoid(half - 0.005, half - 0.005, 0.28, 0.80), 0.12), kPaint, kNavy);
    // Bumper with a dark lower part, joint of the tail gate, tail lamps and licence plate.
    draw_diffuse(rounded(trapezoid(half - 0.09, half - 0.04, 0.165, 0.31), 0.05), kPlastic, kGrey);
    draw_diffuse(box(0.0, 0.668, half - 0.03, 0.004), kPlastic, kGrey);
    for (const double side : {-1.0, 1.0})
      draw_diffuse(rounded(box(side * (half - 0.125), 0.815, 0.105, 0.085), 0.04), kTailLamp, kLens);
    draw_diffuse(rounded(box(0.0, 0.785, 0.285, 0.075), 0.02), kPlastic, kGrey);
    draw_diffuse(rounded(box(0.0, 0.785, 0.26, 0.055), 0.01), kPlate, kGrey);
  }

  void sign() {
    const Vec3& centre = s_.reflectors.front();
    const double half = 0.5 * s_.mast_width;
    // The mast is a cylinder behind the sign, so that it is darker towards its edges.
    const double behind = -half - 0.02;
    const double x = centre.x();
    std::vector<Vec3> mast = {{x - half, 0.0, behind},
                              {x + half, 0.0, behind},
                              {x + half, s_.mast_height, behind},
                              {x - half, s_.mast_height, behind}};
    painter_.solid(mast, [this, x, half, behind](const Vec3& d) {
      const Vec3 at = on_plane(d, behind);
      const double across = std::clamp((at.x() - x) / half, -1.0, 1.0);
      return Painter::Light{kMast / pi * std::sqrt(1.0 - 0.95 * across * across) * illuminance_at(at), kGrey};
    });
  }

  void reflectors() {
    for (std::size_t k = 0; k < s_.reflectors.size(); ++k) {
      const Vec2 position = s_.reflectors[k].head<2>();
      if (s_.mount == RoadMount::car) {
        const Vec2 size = s_.size();
        const Vec2 housing = size + Vec2(0.016, 0.016);
        Polygon frame = s_.outline;
        for (Vec2& point : frame) point = point.cwiseProduct(housing.cwiseQuotient(size));
        draw_diffuse(geometry::moved(frame, position), kPlastic, kGrey);
      }
      const auto placed = [&](const std::vector<Polygon>& polygons) {
        std::vector<std::vector<Vec3>> result;
        for (const Polygon& polygon : polygons) result.push_back(at_reflectors(geometry::moved(polygon, position)));
        return result;
      };
      painter_.reflector(placed(s_.face()), placed(s_.black), placed(s_.windows),
                         {view_.reflectors.at(k).luminance, s_.tint}, diffuse(kBlack, kGrey));
    }
  }

  /// Adds the veil, which is light from the reflectors that is scattered in the eye.
  void veil() {
    constexpr double kMinAngle_deg = 0.2;
    for (std::size_t k = 0; k < s_.reflectors.size(); ++k) {
      const double at_pupil_lx = view_.reflectors.at(k).intensity_cd / (s_.reflectors[k] - eye_).squaredNorm();
      double cell_rad = 0.0;
      const std::vector<Glow> glows = glows_of(s_, s_.reflectors[k], eye_, cell_rad);
      const double min_angle2 = std::pow(std::max(kMinAngle_deg * pi / 180.0, cell_rad), 2.0);
      for_each_in_parallel(painter_.camera().rows, [&](std::size_t row) {
        const std::size_t columns = painter_.camera().columns;
        for (std::size_t pixel = row * columns; pixel < (row + 1) * columns; ++pixel) {
          const Vec3 direction = painter_.camera().direction_of(pixel);
          double sum = 0.0;
          for (const Glow& glow : glows)
            sum += glow.fraction * veil_per_lx((direction - glow.towards).squaredNorm(), min_angle2);
          painter_.add_veil(pixel, {at_pupil_lx * sum, s_.tint});
        }
      });
    }
  }

 private:
  static std::vector<Vec3> at_reflectors(const Polygon& polygon) {
    std::vector<Vec3> result;
    for (const Vec2& point : polygon) result.emplace_back(point.x(), point.y(), 0.0);
    return result;
  }

  /// Returns the row of the horizon. The camera has no roll, so that the horizon is horizontal in the picture.
  double row_of_horizon() const {
    const RoadCamera& camera = painter_.camera();
    const Vec3 level = Vec3(camera.forward.x(), 0.0, camera.forward.z()).normalized();
    return camera.position_of(Vec3(camera.eye + level)).y();
  }

  /// Draws the outline of distant trees over the sky.
  void trees() {
    const double horizon = row_of_horizon();
    const RoadCamera& camera = painter_.camera();
    const Painter::Surface dark = [](const Vec3&) { return Painter::Light{kTrees, kGrey}; };
    for (std::size_t column = 0; column < camera.columns; ++column) {
      const double x = static_cast<double>(column);
      const Vec3 d = camera.direction_at(Vec2(x + 0.5, horizon));
      const double azimuth_deg = std::atan2(d.x(), -d.z()) * 180.0 / pi;
      // The heights of the trees are a sum of waves without a common period, which looks irregular. Trees are lower
      // near the end of the road.
      double height_deg = 0.62;
      double frequency = 0.43;
      double amplitude = 0.24;
      for (int k = 0; k < 7; ++k) {
        height_deg += amplitude * std::sin(frequency * azimuth_deg + 1.7 * k * k);
        frequency *= 2.17;
        amplitude *= 0.62;
      }
      const double open = azimuth_deg * azimuth_deg / (azimuth_deg * azimuth_deg + 2.0);
      const double tall = std::max(0.05, height_deg) * (0.25 + 0.75 * open) * pi / 180.0 / camera.pixel;
      painter_.area({{x, horizon + 1.0}, {x + 1.0, horizon + 1.0}, {x + 1.0, horizon - tall}, {x, horizon - tall}},
                    dark);
    }
  }

  void strip(double left, double right, double near, double far, const Painter::Surface& surface) {
    painter_.solid({{left, 0.0, near}, {right, 0.0, near}, {right, 0.0, far}, {left, 0.0, far}}, surface);
  }

  /// Returns the surface of the ground. Its luminance is that of headlamps, by road_luminance(), and of the night sky.
  Painter::Surface ground(double r_l, double reflectance, const Tint& tint) const {
    return [this, r_l, reflectance, tint](const Vec3& d) {
      // The centre of a pixel that contains the horizon may be above it.
      const Vec3 at = eye_ + eye_.y() / std::max(-d.y(), eye_.y() / kFarthest) * d;
      double luminance = reflectance / pi * kNightLight;
      for (const Vec3& lamp : lamps_) luminance += road_luminance(s_, lamp, eye_, {at.x(), 0.0, at.z()}, r_l);
      return Painter::Light{luminance, tint};
    };
  }

  Vec3 on_plane(const Vec3& d, double z) const { return eye_ + (z - eye_.z()) / d.z() * d; }

  /// Returns the illuminance in lx of a vertical surface that faces the driver.
  double illuminance_at(const Vec3& at) const {
    double sum = 0.5 * kNightLight;
    for (const Vec3& lamp : lamps_) sum += illuminance(s_, lamp, at) * (lamp - at).normalized().z();
    return sum;
  }

  /// Returns a diffuse surface in the plane of the reflectors.
  Painter::Surface diffuse(double reflectance, const Tint& colour) const {
    return [this, reflectance, tint = normalised(colour)](const Vec3& d) {
      const Vec3 at = on_plane(d, 0.0);
      return Painter::Light{reflectance / pi * shading(at) * illuminance_at(at), tint};
    };
  }
  /// Draws a diffuse surface in the plane of the reflectors.
  void draw_diffuse(const Polygon& polygon, double reflectance, const Tint& colour) {
    painter_.solid(at_reflectors(polygon), diffuse(reflectance, colour));
  }

  /// Returns an illustrative factor by which the sides and the upper part of the car's rear are darker, because they
  /// are inclined.
  double shading(const Vec3& at) const {
    if (s_.mount != RoadMount::car) return 1.0;
    const double across = std::min(1.0, std::abs(at.x()) / (0.5 * s_.car_width));
    const double up = std::clamp(at.y() / s_.car_tall, 0.0, 1.0);
    return (1.0 - 0.45 * std::pow(across, 6.0)) * (1.0 - 0.35 * std::pow(up, 3.0));
  }

  const RoadScene& s_;
  const RoadView& view_;
  Painter& painter_;
  std::array<Vec3, 2> lamps_;
  Vec3 eye_;
};

void paint(const RoadScene& scene, const RoadView& view, const RoadCamera& camera, RoadPixels& pixels) {
  Painter painter(camera, pixels);
  Surfaces surfaces(scene, view, painter);
  surfaces.sky();
  surfaces.road();
  switch (scene.mount) {
    case RoadMount::car: surfaces.car(); break;
    case RoadMount::sign: surfaces.sign(); break;
  }
  surfaces.reflectors();
  surfaces.veil();
}

}  // namespace

Vec2 RoadCamera::position_of(const Vec3& point) const {
  const Vec3 way = point - eye;
  const double along = way.dot(forward) * pixel;
  return {ahead.x() + way.dot(right) / along, ahead.y() - way.dot(up) / along};
}

Vec3 RoadCamera::direction_at(const Vec2& position) const {
  const Vec2 off = pixel * (position - ahead);
  return (forward + off.x() * right - off.y() * up).normalized();
}

Vec3 RoadCamera::direction_of(std::size_t k) const {
  return direction_at(Vec2(static_cast<double>(k % columns) + 0.5, static_cast<double>(k / columns) + 0.5));
}

double RoadCamera::solid_angle(std::size_t k) const {
  return pixel * pixel * std::pow(direction_of(k).dot(forward), 3.0);
}

RoadCamera camera_at(const RoadScene& s, double distance_m) {
  const Vec3 eye = eye_at(s, distance_m);
  // The camera is rotated until a sign is within this fraction of the half width.
  constexpr double kWithin = 0.7;
  const double half_field = 0.5 * s.field_deg * pi / 180.0;
  const double ahead = std::atan2(-eye.x(), eye.z());
  double azimuth = ahead;
  double top = 0.0;
  if (s.mount == RoadMount::sign) {
    const Vec3& centre = s.reflectors.front();
    const double to_sign = std::atan2(centre.x() - eye.x(), eye.z());
    azimuth = std::clamp(ahead, to_sign - kWithin * half_field, to_sign + kWithin * half_field);
    top = (centre.y() + 0.5 * s.size().y() - eye.y()) / std::hypot(centre.x() - eye.x(), eye.z());
  }
  RoadCamera camera = camera_towards(s, eye, {std::sin(azimuth), 0.0, -std::cos(azimuth)});
  camera.pixel = 2.0 * std::tan(half_field) / static_cast<double>(s.columns);
  const double rows = static_cast<double>(s.rows);
  const double horizon = std::clamp(top / camera.pixel + 0.06 * rows, 0.42 * rows, 0.85 * rows);
  camera.ahead = {0.5 * static_cast<double>(s.columns), horizon};
  return camera;
}

const char* reflector_name(const RoadView& view, std::size_t k) {
  return view.reflectors.size() == 1 ? "sign" : (k == 0 ? "left" : "right");
}

void draw_road(const RoadScene& scene, RoadView& view) {
  view.camera = camera_at(scene, view.distance_m);
  view.inset_camera = inset_camera_at(scene, view.camera);
  paint(scene, view, view.camera, view.picture);
  paint(scene, view, view.inset_camera, view.inset);
}

}  // namespace retrace::studies
