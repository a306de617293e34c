// Tests of balls with mirrors behind them. The tracer of spheres is compared with closed forms, and with sums over ray
// heights. These sums are computed from plane angles instead of vectors.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "raytrace/balls/ball_forms.h"
#include "raytrace/balls/ball_tracer.h"
#include "raytrace/balls/ball_walker.h"
#include "tests/support/designs.h"

namespace retrace::raytrace::balls_test {
namespace {

using std::numbers::pi;

Optics ideal(double index) {
  Optics optics = testing::ideal();
  optics.index = index;
  return optics;
}

Optics glass(double index) {
  Optics optics = ideal(index);
  optics.lossless_entrance = false;
  return optics;
}

BallLayer single(double diameter_mm = 1.0, double offset_mm = 0.0) {
  return {diameter_mm, offset_mm, 90.0, std::nullopt};
}

BallLayer packed(double gap_mm = 0.0, double diameter_mm = 1.0) {
  return {diameter_mm, 0.0, 90.0, diameter_mm + gap_mm};
}

Illumination at(double incidence_deg, double azimuth_deg = 0.0) {
  return {Angle::from_deg(incidence_deg), Angle::from_deg(azimuth_deg)};
}

MonteCarloResult traced(const BallLayer& layer, const Optics& optics, const Illumination& illumination,
                        double half_angle_deg = 0.5, std::uint64_t rays = 1U << 15) {
  Sampling sampling;
  sampling.rays = rays;
  return BallTracer(layer).trace(optics, illumination, {half_angle_deg}, sampling, {});
}

/// Traces one ray through a single ball and returns the power in each cone.
/// \param height distance of the ray from the axis, divided by the radius
std::vector<double> power_by_cone(const BallLayer& layer, const Optics& optics, double height,
                                  const std::vector<double>& cones_deg) {
  const LightSetup setup(geometry::Part{}, Vec2::Zero(), optics, at(0.0), cones_deg);
  Tally tally(cones_deg.size());
  PathPolicy policy;
  BallWalker walker(layer, setup, policy, tally);
  walker.trace({height * layer.radius_mm(), 0.0, 2.0 * layer.radius_mm()}, -Vec3::UnitZ(), {}, {});
  std::vector<double> power;
  for (const Stokes& stokes : tally.returned) power.push_back(stokes.i);
  return power;
}

/// Returns the power that is returned within the cone for a ray of unit power. The calculation uses only angles about
/// the center of the ball. The mirror is ideal and covers the back half of the ball.
/// \param height distance of the ray from the axis, divided by the radius
/// \param turn_rad azimuth of the ray about the axis, from the plane of incidence
double returned_by_angles(double height, double index, double turn_rad, double incidence_rad, double half_angle_rad) {
  const double i = std::asin(height);
  const double inside = std::asin(height / index);
  double r_s = std::sin(i - inside) / std::sin(i + inside);
  double r_p = std::tan(i - inside) / std::tan(i + inside);
  if (height < 1e-9) r_s = r_p = (index - 1.0) / (index + 1.0);
  // z component of the point of the ball at the angle `phi` from the source, in the plane of the ray. The angle
  // between the source and z is `incidence_rad`.
  const double tilt = std::sin(incidence_rad) * std::cos(turn_rad);
  const auto z_at = [&](double phi) { return std::cos(phi) * std::cos(incidence_rad) - std::sin(phi) * tilt; };
  const auto is_back = [&](double phi) {
    return std::abs(std::remainder(phi, 2.0 * pi)) <= half_angle_rad && z_at(phi) > 0.0;
  };
  if (z_at(i) <= 0.0) return 0.0;
  double sum = 0.0;
  for (const double reflectance : {r_s * r_s, r_p * r_p}) {
    if (is_back(2.0 * i)) sum += 0.5 * reflectance;
    double power = 0.5 * (1.0 - reflectance);
    double phi = i;
    for (int k = 0; k < 200 && power > 1e-12; ++k) {
      phi += pi - 2.0 * inside;
      if (z_at(phi) <= 0.0) continue;  // the point is on the mirror
      if (is_back(phi + i)) sum += power * (1.0 - reflectance);
      power *= reflectance;
    }
  }
  return sum;
}

double rre_by_angles(double index, double incidence_deg, double half_angle_deg) {
  const int heights = incidence_deg == 0.0 ? 200000 : 4000;
  const int turns = incidence_deg == 0.0 ? 1 : 90;
  const double deg = pi / 180.0;
  double sum = 0.0;
  for (int k = 0; k < heights; ++k)
    for (int j = 0; j < turns; ++j)
      sum += returned_by_angles(std::sqrt((k + 0.5) / heights), index, 2.0 * pi * (j + 0.5) / turns,
                                incidence_deg * deg, half_angle_deg * deg);
  return sum / heights / turns;
}

TEST(Balls, OfIndexTwoSendLightNearTheAxisBackParallel) {
  const double within_deg = 1e-9 * 180.0 / pi;
  for (const double height : {0.0, 1e-6, 1e-4, 1e-3, 1.5e-3})
    EXPECT_NEAR(power_by_cone(single(), ideal(2.0), height, {within_deg})[0], 1.0, 1e-12) << height;
  // By third-order theory, the return error of a ball of index 2 is a quarter of the cube of the height.
  EXPECT_EQ(power_by_cone(single(), ideal(2.0), 2e-3, {within_deg})[0], 0.0);
  EXPECT_NEAR(return_error_rad(0.01, 2.0, 1.0, 1.0), 0.25e-6, 1e-10);
}

TEST(Balls, SphericalAberrationIsTheClosedForm) {
  struct Case {
    double index, offset_mm, spacer;
  };
  for (const auto& [index, offset_mm, spacer] :
       {Case{2.0, 0.0, 1.0}, {1.9, 0.0, 1.0}, {1.5, 0.25, 1.0}, {1.5, 0.2, 1.0}, {1.9, 0.05, 1.5}, {2.2, 0.1, 1.5}}) {
    const BallLayer layer = single(1.0, offset_mm);
    Optics optics = ideal(index);
    optics.back_index = spacer;
    const double rho = layer.mirror_radius_mm() / layer.radius_mm();
    const double m = offset_mm > 0.0 ? spacer : 1.0;
    for (double height = 0.05; height < 0.96; height += 0.05) {
      const double error_deg = std::abs(return_error_rad(height, index, m, rho)) * 180.0 / pi;
      // The squared distance of unit vectors at the edge of a cone is increased by 1e-9, so that directions on the edge
      // belong to the cone. The tolerance covers this increase and rounding errors.
      const double little = 1e-10 + 1e-8 * error_deg;
      const auto power =
          power_by_cone(layer, optics, height, {std::max(error_deg - little, 1e-14), error_deg + little});
      EXPECT_NEAR(power[1], 1.0, 1e-12) << index << ' ' << offset_mm << ' ' << height;
    }
  }
}

TEST(Balls, ReturnErrorByDirectCount) {
  // By Snell's law the return error is 4 i' - 2 i, where i is the angle of incidence and i' the angle inside. For
  // n = sqrt(3) and i = 60 degrees, i' is 30 degrees and the error is 0.
  EXPECT_NEAR(return_error_rad(std::sin(pi / 3.0), std::sqrt(3.0), 1.0, 1.0), 0.0, 1e-15);
  EXPECT_NEAR(return_error_rad(1.0, 2.0, 1.0, 1.0), pi - 2.0 * pi / 3.0, 1e-15);
}

TEST(Balls, MirrorInFocus) {
  // A ball with n = 1.5 has its focus 1.5 radii behind the center of the ball.
  EXPECT_NEAR(*focal_offset_over_radius(1.5, 1.0), 0.5, 1e-15);
  EXPECT_FALSE(focal_offset_over_radius(2.0, 1.0));
  EXPECT_FALSE(focal_offset_over_radius(1.2, 1.6));
  for (const double index : {1.45, 1.6, 1.9})
    for (const double spacer : {1.0, 1.3}) {
      const double rho = 1.0 + *focal_offset_over_radius(index, spacer);
      EXPECT_NEAR(paraxial_error(index, spacer, rho), 0.0, 1e-14);
      EXPECT_NEAR(return_error_rad(1e-4, index, spacer, rho), 0.0, 1e-11);
    }
}

TEST(Balls, ShareWithinAConeByAngles) {
  // Rays are stratified by height. The error at the border of the cone is therefore less than one ray of a
  // replicate.
  const std::uint64_t rays = 1U << 17;
  const double one_ray = static_cast<double>(Sampling::kReplicates) / static_cast<double>(rays);
  for (const double index : {1.8, 1.9, 2.0, 2.1}) {
    const MonteCarloResult result = traced(single(), ideal(index), at(0.0), 1.0, rays);
    EXPECT_NEAR(result.cones[0].rre, fraction_within(pi / 180.0, index, 1.0, 1.0), one_ray) << index;
  }
}

/// Returns the return error, in rad, of a ray in a coated ball. Snell's law and the law of reflection are applied
/// to vectors in the plane of the ray.
/// \param height distance of the ray from the axis, divided by the radius
double traced_error_rad(double height, double index) {
  Vec2 place(height, std::sqrt(1.0 - height * height));
  Vec2 direction(0.0, -1.0);
  const auto refract = [&](double ratio, const Vec2& normal) {  // `normal` points to the source of the light
    const double along = -direction.dot(normal);
    direction = ratio * direction + (ratio * along - std::sqrt(1.0 - ratio * ratio * (1.0 - along * along))) * normal;
  };
  refract(1.0 / index, place);
  place -= 2.0 * place.dot(direction) * direction;
  direction -= 2.0 * direction.dot(place) * place;
  place -= 2.0 * place.dot(direction) * direction;
  refract(index, -place);
  return std::atan2(direction.x(), direction.y());
}

// The percentages of the table of docs/theory/beads.md are compared with three results: a ray trace with plane
// vectors, the tracer of balls, and the closed form.
TEST(Balls, SharesOfTheApertureByIndex) {
  struct Case {
    double index, half_degree_percent, degree_percent;
  };
  const int rays = 100000;
  const double one_ray = static_cast<double>(Sampling::kReplicates) / (1U << 15);
  for (const auto& [index, half_degree_percent, degree_percent] :
       {Case{1.9, 8.5, 19.7}, {1.91, 9.5, 23.0}, {1.93, 12.4, 34.0}, {1.95, 21.5, 28.7}, {2.0, 10.3, 15.9}})
    for (const auto& [cone_deg, percent] : {std::pair(0.5, half_degree_percent), {1.0, degree_percent}}) {
      int within = 0;
      for (int k = 0; k < rays; ++k)
        within += std::abs(traced_error_rad(std::sqrt((k + 0.5) / rays), index)) <= cone_deg * pi / 180.0 ? 1 : 0;
      const double share = static_cast<double>(within) / rays;
      EXPECT_NEAR(100.0 * share, percent, 0.05 + 1e-3) << index << ' ' << cone_deg;
      EXPECT_NEAR(fraction_within(cone_deg * pi / 180.0, index, 1.0, 1.0), share, 3e-5) << index << ' ' << cone_deg;
      EXPECT_NEAR(traced(single(), ideal(index), at(0.0), cone_deg).cones[0].rre, share, one_ray) << index;
    }
}

// By third-order theory, a ray is within the cone if the cube of its height is at most 4 times the angle of the
// cone. The exact limit of the height is smaller.
TEST(Balls, ThirdOrderOverstatesTheShareOfIndexTwo) {
  const double cone_rad = 0.5 * pi / 180.0;
  EXPECT_NEAR(std::pow(4.0 * cone_rad, 2.0 / 3.0), 0.107, 5e-4);
  EXPECT_NEAR(traced_error_rad(0.32036, 2.0), cone_rad, 1e-6);
  EXPECT_NEAR(0.32036 * 0.32036, 0.103, 5e-4);
}

TEST(Balls, SumsOverHeightsAgreeAtNormalIncidence) {
  for (const double index : {1.5, 1.9, 2.0}) {
    const MonteCarloResult result = traced(single(), glass(index), at(0.0));
    EXPECT_NEAR(result.cones[0].rre, rre_by_angles(index, 0.0, 0.5), 5.0 * result.cones[0].spread + 1e-5) << index;
  }
}

TEST(Balls, SumsOverHeightsAndTurnsAgreeAtOtherAngles) {
  for (const double incidence_deg : {20.0, 45.0, 70.0}) {
    const MonteCarloResult result = traced(single(), glass(1.92), at(incidence_deg, 33.0), 1.0);
    EXPECT_NEAR(result.cones[0].rre, rre_by_angles(1.92, incidence_deg, 1.0), 5.0 * result.cones[0].spread + 2e-4)
        << incidence_deg;
  }
}

TEST(Balls, EveryBitOfPowerIsBooked) {
  std::vector<BallLayer> layers = {single(), packed(), packed(0.3)};
  layers.push_back({1.0, 0.2, 45.0, std::nullopt});
  layers.push_back({1.0, 0.1, 60.0, 1.2});
  for (const BallLayer& layer : layers)
    for (const double incidence_deg : {0.0, 30.0, 80.0, -60.0}) {
      Optics optics;
      optics.index = 1.9;
      optics.back_index = 1.4;
      optics.absorption_per_mm = 0.05;
      if (layer.mirror_offset_mm > 0.0) optics.facet_layers = testing::opaque({1.2, 7.1});
      const MonteCarloResult result = traced(layer, optics, at(incidence_deg, 17.0), 0.5, 1U << 12);
      const Ledger& ledger = result.cones[0].ledger;
      EXPECT_NEAR(ledger.total(), 1.0, 1e-10);
      EXPECT_LT(ledger[Account::truncated], 1e-5);
      EXPECT_GT(ledger[Account::absorbed], 0.0);
      for (const double power : ledger.power) EXPECT_GE(power, 0.0);
    }
}

TEST(Balls, NothingButTheMirrorAndTheGlassAbsorbs) {
  const MonteCarloResult result = traced(packed(), glass(1.9), at(25.0), 0.5, 1U << 13);
  EXPECT_NEAR(result.cones[0].ledger[Account::absorbed], 0.0, 1e-12);
}

/// Returns the shaded fraction of the plane through the centers of the balls. A point of the plane is shaded if the
/// line from this point towards the source hits a ball.
double shaded_share(double pitch_mm, double radius_mm, double incidence_rad, double azimuth_rad) {
  const Vec3 to_source(std::sin(incidence_rad) * std::cos(azimuth_rad), std::sin(incidence_rad) * std::sin(azimuth_rad),
                       std::cos(incidence_rad));
  const int n = 300;
  int shaded = 0;
  for (int a = 0; a < n; ++a)
    for (int b = 0; b < n; ++b) {
      const Vec3 place =
          pitch_mm * ((a + 0.5) / n * Vec3(1.0, 0.0, 0.0) + (b + 0.5) / n * Vec3(0.5, 0.5 * std::sqrt(3.0), 0.0));
      bool is_shaded = false;
      for (int row = -12; row <= 12 && !is_shaded; ++row)
        for (int along = -18; along <= 18 && !is_shaded; ++along) {
          const Vec3 off = pitch_mm * Vec3(along + 0.5 * row, 0.5 * std::sqrt(3.0) * row, 0.0) - place;
          const double towards = off.dot(to_source);
          const double half2 = radius_mm * radius_mm - off.squaredNorm() + towards * towards;
          is_shaded =
              half2 > 0.0 && towards + std::sqrt(half2) > 0.0;  // the far intersection with the ball is above the plane
        }
      if (is_shaded) ++shaded;
    }
  return static_cast<double>(shaded) / n / n;
}

/// Returns the fraction of the light that hits the balls. The balls absorb all light and reflect nothing.
double share_on_balls(const BallLayer& layer, const Illumination& illumination) {
  Optics optics = ideal(1.0);
  optics.absorption_per_mm = 1e9;
  return traced(layer, optics, illumination, 0.5, 1U << 17).cones[0].ledger[Account::absorbed];
}

TEST(Balls, ShadeEachOther) {
  for (const double gap_mm : {0.0, 0.4})
    for (const double incidence_deg : {0.0, 30.0, 50.0, 70.0}) {
      const double share = shaded_share(1.0 + gap_mm, 0.5, incidence_deg * pi / 180.0, 0.3);
      EXPECT_NEAR(share_on_balls(packed(gap_mm), at(incidence_deg, 0.3 * 180.0 / pi)), share, 2e-3)
          << gap_mm << ' ' << incidence_deg;
    }
}

TEST(Balls, FarApartHaveShadowsOfTheirOwn) {
  const BallLayer layer = packed(2.0);
  for (const double incidence_deg : {0.0, 30.0, 60.0}) {
    const double cosine = std::cos(incidence_deg * pi / 180.0);
    // In the projection along the light, the visible part of a ball consists of half a disc and half an ellipse.
    EXPECT_NEAR(share_on_balls(layer, at(incidence_deg, 11.0)), packing_fraction(layer) * 0.5 * (1.0 + 1.0 / cosine),
                5e-4);
  }
  const MonteCarloResult alone = traced(single(), glass(1.9), at(60.0), 0.5, 1U << 14);
  EXPECT_GT(alone.cones[0].ledger[Account::transmitted], 0.25 - 1e-3) << "(1 - cos 60) / 2 falls on its sunk half";
}

TEST(Balls, PackedSendBackTheirShareOfThePlan) {
  EXPECT_NEAR(packing_fraction(packed()), 0.9068996821171089, 1e-15);
  const MonteCarloResult result = traced(packed(), ideal(1.95), at(0.0), 1.0);
  EXPECT_NEAR(result.cones[0].rre, packing_fraction(packed()) * fraction_within(pi / 180.0, 1.95, 1.0, 1.0),
              5.0 * result.cones[0].spread + 1e-6);
}

TEST(Balls, LayersHaveSixfoldSymmetry) {
  const MonteCarloResult one = traced(packed(), glass(1.9), at(55.0, 8.0));
  for (const double azimuth_deg : {68.0, 128.0, 188.0, -8.0}) {
    const MonteCarloResult other = traced(packed(), glass(1.9), at(55.0, azimuth_deg));
    EXPECT_NEAR(other.cones[0].rre, one.cones[0].rre, 5.0 * std::hypot(one.cones[0].spread, other.cones[0].spread))
        << azimuth_deg;
  }
}

TEST(Balls, SizeDoesNotMatterWithoutAbsorption) {
  const MonteCarloResult small = traced(packed(0.0, 0.05), glass(1.9), at(35.0), 0.5, 1U << 13);
  const MonteCarloResult large = traced(packed(0.0, 50.0), glass(1.9), at(35.0), 0.5, 1U << 13);
  EXPECT_NEAR(small.cones[0].rre, large.cones[0].rre, 1e-6);
}

TEST(Balls, TheMirrorEndsWhereItIsToldTo) {
  // A mirror with a half-angle of 20 degrees, placed at the focus, reflects light with angles of incidence up to
  // 20 degrees.
  BallLayer layer = single(1.0, *focal_offset_over_radius(1.5, 1.0) * 0.5);
  layer.mirror_half_angle_deg = 20.0;
  const double near_axis_deg = 0.5;
  const LightSetup inside(geometry::Part{}, Vec2::Zero(), ideal(1.5), at(19.0), {near_axis_deg});
  const LightSetup outside(geometry::Part{}, Vec2::Zero(), ideal(1.5), at(21.0), {near_axis_deg});
  for (const LightSetup* setup : {&inside, &outside}) {
    Tally tally(1);
    PathPolicy policy;
    BallWalker walker(layer, *setup, policy, tally);
    walker.trace(2.0 * setup->to_source + Vec3(0.0, 0.02, 0.0), -setup->to_source, {}, {});
    EXPECT_NEAR(tally.returned[0].i, setup == &inside ? 1.0 : 0.0, 1e-12);
    EXPECT_NEAR(tally.other[Account::transmitted], setup == &inside ? 0.0 : 1.0, 1e-12);
  }
}

TEST(Balls, SameSeedSameBytesAndAnotherSeedAnother) {
  const auto rre = [](std::uint32_t seed) {
    Sampling sampling;
    sampling.seed = seed;
    sampling.rays = 4096;
    return BallTracer(packed()).trace(glass(1.9), at(40.0), {0.5}, sampling, {}).cones[0].rre;
  };
  EXPECT_EQ(rre(1), rre(1));
  EXPECT_NE(rre(1), rre(2));
}

}  // namespace
}  // namespace retrace::raytrace::balls_test
