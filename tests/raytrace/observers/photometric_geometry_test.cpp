// Tests of the angles of CIE 54.2 and ASTM E808 against their published relations.
#include "raytrace/observers/photometric_geometry.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "core/random.h"
#include "raytrace/light/light_setup.h"
#include "tests/support/closed_forms.h"

namespace retrace::testing::photometric_geometry_test {
namespace {

using namespace raytrace;
using geometry::Vec3;

/// The intrinsic system of CIE 54.2 and ASTM E808. Its angles are between the illumination axis, the observation axis,
/// the normal and the datum mark. They do not depend on the order of rotations.
struct IntrinsicGeometry {
  Angle alpha;    ///< observation angle
  Angle beta;     ///< entrance angle, between the normal and the illumination axis; 0 to 180 degrees
  Angle gamma;    ///< presentation angle: about the illumination axis, from the half plane of the normal to that of the
                  ///< observer, counter-clockwise as seen from the source; -180 to 180 degrees
  Angle omega_s;  ///< orientation angle: about the normal, from the trace of the half plane of the normal (in the
                  ///< direction away from the source) to the datum mark, counter-clockwise as seen from the end of the
                  ///< normal
};

// Directions count as parallel if the sine of the angle between them is below this value.
constexpr double kParallel = 1e-14;

/// Wraps an angle into (-pi, pi]. Rounding errors do not change the sign of an angle close to pi.
Angle wrapped(double angle_rad) {
  double turned = std::remainder(angle_rad, 2.0 * std::numbers::pi);
  if (turned < 1e-12 - std::numbers::pi) turned += 2.0 * std::numbers::pi;
  return Angle::from_rad(turned);
}

/// Returns the angle from the plane through `axis` and `from` to the plane through `axis` and `to`. The angle is
/// positive if the rotation is counter-clockwise for a viewer towards whom `axis` points.
double turn_about(const Vec3& axis, const Vec3& from, const Vec3& to) {
  return std::atan2(axis.dot(from.cross(to)), from.dot(to) - axis.dot(from) * axis.dot(to));
}

IntrinsicGeometry intrinsic_of(const PhotometricGeometry& geometry) {
  const PhotometricDirections d = directions_of(geometry);
  const Vec3 normal = Vec3::UnitZ();
  IntrinsicGeometry intrinsic;
  intrinsic.alpha = geometry.alpha;
  intrinsic.beta = Angle::from_rad(std::atan2(normal.cross(d.to_source).norm(), normal.dot(d.to_source)));
  Vec3 entrance_half_plane = normal;  // half plane on the side of the normal
  if (normal.cross(d.to_source).norm() < kParallel) {
    // If the normal is parallel to the illumination axis, the half plane is taken through the observer, so that gamma =
    // 0.
    const Vec3 observer = return_frame(geometry).up;
    entrance_half_plane = d.to_source + observer;
  }
  const Vec3 up = return_frame(geometry).up;
  intrinsic.gamma = wrapped(turn_about(d.to_source, entrance_half_plane, d.to_source + up));
  const Vec3 trace = entrance_half_plane - d.to_source;  // points away from the source
  const Vec3 away = normal.cross(d.to_source).norm() < kParallel ? trace : Vec3(-d.to_source);
  intrinsic.omega_s = wrapped(turn_about(normal, away, Vec3::UnitY()));
  return intrinsic;
}

PhotometricGeometry from_intrinsic(const IntrinsicGeometry& intrinsic) {
  const double beta = intrinsic.beta.rad();
  const double gamma = intrinsic.gamma.rad();
  // In the laboratory frame, z points to the source and y towards the observer. The half plane of the normal is rotated
  // by gamma about z into the half plane of the observer.
  const Vec3 in_plane(std::sin(gamma), std::cos(gamma), 0.0);
  const Vec3 normal = std::cos(beta) * Vec3::UnitZ() + std::sin(beta) * in_plane;
  // Direction perpendicular to the normal, away from the source.
  const Vec3 away = std::cos(beta) * in_plane - std::sin(beta) * Vec3::UnitZ();
  const Vec3 datum = Eigen::AngleAxisd(intrinsic.omega_s.rad(), normal) * away;
  Eigen::Matrix3d part_from_lab;
  part_from_lab << datum.cross(normal).transpose(), datum.transpose(), normal.transpose();
  const double alpha = intrinsic.alpha.rad();
  const Vec3 up = part_from_lab * Vec3::UnitY();
  const Vec3 s = part_from_lab * Vec3::UnitZ();
  // The direction `up` determines the half plane of the observer. If the direction to the observer were used instead,
  // the half plane would be undefined for alpha = 0.
  PhotometricGeometry geometry = geometry_of({s, (s + up).normalized()});
  geometry.alpha = Angle::from_rad(alpha);
  return geometry;
}

double uniform(std::uint32_t k, std::uint32_t which, double low, double high) {
  return low + (high - low) * unit_interval(philox({7, which}, k, 0)[0]);
}

PhotometricGeometry random_geometry(std::uint32_t k) {
  return {Angle::from_deg(uniform(k, 0, 0.05, 20.0)), Angle::from_deg(uniform(k, 1, -85.0, 85.0)),
          Angle::from_deg(uniform(k, 2, -85.0, 85.0)), Angle::from_deg(uniform(k, 3, -179.0, 179.0))};
}

void expect_equal(const PhotometricGeometry& a, const PhotometricGeometry& b) {
  EXPECT_NEAR(a.alpha.deg(), b.alpha.deg(), 1e-9);
  EXPECT_NEAR(a.beta1.deg(), b.beta1.deg(), 1e-9);
  EXPECT_NEAR(a.beta2.deg(), b.beta2.deg(), 1e-9);
  EXPECT_NEAR(a.epsilon.deg(), b.epsilon.deg(), 1e-9);
}

TEST(PhotometricGeometry, RoundTripsOverRandomGeometries) {
  for (std::uint32_t k = 0; k < 5000; ++k) {
    const PhotometricGeometry g = random_geometry(k);
    expect_equal(geometry_of(directions_of(g)), g);
    expect_equal(from_intrinsic(intrinsic_of(g)), g);
    expect_equal(geometry_from(entrance_angles(g), g.alpha, g.epsilon), g);
    const Vec3 to_source = directions_of(g).to_source;
    const SourceAngles angles = source_angles(to_source);
    EXPECT_NEAR((direction_to_source({angles.incidence, angles.azimuth}) - to_source).norm(), 0.0, 1e-14);
  }
}

TEST(PhotometricGeometry, IntrinsicAnglesRoundTrip) {
  for (std::uint32_t k = 0; k < 5000; ++k) {
    const IntrinsicGeometry i{Angle::from_deg(uniform(k, 4, 0.0, 20.0)), Angle::from_deg(uniform(k, 5, 0.5, 88.0)),
                              Angle::from_deg(uniform(k, 6, -179.0, 179.0)),
                              Angle::from_deg(uniform(k, 7, -179.0, 179.0))};
    const IntrinsicGeometry back = intrinsic_of(from_intrinsic(i));
    EXPECT_NEAR(back.alpha.deg(), i.alpha.deg(), 1e-9);
    EXPECT_NEAR(back.beta.deg(), i.beta.deg(), 1e-9);
    EXPECT_NEAR(back.gamma.deg(), i.gamma.deg(), 1e-9);
    EXPECT_NEAR(back.omega_s.deg(), i.omega_s.deg(), 1e-9);
  }
}

// Regulations describe the direction to the source by two rotations. V is a rotation about the fixed horizontal axis. H
// is a rotation about the axis that moves with V.
TEST(PhotometricGeometry, SourceAndObserverOfVAndH) {
  for (std::uint32_t k = 0; k < 1000; ++k) {
    const double v = uniform(k, 8, -60.0, 60.0) * kDeg;
    const double h = uniform(k, 9, -60.0, 60.0) * kDeg;
    const double alpha = uniform(k, 10, 0.0, 3.0) * kDeg;
    const auto [s, o] =
        directions_of(geometry_from({Angle::from_rad(v), Angle::from_rad(h)}, Angle::from_rad(alpha), Angle()));
    const Vec3 source(std::sin(h) * std::cos(v), std::sin(v), std::cos(h) * std::cos(v));
    const Vec3 observer(std::sin(h) * std::cos(v + alpha), std::sin(v + alpha), std::cos(h) * std::cos(v + alpha));
    EXPECT_NEAR((s - source).norm(), 0.0, 1e-14);
    EXPECT_NEAR((o - observer).norm(), 0.0, 1e-14);
  }
}

// Tests the relations that ASTM E808 publishes between the angles of the goniometer system and those of the intrinsic
// system, and its formula for the viewing angle.
TEST(PhotometricGeometry, PublishedRelationsHold) {
  for (std::uint32_t k = 0; k < 1000; ++k) {
    const PhotometricGeometry g = random_geometry(k);
    const IntrinsicGeometry i = intrinsic_of(g);
    const double b1 = g.beta1.rad();
    const double b2 = g.beta2.rad();
    EXPECT_NEAR(std::cos(i.beta.rad()), std::cos(b1) * std::cos(b2), 1e-14);
    EXPECT_NEAR(std::sin(b2), std::sin(i.beta.rad()) * std::sin(i.gamma.rad()), 1e-12);
    EXPECT_NEAR(std::tan(b1), std::tan(i.beta.rad()) * std::cos(i.gamma.rad()), 1e-9);
    EXPECT_NEAR(std::cos(viewing_angle(g).rad()), std::cos(b2) * std::cos(b1 - g.alpha.rad()), 1e-12);
  }
}

/// Rotations by 180 and -180 degrees are equal. They are reported as 180 degrees, whatever the rounding errors.
TEST(PhotometricGeometry, HalfATurnIsPositive) {
  for (const double epsilon_deg : {180.0, -180.0})
    for (double beta1_deg = -30.0; beta1_deg <= 30.0; beta1_deg += 7.5)
      for (double beta2_deg = -30.0; beta2_deg <= 30.0; beta2_deg += 7.5) {
        const PhotometricGeometry geometry = {Angle::from_deg(0.33), Angle::from_deg(beta1_deg),
                                              Angle::from_deg(beta2_deg), Angle::from_deg(epsilon_deg)};
        EXPECT_NEAR(geometry_of(directions_of(geometry)).epsilon.deg(), 180.0, 1e-9)
            << epsilon_deg << ' ' << beta1_deg << ' ' << beta2_deg;
      }
}

// In the part frame, a rotation of the part by epsilon moves the source and the observer by -epsilon about the normal.
// The orientation angle increases by epsilon.
TEST(PhotometricGeometry, EpsilonTurnsThePartAboutItsNormal) {
  PhotometricGeometry g{Angle::from_deg(0.33), Angle::from_deg(-10.0), Angle::from_deg(20.0), Angle()};
  const auto still = directions_of(g);
  const double omega_still = intrinsic_of(g).omega_s.deg();
  g.epsilon = Angle::from_deg(30.0);
  const auto turned = directions_of(g);
  const Eigen::Matrix3d back = Eigen::AngleAxisd(-30.0 * kDeg, Vec3::UnitZ()).toRotationMatrix();
  EXPECT_NEAR((turned.to_source - back * still.to_source).norm(), 0.0, 1e-14);
  EXPECT_NEAR((turned.to_observer - back * still.to_observer).norm(), 0.0, 1e-14);
  EXPECT_NEAR(intrinsic_of(g).omega_s.deg() - omega_still, 30.0, 1e-9);
}

TEST(PhotometricGeometry, ReturnFrameKeepsObservationAngles) {
  for (std::uint32_t k = 0; k < 1000; ++k) {
    const PhotometricGeometry g = random_geometry(k);
    const ReturnFrame frame = return_frame(g);
    const geometry::Vec2 at = frame.angles_rad(directions_of(g).to_observer);
    EXPECT_NEAR(at.x(), 0.0, 1e-12);
    EXPECT_NEAR(at.y(), g.alpha.rad(), 1e-12);
    const geometry::Vec2 any(uniform(k, 11, -1.0, 1.0), uniform(k, 12, -1.0, 1.0));
    EXPECT_NEAR((frame.angles_rad(frame.direction(any)) - any).norm(), 0.0, 1e-12);
  }
}

}  // namespace
}  // namespace retrace::testing::photometric_geometry_test
