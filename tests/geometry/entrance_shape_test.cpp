// Tests of entrance surfaces that are given by numbers and formulas. Heights and slopes are compared with closed forms.
// A rotated sphere must equal a shifted sphere. Surfaces that fold must be refused.
#include "geometry/entrance/entrance_shape.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <string>

#include "core/error.h"
#include "geometry/direction.h"
#include "geometry/entrance/entrance_surface.h"

namespace retrace::geometry::entrance_shape_test {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

/// Returns a surface whose axis is inclined, and which is rotated about this axis.
EntranceSurface surface_of(const EntranceShape& shape, const Vec3& origin_mm = Vec3::Zero(),
                           const EntranceInclination& inclination = {}, double rotation_deg = 0.0) {
  const SurfacePose pose{origin_mm,
                         rotation_of(inclination) * rotation_about(Vec3::UnitZ(), Angle::from_deg(rotation_deg))};
  return {FreeformSurface(height_of(shape), std::nullopt, {}, {}), pose};
}

EntranceShape formula(const std::string& text) {
  return parse_entrance_formula(text, {});
}

void expect_same(const EntranceSurface& a, const EntranceSurface& b, double tolerance, double half_mm = 5.0) {
  for (const double x : {-1.0, -0.37, 0.0, 0.61, 1.0})
    for (const double y : {-1.0, -0.52, 0.0, 0.29, 1.0}) {
      const Vec2 p = half_mm * Vec2(x, y);
      EXPECT_NEAR(a.at(p).height_mm, b.at(p).height_mm, tolerance) << p.transpose();
      EXPECT_LT((a.at(p).slope - b.at(p).slope).norm(), tolerance) << p.transpose();
    }
}

/// Expects that the slope is the derivative of the height.
void expect_slopes(const EntranceSurface& surface) {
  constexpr double kStep = 1e-4;
  for (const Vec2& p : {Vec2(0.3, -0.8), Vec2(-4.0, 2.5), Vec2(3.7, 4.1)}) {
    const auto height = [&](double x, double y) { return surface.at(p + Vec2(x, y)).height_mm; };
    const Vec2 slope =
        Vec2(height(kStep, 0.0) - height(-kStep, 0.0), height(0.0, kStep) - height(0.0, -kStep)) / (2.0 * kStep);
    EXPECT_LT((surface.at(p).slope - slope).norm(), 1e-8) << p.transpose();
  }
}

TEST(EntranceShape, SphereAndCylinderAreCircles) {
  for (const double radius : {20.0, -20.0}) {
    const EntranceSurface sphere = surface_of(SphereEntrance{radius}, {1.0, -2.0, 7.0});
    const EntranceSurface cylinder = surface_of(CylinderEntrance{radius}, {1.0, -2.0, 7.0});
    const double sign = radius > 0.0 ? 1.0 : -1.0;
    for (const Vec2& p : {Vec2(1.0, -2.0), Vec2(4.0, 3.0), Vec2(-6.0, 1.5)}) {
      const Vec2 d = p - Vec2(1.0, -2.0);
      EXPECT_NEAR(sphere.at(p).height_mm, 7.0 - radius + sign * std::sqrt(400.0 - d.squaredNorm()), 1e-13);
      EXPECT_NEAR(cylinder.at(p).height_mm, 7.0 - radius + sign * std::sqrt(400.0 - d.x() * d.x()), 1e-13);
    }
    expect_slopes(sphere);
    expect_slopes(cylinder);
  }
}

TEST(EntranceShape, BiconicWithEqualRadiiIsASphere) {
  for (const double conic : {0.0, -1.0, 0.7})
    expect_same(surface_of(BiconicEntrance{{-30.0, -30.0}, {conic, conic}}), surface_of(SphereEntrance{-30.0, conic}),
                1e-13);
}

// The sections of a biconic surface along x and y must be the conics that are given for these two axes.
TEST(EntranceShape, BiconicHasTheConicsOfItsSections) {
  const EntranceSurface biconic = surface_of(BiconicEntrance{{40.0, -15.0}, {-0.4, 0.2}});
  const EntranceSurface along_x = surface_of(SphereEntrance{40.0, -0.4});
  const EntranceSurface along_y = surface_of(SphereEntrance{-15.0, 0.2});
  for (const double t : {-5.0, -1.3, 2.2, 4.9}) {
    EXPECT_NEAR(biconic.at({t, 0.0}).height_mm, along_x.at({t, 0.0}).height_mm, 1e-14);
    EXPECT_NEAR(biconic.at({0.0, t}).height_mm, along_y.at({0.0, t}).height_mm, 1e-14);
  }
  expect_slopes(biconic);
}

TEST(EntranceShape, FormulaIsTheShapeThatItDescribes) {
  expect_same(surface_of(formula("sqrt(400 - x^2 - y^2) - 20")), surface_of(SphereEntrance{20.0}), 1e-13);
  expect_same(surface_of(formula("-r^2 / 60")), surface_of(SphereEntrance{30.0, -1.0}), 1e-9);
  expect_same(surface_of(formula("r * cos(theta) / 4")), surface_of(formula("x / 4")), 1e-9);
}

// A cylinder that is rotated by 30 degrees about z equals the formula in which x is replaced by the rotated coordinate.
TEST(EntranceShape, RotationIsFromXTowardsY) {
  const double c = std::cos(30.0 * kDegree);
  const double s = std::sin(30.0 * kDegree);
  const std::string across = "(x * cos(pi / 6) + y * sin(pi / 6))";
  expect_same(surface_of(CylinderEntrance{20.0}, Vec3::Zero(), {}, 30.0),
              surface_of(formula("sqrt(400 - " + across + "^2) - 20")), 1e-13);
  EXPECT_NEAR(surface_of(CylinderEntrance{20.0}, Vec3::Zero(), {}, 30.0).at({-4.0 * s, 4.0 * c}).height_mm, 0.0, 1e-14);
}

TEST(EntranceShape, InclinedPlaneRisesTowardsTheAzimuth) {
  for (const double azimuth : {0.0, 40.0, 250.0}) {
    const EntranceSurface plane = surface_of(PlaneEntrance{}, {1.0, 2.0, 3.0}, {30.0, azimuth, 20.0});
    const Vec2 along(std::cos(azimuth * kDegree), std::sin(azimuth * kDegree));
    for (const Vec2& p : {Vec2(1.0, 2.0), Vec2(5.0, -3.0), Vec2(-20.0, 7.0)}) {
      EXPECT_NEAR(plane.at(p).height_mm, 3.0 + std::tan(20.0 * kDegree) * along.dot(p - Vec2(1.0, 2.0)), 1e-13);
      EXPECT_LT((plane.at(p).slope - std::tan(20.0 * kDegree) * along).norm(), 1e-14);
    }
  }
}

// If a sphere is rotated about its vertex, its centre moves on a circle. The result is a sphere with the new centre.
TEST(EntranceShape, RotatedSphereIsAShiftedSphere) {
  for (const double radius : {400.0, 60.0, -90.0})
    for (const double angle : {1e-6, 12.0, 35.0, 60.0})
      for (const double azimuth : {0.0, 70.0, 200.0}) {
        const Vec3 origin(3.0, -1.0, 5.0);
        const EntranceSurface sphere = surface_of(SphereEntrance{radius}, origin, {0.0, azimuth, angle}, 25.0);
        const Vec3 axis = sphere.axis();
        EXPECT_NEAR(axis.z(), std::cos(angle * kDegree), 1e-15);
        const Vec3 centre = origin - radius * axis;
        const double sign = radius > 0.0 ? 1.0 : -1.0;
        for (const Vec2& p : {Vec2(3.0, -1.0), Vec2(11.0, 4.0), Vec2(-9.0, 6.5), Vec2(8.0, -17.0)}) {
          const Vec2 d = p - centre.head<2>();
          if (d.norm() > 0.95 * std::abs(radius)) continue;
          const double root = std::sqrt(radius * radius - d.squaredNorm());
          const EntranceSurface::SurfaceSample sample = sphere.at(p);
          EXPECT_NEAR(sample.height_mm, centre.z() + sign * root, 1e-12) << radius << " " << angle;
          EXPECT_LT((sample.slope + sign * d / root).norm(), 1e-12) << radius << " " << angle;
        }
      }
}

// The slope of an inclined surface must be the derivative of its height. The surface is rotated as a rigid body: a
// point of the rotated surface, rotated back, must have the height that the formula gives.
TEST(EntranceShape, InclinedFormulaIsRotatedRigidly) {
  const EntranceShape shape = formula("0.1 * sin(x / 3) * cos(y / 4) - (x^2 + 2 * y^2) / 300");
  const Sag upright = height_of(shape);
  const EntranceInclination inclination{45.0, 33.0, 28.0};
  const EntranceSurface surface = surface_of(shape, {0.5, 0.25, 2.0}, inclination);
  expect_slopes(surface);
  const Eigen::Matrix3d rotation = rotation_of(inclination);
  for (const Vec2& p : {Vec2(0.0, 0.0), Vec2(7.0, -3.0), Vec2(-5.0, 6.0)}) {
    const Vec3 local = rotation.transpose() * Vec3(p.x() - 0.5, p.y() - 0.25, surface.at(p).height_mm - 2.0);
    EXPECT_NEAR(local.z(), upright.evaluate(local.x(), local.y()), 1e-13);
  }
}

// The reference axis, the axis of the face and the z axis must be in one plane, and the angles between them must be the
// given ones.
TEST(EntranceShape, ReferenceAxisIsAtTheIncidence) {
  const EntranceInclination inclination{50.0, 120.0, 30.0};
  const Vec3 axis = rotation_of(inclination).col(2);
  const Vec3 reference = reference_axis_of(inclination);
  EXPECT_NEAR(std::acos(axis.dot(reference)), 50.0 * kDegree, 1e-14);
  EXPECT_NEAR(std::acos(axis.z()), 30.0 * kDegree, 1e-14);
  EXPECT_NEAR(axis.cross(reference).dot(Vec3::UnitZ()), 0.0, 1e-15);
  EXPECT_NEAR(std::atan2(reference.y(), reference.x()), 120.0 * kDegree, 1e-14);
}

TEST(EntranceShape, FoldsAreRefused) {
  const Polygon outline = {{-5, -5}, {5, -5}, {5, 5}, {-5, 5}};
  const auto is_refused = [&](const EntranceShape& shape, double pin_angle_deg) {
    try {
      check_folds(surface_of(shape, Vec3::Zero(), {0.0, 0.0, pin_angle_deg}), outline);
    } catch (const InputError&) {
      return true;
    }
    return false;
  };
  const EntranceShape waves = formula("0.5 * sin(2 * x)");  // slopes up to 45 degrees
  EXPECT_FALSE(is_refused(waves, 0.0));
  EXPECT_FALSE(is_refused(waves, 40.0));
  EXPECT_TRUE(is_refused(waves, 50.0));
  EXPECT_TRUE(is_refused(formula("3 * sin(6 * x)"), 30.0));
  EXPECT_FALSE(is_refused(SphereEntrance{14.0}, 30.0));
  EXPECT_TRUE(is_refused(SphereEntrance{6.0}, 0.0));    // ends inside the outline
  EXPECT_TRUE(is_refused(SphereEntrance{12.0}, 60.0));  // vertical within the outline
  EXPECT_TRUE(is_refused(formula("log(x + 4)"), 0.0));  // not finite over the whole outline
}

}  // namespace
}  // namespace retrace::geometry::entrance_shape_test
