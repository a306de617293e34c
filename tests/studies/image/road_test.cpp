// Tests of the road at night: positions of objects, angles, illuminances, luminances of the road, and coefficients of
// retroreflection from the far field.
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "core/srgb.h"
#include "raytrace/observers/photometric_geometry.h"
#include "report/results/result_plots.h"
#include "studies/image/road_study.h"
#include "studies/photometry/photometer.h"
#include "tests/support/designs.h"
#include "tests/support/refusals.h"

namespace retrace::testing::road_test {
namespace {

using namespace geometry;
using namespace studies;
using std::numbers::pi;

/// Expected values for one reflector and one lamp, computed independently from the heights and distances of RoadScene.
/// Reflectors are at (-+0.72, 0.6, 0), lamps at (-+0.6, 0.65, D), and the eye is at (-0.35, 1.2, D + 1.8), in m.
struct RoadRow {
  double distance_m;
  std::size_t reflector;  ///< 0: left, 1: right
  std::size_t lamp;
  double observation_deg;
  double illuminance_lx;  ///< illuminance from a lamp of 10,000 cd
  double viewing_deg;     ///< angle between the direction to the eye and the normal of the reflector
};
constexpr std::array<RoadRow, 12> kRows = {{{10, 0, 0, 2.847349387, 99.983102856, 3.418687},
                                            {10, 0, 1, 6.294526744, 98.285024606, 3.418687},
                                            {10, 1, 0, 3.507183342, 98.285024606, 5.935224},
                                            {10, 1, 1, 5.196165008, 99.983102856, 5.935224},
                                            {30, 0, 0, 1.078080933, 11.110902473, 1.269869},
                                            {30, 0, 1, 2.098433774, 11.089610820, 1.269869},
                                            {30, 1, 0, 1.149240820, 11.089610820, 2.209195},
                                            {30, 1, 1, 1.962802204, 11.110902473, 2.209195},
                                            {100, 0, 0, 0.339063853, 0.999998310, 0.396737},
                                            {100, 0, 1, 0.629146704, 0.999825540, 0.396737},
                                            {100, 1, 0, 0.345299745, 0.999825540, 0.690411},
                                            {100, 1, 1, 0.616489872, 0.999998310, 0.690411}}};

/// Returns a design with prisms that are so small that diffraction sends light in all directions.
design::Design design() {
  design::Design d;
  d.part() = infinite(RtpElement{0.1, 0.1}, Arrangement::aligned, 0.5);
  d.part().angle_errors.dihedral_error_arcmin[0] = 10.0;
  d.substance.refractive_index = kPmma;
  return d;
}

const RoadResult& road() {
  static const RoadResult result = [] { return RoadStudy(design(), {}).run(); }();
  return result;
}

const RoadReflector& reflector_of(const RoadRow& row) {
  for (const RoadView& view : road().views)
    if (view.distance_m == row.distance_m) return view.reflectors[row.reflector];
  throw std::logic_error("no such view");
}

TEST(Road, AnglesAndIlluminancesAreThoseOfThePlaces) {
  for (const RoadRow& row : kRows) {
    const RoadReflector& reflector = reflector_of(row);
    EXPECT_NEAR(reflector.observation_deg[row.lamp], row.observation_deg, 1e-8);
    EXPECT_NEAR(reflector.illuminance_lx[row.lamp], row.illuminance_lx, 1e-7);
  }
}

/// The luminance is the sum over both lamps: L = sum of R_A E / cos nu.
TEST(Road, LuminanceIsThatOfBothLamps) {
  for (std::size_t k = 0; k < kRows.size(); k += 2) {
    const RoadReflector& reflector = reflector_of(kRows[k]);
    double sum = 0.0;
    for (const std::size_t lamp : {0U, 1U})
      sum += reflector.r_a[lamp] * kRows[k + lamp].illuminance_lx / std::cos(kRows[k].viewing_deg * pi / 180.0);
    EXPECT_GT(sum, 0.0);
    EXPECT_NEAR(reflector.luminance, sum, 1e-6 * sum);
  }
}

/// Returns the geometry of a goniometer with the given directions to lamp and eye. The angle epsilon is found by trying
/// values, so that the test uses no code of the road. The part is rotated about its normal, which is z.
raytrace::PhotometricGeometry goniometer(double observation_deg, const Vec3& to_lamp, const Vec3& to_eye) {
  const auto at = [&](double deg) {
    const double a = deg * pi / 180.0;
    const Vec3 s(std::cos(a) * to_lamp.x() - std::sin(a) * to_lamp.y(),
                 std::sin(a) * to_lamp.x() + std::cos(a) * to_lamp.y(), to_lamp.z());
    return raytrace::geometry_from({Angle::from_rad(std::asin(s.y())), Angle::from_rad(std::atan2(s.x(), s.z()))},
                                   Angle::from_deg(observation_deg), Angle::from_deg(deg));
  };
  const auto miss = [&](double deg) {
    const raytrace::PhotometricDirections towards = raytrace::directions_of(at(deg));
    return (towards.to_observer - to_eye).norm() + (towards.to_source - to_lamp).norm();
  };
  double best = 0.0;
  for (double deg = -180.0; deg < 180.0; deg += 1.0)
    if (miss(deg) < miss(best)) best = deg;
  for (double step = 0.5; step > 1e-10; step *= 0.5)
    for (const double other : {best - step, best + step})
      if (miss(other) < miss(best)) best = other;
  EXPECT_LT(miss(best), 1e-9);
  return at(best);
}

/// The photometer is set up by hand for the left reflector and the right lamp. Its R_A must equal the value of the
/// road.
TEST(Road, CoefficientsAreThoseOfTheFarField) {
  const double distance_m = 30.0;
  const Vec3 to_lamp = Vec3(0.6 + 0.72, 0.05, distance_m).normalized();
  const Vec3 to_eye = Vec3(-0.35 + 0.72, 0.6, distance_m + 1.8).normalized();
  const RoadRow& row = kRows[5];
  const raytrace::PhotometricGeometry geometry = goniometer(row.observation_deg, to_lamp, to_eye);
  const raytrace::EntranceAngles entrance = raytrace::entrance_angles(geometry);
  PhotometerSetting setting;
  setting.v_deg = entrance.v.deg();
  setting.h_deg = entrance.h.deg();
  setting.observation_deg = {row.observation_deg};
  setting.rotation_deg = geometry.epsilon.deg();
  PhotometrySettings request;
  request.area_cm2 = 1.0;
  request.apertures = {Angle::from_rad(0.15 / distance_m), Angle::from_rad(0.007 / (distance_m + 1.8))};
  request.window_deg = 10.0;
  const auto readings = Photometer(design(), request, 1).measure({setting}, nullptr, nullptr);
  ASSERT_TRUE(readings);
  const double expected = readings->front().r_a.front();
  EXPECT_GT(expected, 0.0);
  EXPECT_NEAR(reflector_of(row).r_a[row.lamp], expected, 1e-5 * expected);
}

/// Pinhole camera of a scene with a car, computed by hand: the eye is at (-0.35, 1.2, D + 1.8) and looks horizontally
/// at the centre of the car. The horizon is at 42 % of the height.
struct HandCamera {
  Vec3 eye, forward, right;
  double pixel;
  Vec2 ahead;

  HandCamera(const RoadScene& scene, double distance_m)
      : eye(-0.35, 1.2, distance_m + 1.8),
        forward(Vec3(0.35, 0.0, -eye.z()).normalized()),
        right(-forward.z(), 0.0, forward.x()),
        pixel(2.0 * std::tan(0.5 * scene.field_deg * pi / 180.0) / static_cast<double>(scene.columns)),
        ahead(0.5 * static_cast<double>(scene.columns), 0.42 * static_cast<double>(scene.rows)) {}

  Vec2 position_of(const Vec3& point) const {
    const Vec3 way = point - eye;
    return {ahead.x() + way.dot(right) / way.dot(forward) / pixel, ahead.y() - way.y() / way.dot(forward) / pixel};
  }
  Vec3 direction_at(const Vec2& position) const {
    return forward + pixel * (position.x() - ahead.x()) * right - pixel * (position.y() - ahead.y()) * Vec3::UnitY();
  }
  double solid_angle(const Vec2& position) const {
    return pixel * pixel / std::pow(direction_at(position).norm(), 3.0);
  }
};

Vec2 centre_of(const RoadScene& scene, std::size_t k) {
  return {static_cast<double>(k % scene.columns) + 0.5, static_cast<double>(k / scene.columns) + 0.5};
}

/// In the picture, the reflectors have the positions and sizes given by a pinhole projection, even if they are smaller
/// than a pixel.
TEST(Road, ReflectorsAreDrawnWhereTheyAre) {
  RoadScene scene;
  struct Picture {
    double distance_m, field_deg;
    double tolerance;  ///< for the centroid, in pixels; larger for a reflector within one pixel
  };
  for (const auto& [distance_m, field_deg, tolerance] :
       {Picture{10.0, 9.0, 0.05}, Picture{30.0, 3.2, 0.05}, Picture{100.0, 13.0, 0.5}}) {
    scene.field_deg = field_deg;
    RoadView view;
    view.distance_m = distance_m;
    view.reflectors.resize(2);
    view.reflectors[0].luminance = view.reflectors[1].luminance = 1.0;
    draw_road(scene, view);
    const HandCamera camera(scene, distance_m);
    for (const double side : {-1.0, 1.0}) {
      const Vec3 centre(side * 0.72, 0.6, 0.0);
      const Vec2 expected = camera.position_of(centre);
      double solid_angle = 0.0;
      Vec2 sum = Vec2::Zero();
      double pixels = 0.0;
      for (std::size_t k = 0; k < view.picture.reflected.size(); ++k) {
        const Vec2 at = centre_of(scene, k);
        if (side * (at.x() - camera.position_of({0.0, 0.6, 0.0}).x()) < 0.0) continue;
        sum += view.picture.reflected[k] * at;
        pixels += view.picture.reflected[k];
        solid_angle += view.picture.reflected[k] * camera.solid_angle(at);
      }
      EXPECT_NEAR((sum / pixels - expected).norm(), 0.0, tolerance) << distance_m;
      // Solid angle of a reflector of 12 cm x 2.5 cm.
      const Vec3 way = centre - camera.eye;
      EXPECT_NEAR(solid_angle / (0.12 * 0.025 * camera.eye.z() / std::pow(way.norm(), 3.0)), 1.0, 1e-3) << distance_m;
    }
  }
}

TEST(Road, CornersAreThoseOfAProjectionByHand) {
  for (const RoadView& view : road().views) {
    const HandCamera camera(road().scene, view.distance_m);
    for (const double side : {-1.0, 1.0})
      for (const double x : {-0.06, 0.06})
        for (const double y : {-0.0125, 0.0125}) {
          const Vec3 corner(side * 0.72 + x, 0.6 + y, 0.0);
          EXPECT_NEAR((view.camera.position_of(corner) - camera.position_of(corner)).norm(), 0.0, 1e-9);
        }
  }
}

/// The luminous intensity in the picture, L dOmega d^2 summed over the pixels, is the sum of R_I E over both lamps.
TEST(Road, IntensityInThePictureIsThatOfThePhotometer) {
  for (std::size_t k = 0; k < kRows.size(); k += 2) {
    const RoadReflector& reflector = reflector_of(kRows[k]);
    const double side = kRows[k].reflector == 0 ? -1.0 : 1.0;
    double expected = 0.0;
    for (const std::size_t lamp : {0U, 1U})
      expected += 0.12 * 0.025 * reflector.r_a[lamp] * kRows[k + lamp].illuminance_lx;
    EXPECT_NEAR(reflector.intensity_cd / expected, 1.0, 1e-9);
    for (const RoadView& view : road().views) {
      if (view.distance_m != kRows[k].distance_m) continue;
      const HandCamera camera(road().scene, view.distance_m);
      const double middle = camera.position_of({0.0, 0.6, 0.0}).x();
      double intensity_cd = 0.0;
      for (std::size_t p = 0; p < view.picture.reflected.size(); ++p) {
        const Vec2 at = centre_of(road().scene, p);
        if (side * (at.x() - middle) > 0.0) intensity_cd += view.picture.reflected[p] * camera.solid_angle(at);
      }
      intensity_cd *= (Vec3(side * 0.72, 0.6, 0.0) - camera.eye).squaredNorm();
      EXPECT_NEAR(intensity_cd / expected, 1.0, 2e-3) << view.distance_m;
    }
  }
}

/// A pixel of the road has the luminance k E_h / (mu_0 + mu) of the law of Lommel and Seeliger, where E_h = I mu_0 /
/// d^2 is the illuminance by a headlamp, and k follows from R_L in the 30 m geometry. The night sky adds 0.02 lx on a
/// diffuse surface of the reflectance 0.07.
TEST(Road, LuminanceOfTheRoadIsTheClosedForm) {
  RoadScene scene;
  RoadView view;
  view.distance_m = 100.0;
  view.reflectors.resize(2);
  draw_road(scene, view);
  const HandCamera camera(scene, view.distance_m);
  const double mu_lamp = 0.65 / std::hypot(0.65, 30.0);
  const double mu_eye = 1.2 / std::hypot(1.2, 30.0);
  const double k = 0.015 * (mu_lamp + mu_eye) / mu_lamp;
  for (const double ahead_m : {12.0, 25.0, 60.0}) {
    const Vec2 position = camera.position_of({0.3, 0.0, 100.0 - ahead_m});
    const auto column = static_cast<std::size_t>(position.x());
    const auto row = static_cast<std::size_t>(position.y());
    const Vec3 direction = camera.direction_at(Vec2(static_cast<double>(column) + 0.5, static_cast<double>(row) + 0.5));
    const Vec3 at = camera.eye - 1.2 / direction.y() * direction;
    double expected = 0.07 / pi * 0.02;
    for (const double side : {-0.6, 0.6}) {
      const Vec3 to_lamp = Vec3(side, 0.65, 100.0) - at;
      const double mu_0 = to_lamp.y() / to_lamp.norm();
      const double mu = 1.2 / (camera.eye - at).norm();
      const double illuminance_lx = 10'000.0 * mu_0 / to_lamp.squaredNorm();
      expected += k * illuminance_lx / (mu_0 + mu);
    }
    EXPECT_NEAR(view.picture.luminance[row * scene.columns + column] / expected, 1.0, 1e-6) << ahead_m;
  }
}

/// In the geometry that defines R_L, the luminance is R_L E.
TEST(Road, LuminanceInTheThirtyMetreGeometryIsRl) {
  const RoadScene scene;
  const Vec3 lamp(0.0, 0.65, 30.0);
  const Vec3 at = Vec3::Zero();
  const double illuminance_lx = 10'000.0 / (0.65 * 0.65 + 900.0);
  EXPECT_NEAR(illuminance(scene, lamp, at), illuminance_lx, 1e-12);
  EXPECT_NEAR(road_luminance(scene, lamp, {0.0, 1.2, 30.0}, at, 0.15), 0.15 * illuminance_lx, 1e-12);
  EXPECT_EQ(road_luminance(scene, lamp, {0.0, 1.2, 30.0}, {0.0, 0.0, 31.0}, 0.15), 0.0) << "behind the lamp";
}

/// Colours have the luminance of their pixels. Reflected light and veil together are at most this luminance.
TEST(Road, ColoursHaveTheLuminanceOfThePixels) {
  for (const RoadView& view : road().views)
    for (std::size_t k = 0; k < view.picture.luminance.size(); k += 7) {
      const RoadPixels& pixels = view.picture;
      EXPECT_NEAR(srgb_luminance(pixels.rgb[k]), pixels.luminance[k], 1e-9 * pixels.luminance[k]);
      EXPECT_LE(pixels.reflected[k] + pixels.veil[k], pixels.luminance[k] * (1.0 + 1e-12));
      EXPECT_GT(pixels.luminance[k], 0.0);
    }
}

RoadRequest sign_request() {
  RoadRequest request;
  request.mount = "sign";
  return request;
}

/// A black line at 2 % to 5 % of the smaller side from the border and the arrow return no light.
TEST(Road, AreaOfASignLacksTheLineAndTheArrow) {
  RoadRequest request = sign_request();
  request.outline = "rectangle";
  request.reflector_mm = {800.0, 600.0};
  request.symbol = "none";
  const auto inner = [](double by) { return (0.8 - 2.0 * by) * (0.6 - 2.0 * by); };
  const double plain = inner(0.0) - inner(0.012) + inner(0.03);
  EXPECT_NEAR(scene_of(request, {}).area(), plain, 1e-12);
  request.symbol = "arrow";
  EXPECT_NEAR(scene_of(request, {}).area(), plain - (0.24 * 0.74 + 0.5 * 0.84 * 0.68) * 0.27 * 0.27, 1e-12);
  EXPECT_NEAR(scene_of(request, {}).reflectors.at(0).y(), 2.2, 1e-12);
  request.symbol = "none";
  request.reflector_mm = {600.0, 600.0};
  request.outline = "octagon";
  const auto octagon = [](double by) { return 8.0 * std::tan(pi / 8.0) * std::pow(0.3 - by, 2.0); };
  EXPECT_NEAR(scene_of(request, {}).area(), octagon(0.0) - octagon(0.012) + octagon(0.03), 1e-12);
  request.outline = "triangle";
  const double inradius = 2.0 * 0.18 / (0.6 + 2.0 * std::hypot(0.3, 0.6));
  const auto triangle = [&](double by) { return 0.18 * std::pow(1.0 - by / inradius, 2.0); };
  EXPECT_NEAR(scene_of(request, {}).area(), triangle(0.0) - triangle(0.012) + triangle(0.03), 1e-12);
}

/// Returns the intensity in cd of the first reflector in the picture, divided by its projected area in m^2.
double intensity_over_projected_area(const RoadScene& scene, const RoadView& view) {
  const Vec3 way = scene.reflectors[0] - view.camera.eye;
  double intensity_cd = 0.0;
  for (std::size_t k = 0; k < view.picture.reflected.size(); ++k)
    intensity_cd += view.picture.reflected[k] * view.camera.solid_angle(k) * way.squaredNorm();
  return intensity_cd / (scene.area() * std::abs(way.z()) / way.norm());
}

/// The intensity of a sign in the picture is that of its retroreflective area, at distances at which the black line is
/// wider and narrower than a pixel.
TEST(Road, IntensityOfASignInThePictureIsThatOfItsArea) {
  RoadRequest request = sign_request();
  request.field_deg = 24.0;
  const RoadScene scene = scene_of(request, {});
  for (const double distance_m : {15.0, 60.0, 300.0}) {
    RoadView view;
    view.distance_m = distance_m;
    view.reflectors.resize(1);
    view.reflectors[0].luminance = 1.0;
    draw_road(scene, view);
    EXPECT_NEAR(intensity_over_projected_area(scene, view), 1.0, 3e-3) << distance_m;
    EXPECT_EQ(*std::ranges::max_element(view.inset.reflected), 1.0) << "the inset shows the sign";
  }
}

/// A finite design has its own outline and size, unless another outline or size is requested.
TEST(Road, FiniteDesignsHaveTheirOwnOutline) {
  const Polygon hexagon = {{40, 10}, {50, 20}, {50, 40}, {40, 50}, {30, 40}, {30, 20}};
  RoadRequest request;
  const RoadScene own = scene_of(request, {hexagon});
  EXPECT_NEAR(own.area(), 1e-6 * geometry::area(hexagon), 1e-15);
  EXPECT_NEAR(own.size().x(), 0.02, 1e-15);
  EXPECT_NEAR(own.size().y(), 0.04, 1e-15);
  EXPECT_NEAR((geometry::bounding_box(own.outline).centre()).norm(), 0.0, 1e-15);
  request.reflector_mm = {60.0, 20.0};
  EXPECT_NEAR(scene_of(request, {hexagon}).area(), 1e-6 * geometry::area(hexagon) * 3.0 * 0.5, 1e-15);
  request.outline = "rectangle";
  EXPECT_NEAR(scene_of(request, {hexagon}).area(), 0.06 * 0.02, 1e-15);
}

/// The area of a reflector with a notch is the sum of the areas of its convex polygons. A sign needs a convex outline.
TEST(Road, NotchesReturnNoLight) {
  const std::vector<Polygon> angle = {{{0, 0}, {60, 0}, {60, 20}, {0, 20}}, {{0, 20}, {20, 20}, {20, 40}, {0, 40}}};
  RoadRequest request;
  const RoadScene scene = scene_of(request, angle);
  EXPECT_NEAR(scene.area(), 1600e-6, 1e-15);
  EXPECT_NEAR(geometry::area(scene.outline), 2000e-6, 1e-15);
  RoadView view;
  view.distance_m = 20.0;
  view.reflectors.resize(2);
  view.reflectors[0].luminance = 1.0;
  draw_road(scene, view);
  EXPECT_NEAR(intensity_over_projected_area(scene, view), 1.0, 3e-3);
  request.mount = "sign";
  EXPECT_EQ(refusal_of([&] { scene_of(request, angle); }), "outline");
}

TEST(Road, ImpossiblePositionsAreRefused) {
  const auto field = [](RoadRequest request, auto change) {
    change(request);
    return refusal_of([&] { scene_of(request, {}); });
  };
  EXPECT_EQ(field(sign_request(), [](RoadRequest& r) { r.mast_m = 2.1; }), "mast_m");
  EXPECT_EQ(field(sign_request(), [](RoadRequest& r) { r.reflector_height_m = 0.29; }), "reflector_height_m");
  EXPECT_EQ(field({}, [](RoadRequest& r) { r.reflector_height_m = 1.45; }), "reflector_height_m");
  EXPECT_EQ(field({}, [](RoadRequest& r) { r.lateral_m = 0.05; }), "lateral_m");
  EXPECT_EQ(field({}, [](RoadRequest& r) { r.lateral_m = -0.5; }), "lateral_m");
  EXPECT_EQ(field({}, [](RoadRequest& r) { r.lateral_m = 0.85; }), "lateral_m");
  EXPECT_EQ(field({}, [](RoadRequest& r) { r.reflector_mm = {900.0, 20.0}; }), "reflector_mm");
}

/// Returns the bytes of a rectangle of a PNG file. The file is wider than the rectangle.
std::vector<std::uint8_t> part_of(const std::string& png, std::size_t left, std::size_t top, std::size_t columns,
                                  std::size_t rows) {
  OIIO::Filesystem::IOMemReader memory(png.data(), png.size());
  const auto input = OIIO::ImageInput::open("picture.png", nullptr, &memory);
  if (!input) throw std::runtime_error(OIIO::geterror());
  const OIIO::ImageSpec spec = input->spec();
  const auto width = static_cast<std::size_t>(spec.width * spec.nchannels);
  std::vector<std::uint8_t> pixels(width * static_cast<std::size_t>(spec.height));
  input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::UINT8, pixels.data());
  std::vector<std::uint8_t> part;
  for (std::size_t row = top; row < top + rows; ++row) {
    const auto from =
        pixels.begin() + static_cast<std::ptrdiff_t>(row * width + left * static_cast<std::size_t>(spec.nchannels));
    part.insert(part.end(), from, from + static_cast<std::ptrdiff_t>(columns) * spec.nchannels);
  }
  return part;
}

/// Each view has the same pixels in its own file and in the file of all views, although the automatic exposures of
/// single views would differ.
TEST(Road, SeriesHasOneExposure) {
  const std::string all = report::road_png(road());
  for (const std::size_t view : {0U, 2U}) {
    const std::string one = report::road_view_png(road(), view);
    EXPECT_EQ(part_of(one, 18, 51, 640, 440), part_of(all, 18 + view * 658, 51, 640, 440));
    RoadResult single = road();
    single.views = {road().views[view]};
    EXPECT_NE(part_of(one, 18, 51, 640, 440), part_of(report::road_png(single), 18, 51, 640, 440));
    single.request.exposure_ev = 3.0;
    RoadResult given = road();
    given.request.exposure_ev = 3.0;
    EXPECT_EQ(part_of(report::road_png(single), 18, 51, 640, 440),
              part_of(report::road_view_png(given, view), 18, 51, 640, 440));
  }
}

}  // namespace
}  // namespace retrace::testing::road_test
