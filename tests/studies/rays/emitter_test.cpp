// Tests of emitters: the rays follow the distributions that the documentation gives.
#include "studies/rays/emitter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

namespace retrace::testing::emitter_test {
namespace {

using namespace studies;

constexpr std::size_t kRays = 40000;

std::vector<SetRay> rays_of(Emitter emitter) {
  emitter.rays = kRays;
  EmitterSource source(emitter);
  std::vector<SetRay> all;
  std::vector<SetRay> some;
  while (source.read(7777, some)) all.insert(all.end(), some.begin(), some.end());
  return all;
}

double share_of(const std::vector<SetRay>& rays, const std::function<bool(const SetRay&)>& is_in) {
  return static_cast<double>(std::ranges::count_if(rays, is_in)) / static_cast<double>(rays.size());
}

/// Returns four standard errors of a fraction of the rays.
double error_of(double share) {
  return 4.0 * std::sqrt(share * (1.0 - share) / kRays) + 1e-12;
}

double angle_deg(const SetRay& ray) {
  return std::atan2(std::hypot(ray.direction.x(), ray.direction.y()), ray.direction.z()) * 180.0 / std::numbers::pi;
}

/// Expects that the fractions of rays within several angles and radii follow the given distributions, and that no
/// azimuth is preferred.
void expect_law(const Emitter& emitter, const std::function<double(double)>& within_angle,
                const std::function<double(double)>& within_radius) {
  const std::vector<SetRay> rays = rays_of(emitter);
  for (const double part : {0.2, 0.5, 0.8, 1.0}) {
    const double angle = part * emitter.half_angle_deg;
    const double radius = 0.5 * part * emitter.disc_mm;
    EXPECT_NEAR(share_of(rays, [&](const SetRay& r) { return angle_deg(r) <= angle + 1e-9; }), within_angle(angle),
                error_of(within_angle(angle)));
    EXPECT_NEAR(share_of(rays, [&](const SetRay& r) { return r.position_mm.norm() <= radius + 1e-12; }),
                within_radius(radius), error_of(within_radius(radius)));
  }
  EXPECT_NEAR(share_of(rays, [](const SetRay& r) { return r.direction.x() * r.position_mm.y() > 0.0; }), 0.5, 0.01);
  EXPECT_NEAR(share_of(rays, [](const SetRay& r) { return r.direction.y() > 0.0; }), 0.5, 0.01);
  double power = 0.0;
  for (const SetRay& ray : rays) {
    power += ray.radiant_w;
    EXPECT_GE(ray.direction.z(), -1e-12);
    EXPECT_NEAR(ray.direction.norm(), 1.0, 1e-12);
  }
  EXPECT_NEAR(power, emitter.power, 1e-9);
}

double sin2(double deg) {
  return std::pow(std::sin(deg * std::numbers::pi / 180.0), 2.0);
}

TEST(Emitter, LambertianLightFollowsTheCosine) {
  for (const double half : {90.0, 30.0}) {
    Emitter emitter;
    emitter.disc_mm = 3.0;
    emitter.half_angle_deg = half;
    emitter.power = 5.0;
    expect_law(
        emitter, [&](double deg) { return sin2(deg) / sin2(half); }, [](double r) { return r * r / 2.25; });
  }
}

TEST(Emitter, GaussianLightFallsToItsSquareAtTheHalfAngle) {
  const Emitter emitter{.kind = EmitterKind::gaussian, .disc_mm = 2.0, .half_angle_deg = 4.0};
  expect_law(
      emitter, [](double deg) { return -std::expm1(-2.0 * deg * deg / 16.0); },
      [](double r) { return -std::expm1(-2.0 * r * r); });
}

TEST(Emitter, CollimatedLightIsEvenInSolidAngle) {
  Emitter emitter{.kind = EmitterKind::collimated, .disc_mm = 2.0, .half_angle_deg = 0.5};
  expect_law(
      emitter, [](double deg) { return sin2(0.5 * deg) / sin2(0.25); }, [](double r) { return r * r; });
  emitter.half_angle_deg = 0.0;
  for (const SetRay& ray : rays_of(emitter)) EXPECT_EQ(ray.direction, Vec3(0, 0, 1));
}

TEST(Emitter, TheSeedChoosesTheRays) {
  Emitter emitter;
  const std::vector<SetRay> a = rays_of(emitter);
  const std::vector<SetRay> b = rays_of(emitter);
  emitter.seed = 2;
  const std::vector<SetRay> c = rays_of(emitter);
  EXPECT_EQ(a[100].direction, b[100].direction);
  EXPECT_NE(a[100].direction, c[100].direction);
}

TEST(Emitter, KindsHaveNames) {
  for (std::size_t k = 0; k < kEmitterNames.size(); ++k)
    EXPECT_EQ(static_cast<std::size_t>(emitter_from_name(kEmitterNames[k])), k);
}

}  // namespace
}  // namespace retrace::testing::emitter_test
