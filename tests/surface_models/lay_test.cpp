// Tests of roughness with a lay, which is a preferred direction: the correlation lengths along and across it differ.
#include "core/error.h"
#include "tests/surface_models/scatter_checks.h"

namespace retrace::testing::lay_test {
namespace {

using namespace scatter_checks;

/// Returns the Fourier transform of exp(-x^2 / l^2) at the frequency f, computed as a sum with equal steps.
double transform(double length, double frequency) {
  const double step = 0.02 * length;
  double sum = 0.0;
  for (int k = -400; k <= 400; ++k)
    sum += std::exp(-step * step * k * k / (length * length)) * std::cos(2.0 * std::numbers::pi * frequency * step * k);
  return sum * step;
}

// Small heights scatter by their spectrum, which is the transform of the autocovariance s^2 exp(-x^2 / lx^2 - y^2 /
// ly^2).
TEST(Lay, LowHeightsScatterByTheTransformOfTheirAutocovariance) {
  const Roughness r = {0.01, 3.0, 0.0, 0.0, 1.2};
  const HarveyShack model(r);
  for (const double incidence_deg : {0.0, 30.0, 54.74}) {
    const ScatterEvent event = inside(incidence_deg);
    const double wave_um = 0.55 / kIndex;
    for (const Vec2& shift : {Vec2(0.01, 0.02), Vec2(-0.05, 0.03), Vec2(0.0, 0.12), Vec2(0.06, 0.0)}) {
      const Vec2 beta = event.direction_in.head<2>() + shift;
      const double paths = event.cos_in() + std::sqrt(1.0 - beta.squaredNorm());
      const double phase = 2.0 * std::numbers::pi * 1e-3 * r.sq_nm / wave_um * paths;
      const double expected = phase * phase / (wave_um * wave_um) *
                              transform(r.correlation_length_um, shift.x() / wave_um) *
                              transform(r.y_correlation_length_um, shift.y() / wave_um);
      EXPECT_NEAR(model.unscaled_density(event, {}, Lobe::reflection, beta) / expected, 1.0, 1e-6);
    }
  }
}

// For single diffraction, the spread along each axis is w / (sqrt(2) pi n l), with the correlation length of this axis.
TEST(Lay, SpreadsByTheLengthOfEachAxis) {
  constexpr std::uint32_t kDraws = 100000;
  const HarveyShack model({2.0, 12.0, 0.0, 0.0, 3.0});
  const ScatterEvent event = inside(20.0);
  Eigen::Matrix2d moments = Eigen::Matrix2d::Zero();
  for (std::uint32_t k = 0; k < kDraws; ++k) {
    RandomStream random = stream(91, k);
    const auto beta = model.draw_scattered(event, {}, Lobe::reflection, random);
    ASSERT_TRUE(beta);
    const Vec2 shift = *beta - event.direction_in.head<2>();
    moments += shift * shift.transpose() / kDraws;
  }
  const double unit = 0.55 / (std::sqrt(2.0) * std::numbers::pi * kIndex);
  EXPECT_NEAR(std::sqrt(moments(0, 0)) / (unit / 12.0), 1.0, 0.02);
  EXPECT_NEAR(std::sqrt(moments(1, 1)) / (unit / 3.0), 1.0, 0.02);
  EXPECT_NEAR(moments(0, 1) / std::sqrt(moments(0, 0) * moments(1, 1)), 0.0, 0.02);
}

// Roughness whose spatial wavelength is shorter than that of the light does not scatter. The effective Sq^2 is the
// integral of the spectrum inside a disc, which the test computes as a sum over a grid.
TEST(Lay, ShortWavesDoNotScatter) {
  const Roughness r = {10.0, 1.0, 0.0, 0.0, 0.1};
  const ScatterEvent event = inside(0.0);
  const double edge = kIndex / 0.55;  // per um
  const Vec2 deviation =
      Vec2(1.0 / r.correlation_length_um, 1.0 / r.y_correlation_length_um) / std::numbers::sqrt2 / std::numbers::pi;
  constexpr int kSteps = 800;
  double share = 0.0;
  for (int i = 0; i < kSteps; ++i)
    for (int j = 0; j < kSteps; ++j) {
      const Vec2 f = edge * Vec2(2.0 * (i + 0.5) / kSteps - 1.0, 2.0 * (j + 0.5) / kSteps - 1.0);
      if (f.norm() < edge) share += std::exp(-0.5 * f.cwiseQuotient(deviation).squaredNorm());
    }
  share *= 4.0 * edge * edge / (1.0 * kSteps * kSteps) / (2.0 * std::numbers::pi * deviation.prod());
  const double phase = 4.0 * std::numbers::pi * kIndex * r.sq_nm / 550.0;
  EXPECT_LT(share, 0.9);
  EXPECT_NEAR(-std::log(specular_fraction(HarveyShack(r), event, {}, Lobe::reflection)) / (phase * phase * share), 1.0,
              1e-4);
}

// Two equal lengths give exactly the same results as one length, also between dielectrics.
TEST(Lay, EqualLengthsAreOne) {
  const Dielectrics media = {kIndex, 1.0, 550.0};
  for (const bool between : {false, true}) {
    const Roughness one = {30.0, 1.5, 0.0, 0.0}, both = {30.0, 1.5, 0.0, 0.0, 1.5};
    const HarveyShack a = between ? HarveyShack(one, media) : HarveyShack(one);
    const HarveyShack b = between ? HarveyShack(both, media) : HarveyShack(both);
    EXPECT_EQ(a.is_between_dielectrics(), between);
    EXPECT_EQ(b.is_between_dielectrics(), between);
    for (std::uint32_t k = 0; k < 1000; ++k) {
      RandomStream first = stream(5, k), second = stream(5, k);
      EXPECT_EQ(*a.draw_scattered(inside(40.0), {}, Lobe::reflection, first),
                *b.draw_scattered(inside(40.0), {}, Lobe::reflection, second));
    }
  }
  EXPECT_FALSE(HarveyShack({30.0, 1.5, 0.0, 0.0, 1.6}, media).is_between_dielectrics());
}

// The areal slope is Sq sqrt(2 / lx^2 + 2 / ly^2).
TEST(Lay, RefusesAndWarnsByItsShorterLength) {
  EXPECT_NO_THROW(require_in_range(HarveyShack({1250.0, 4.0, 0.0, 0.0, 2.0}), kIndex, 550.0));
  EXPECT_THROW(require_in_range(HarveyShack({1280.0, 4.0, 0.0, 0.0, 2.0}), kIndex, 550.0), InputError);
  EXPECT_THROW(HarveyShack({1.0, 1.0, 0.0, 0.0, -1.0}), InputError);
  EXPECT_TRUE(warnings(HarveyShack({20.0, 30.0, 0.0, 0.0, 2.5}), kIndex, 550.0).empty());
  EXPECT_EQ(warnings(HarveyShack({20.0, 30.0, 0.0, 0.0, 1.5}), kIndex, 550.0).size(), 1U);
  EXPECT_EQ(warnings(HarveyShack({5.0, 30.0, 0.0, 0.0, 0.2}), kIndex, 550.0).size(), 1U);
}

// The specular and the scattered fraction add up to 1, in reflection, transmission and total reflection. Every draw has
// the weight 1.
TEST(Lay, KeepsAllLight) {
  for (const Roughness& r : {Roughness{20.0, 3.0, 0.0, 0.0, 1.0}, Roughness{40.0, 1.0, 0.0, 0.0, 3.0}}) {
    const HarveyShack model(r);
    for (const std::size_t k : {1U, 2U, 7U}) {
      const Case& c = cases()[k];
      const auto lobe = scaled_density(model, c.event, c.lobe);
      EXPECT_NEAR(specular_fraction(model, c.event, {}, c.lobe) + disc_integral(lobe, 200, 300), 1.0, 1e-3) << c.name;
      for (std::uint32_t draw = 0; draw < 200; ++draw) {
        RandomStream random = stream(92, draw);
        const auto drawn = sample(ScatterModel(model), c.event, {}, c.lobe, random);
        ASSERT_TRUE(drawn);
        EXPECT_EQ(drawn->weight, 1.0);
        EXPECT_NEAR(drawn->direction.norm(), 1.0, 1e-12);
        EXPECT_EQ(drawn->direction.z() > 0.0, c.lobe == Lobe::reflection);
      }
    }
  }
}

// Draws follow the density, whose width along each axis depends on the correlation length of this axis.
TEST(Lay, DrawsFollowTheDensity) {
  std::uint32_t seed = 700;
  for (const Roughness& r : {Roughness{20.0, 8.0, 0.0, 0.0, 2.0}, Roughness{60.0, 3.0, 0.0, 0.0, 12.0}}) {
    const HarveyShack model(r);
    for (const Case& c : cases()) {
      const Vec2 middle = specular_direction(c.event, Vec3::UnitZ(), c.lobe)->head<2>();
      const Rings rings(middle, 0.55 / (std::sqrt(2.0) * std::numbers::pi * c.event.index_of(c.lobe) * 3.0));
      EXPECT_GT(chi_square_p(rings, scaled_density(model, c.event, c.lobe), draw_of(model, c.event, c.lobe), ++seed),
                sidak_level(2 * cases().size()))
          << c.name << ", Sq " << r.sq_nm;
    }
  }
}

}  // namespace
}  // namespace retrace::testing::lay_test
