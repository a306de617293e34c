// Tests of the road at night: positions of objects, angles, illuminances, and coefficients of retroreflection from the
// far field.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "raytrace/observers/photometric_geometry.h"
#include "studies/image/road_study.h"
#include "studies/photometry/photometer.h"
#include "tests/support/designs.h"

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

/// In the picture, the reflectors have the positions and sizes of a pinhole projection.
TEST(Road, ReflectorsAreDrawnWhereTheyAre) {
  RoadScene scene;
  scene.columns = 900;
  scene.rows = 700;
  // The field of view is chosen such that the reflectors are many pixels wide.
  for (const auto& [distance_m, field_deg] : {std::pair{10.0, 9.0}, {30.0, 3.2}, {100.0, 1.0}}) {
    scene.field_deg = field_deg;
    RoadView view;
    view.distance_m = distance_m;
    view.reflectors[0].luminance = view.reflectors[1].luminance = 1e5;
    draw_road(scene, view);
    // The camera is aimed horizontally at the center of the car, and its columns are vertical.
    const Vec3 eye(-0.35, 1.2, distance_m + 1.8);
    const Vec3 forward = Vec3(0.35, 0.0, -eye.z()).normalized();
    const Vec3 right(-forward.z(), 0.0, forward.x());
    const double pixel = 2.0 * std::tan(0.5 * field_deg * pi / 180.0) / 900.0;
    for (const double side : {-1.0, 1.0}) {
      const Vec3 way = Vec3(side * 0.72, 0.6, 0.0) - eye;
      const Vec2 expected(450.0 + way.dot(right) / way.dot(forward) / pixel,
                          0.42 * 700.0 - way.y() / way.dot(forward) / pixel);
      Vec2 sum = Vec2::Zero();
      double pixels = 0.0;
      for (std::size_t k = 0; k < view.coloured.size(); ++k) {
        const Vec2 at(static_cast<double>(k % 900) + 0.5, static_cast<double>(k / 900) + 0.5);
        // The threshold excludes the veiling glare of the eye around the reflectors.
        const double share = std::min(1.0, view.coloured[k] / 1e5);
        if ((at - expected).norm() > 80.0 || share < 0.03) continue;
        sum += share * at;
        pixels += share;
      }
      EXPECT_NEAR((sum / pixels - expected).norm(), 0.0, 0.1) << distance_m;
      // Solid angles of the reflector of 12 cm x 2.5 cm, and of a pixel in the direction of the reflector.
      const double solid_angle = 0.12 * 0.025 * eye.z() / std::pow(way.norm(), 3.0);
      const double of_pixel = pixel * pixel * std::pow(way.dot(forward) / way.norm(), 3.0);
      EXPECT_NEAR(pixels * of_pixel / solid_angle, 1.0, 0.03) << distance_m;
    }
  }
}

}  // namespace
}  // namespace retrace::testing::road_test
