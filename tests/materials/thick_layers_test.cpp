// Tests of incoherent layers, whose reflections add in power and not in amplitude. The results are compared with closed
// forms, and with coherent layers averaged over their fringes.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "materials/thick_layers.h"

namespace retrace::materials::thick_layers_test {
namespace {

using Complex = std::complex<double>;

constexpr double kBody = 1.4917;
constexpr double kWater = 1.333;

struct Means {
  std::array<double, 4> powers{};  ///< R_s, R_p, T_s, T_p
  Complex r_cross, t_cross;

  void add(const FresnelCoefficients& f, double weight) {
    const std::array<double, 4> more = {std::norm(f.r_s), std::norm(f.r_p), std::norm(f.t_s), std::norm(f.t_p)};
    for (std::size_t k = 0; k < 4; ++k) powers[k] += weight * more[k];
    r_cross += weight * f.r_coherence * f.r_s * std::conj(f.r_p);
    t_cross += weight * f.t_coherence * f.t_s * std::conj(f.t_p);
  }
};

Means of(const FresnelCoefficients& f) {
  Means means;
  means.add(f, 1.0);
  return means;
}

void expect_equal(const Means& one, const Means& other, double within) {
  for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(one.powers[k], other.powers[k], within) << k;
  EXPECT_NEAR(std::abs(one.r_cross - other.r_cross), 0.0, within);
  EXPECT_NEAR(std::abs(one.t_cross - other.t_cross), 0.0, within);
}

/// Returns the cosine of the angle of incidence inside a layer for light from a medium.
double cosine_in(double index, double from_index, double cosine) {
  return std::sqrt(1.0 - std::pow(from_index / index, 2.0) * (1.0 - cosine * cosine));
}

// The result for a thick layer is the mean of the results for coherent layers over a whole fringe, that is over all
// phases. Bare bodies and bodies with a thin layer are tested for light from both sides, also beyond the critical angle
// of air.
TEST(ThickLayers, MeansOverFringesOfCoherentLayers) {
  constexpr int kPoints = 64;
  const LayerStack quarter{{{1.3777, 0.25 / 1.3777}}};
  for (const LayerStack& thin : {LayerStack{}, quarter})
    for (const double index : {kWater, 1.7})
      for (const StackSide side : {StackSide::body, StackSide::outside})
        for (const double cosine : {1.0, 0.95, 0.8, 0.7, 0.55}) {
          const double from = side == StackSide::body ? kBody : 1.0;
          const double to = side == StackSide::body ? 1.0 : kBody;
          const double fringe = 0.5 / (index * cosine_in(index, from, cosine));  // half a wavelength across the layer
          Means coherent;
          for (int k = 0; k < kPoints; ++k) {
            LayerStack stack = thin;
            stack.layers.push_back({index, fringe * (3.0 + static_cast<double>(k) / kPoints)});
            coherent.add(fresnel_layers(stack, side, from, to, cosine), 1.0 / kPoints);
          }
          const std::vector<ThickLayer> thick = {{index, 1.0, 0.0}};
          const FresnelCoefficients f = fresnel_thick_layers(thin, thick, side, from, to, cosine);
          expect_equal(of(f), coherent, 1e-12);
          EXPECT_LE(f.r_coherence, 1.0);
          EXPECT_LE(f.t_coherence, 1.0);
        }
}

// Compares the results for several layers with a simulation that propagates the power from face to face until no power
// remains.
TEST(ThickLayers, PowerThatWalksFromFaceToFace) {
  const std::vector<ThickLayer> layers = {{1.6, 0.4, 0.7}, {1.45, 0.2, 0.0}, {kWater, 0.5, 0.3}};
  const std::vector<double> indices = {kBody, 1.6, 1.45, kWater, 1.0};
  for (const double outside : {1.0, 0.7, 0.2})
    for (const bool is_s : {true, false}) {
      std::vector<double> cosines;
      for (const double index : indices) cosines.push_back(cosine_in(index, 1.0, outside));
      std::vector<double> up(5, 0.0);
      std::vector<double> down(5, 0.0);
      down[4] = 1.0;
      double reflected = 0.0;
      double passed = 0.0;
      for (int step = 0; step < 400; ++step) {
        std::vector<double> next_up(5, 0.0);
        std::vector<double> next_down(5, 0.0);
        for (std::size_t k = 0; k < 5; ++k) {
          const double kept =
              k == 0 || k == 4 ? 1.0
                               : std::exp(-layers[k - 1].absorption_per_mm * layers[k - 1].thickness_mm / cosines[k]);
          const auto reflectance = [&](std::size_t to) {
            const FresnelCoefficients f = fresnel(indices[k] / indices[to], cosines[k]);
            return std::norm(is_s ? f.r_s : f.r_p);
          };
          const double first = step == 0 ? 1.0 : kept;  // light has no path in a layer before the first step
          if (k > 0) {
            next_up[k] += reflectance(k - 1) * first * down[k];
            next_down[k - 1] += (1.0 - reflectance(k - 1)) * first * down[k];
          }
          if (k < 4) {
            next_down[k] += reflectance(k + 1) * first * up[k];
            next_up[k + 1] += (1.0 - reflectance(k + 1)) * first * up[k];
          }
        }
        reflected += next_up[4];
        passed += next_down[0];
        next_up[4] = next_down[0] = 0.0;
        up = next_up;
        down = next_down;
      }
      const FresnelCoefficients f = fresnel_thick_layers({}, layers, StackSide::outside, 1.0, kBody, outside);
      EXPECT_NEAR(std::norm(is_s ? f.r_s : f.r_p), reflected, 1e-13);
      EXPECT_NEAR(std::norm(is_s ? f.t_s : f.t_p), passed, 1e-13);
    }
}

// The reflectance of a plate is R1 + T1^2 R2 a^2 / (1 - R1 R2 a^2). Its transmittance is T1 T2 a / (1 - R1 R2 a^2).
TEST(ThickLayers, APlateThatAbsorbs) {
  const std::vector<ThickLayer> plate = {{1.6, 0.5, 0.8}};
  for (const double cosine : {1.0, 0.8, 0.4}) {
    const double inside = cosine_in(1.6, 1.0, cosine);
    const double a = std::exp(-0.8 * 0.5 / inside);
    const FresnelCoefficients front = fresnel(1.0 / 1.6, cosine);
    const FresnelCoefficients back = fresnel(1.6 / kBody, inside);
    const FresnelCoefficients f = fresnel_thick_layers({}, plate, StackSide::outside, 1.0, kBody, cosine);
    const std::array<std::array<double, 4>, 2> both = {
        {{std::norm(front.r_s), std::norm(back.r_s), std::norm(f.r_s), std::norm(f.t_s)},
         {std::norm(front.r_p), std::norm(back.r_p), std::norm(f.r_p), std::norm(f.t_p)}}};
    for (const auto& [r1, r2, r, t] : both) {
      EXPECT_NEAR(r, r1 + (1.0 - r1) * (1.0 - r1) * r2 * a * a / (1.0 - r1 * r2 * a * a), 1e-14);
      EXPECT_NEAR(t, (1.0 - r1) * (1.0 - r2) * a / (1.0 - r1 * r2 * a * a), 1e-14);
    }
    EXPECT_NEAR(f.cos_refracted, cosine_in(kBody, 1.0, cosine), 1e-14);
  }
}

TEST(ThickLayers, PowerIsConservedAndReversible) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  for (int k = 0; k < 400; ++k) {
    std::vector<ThickLayer> layers(1 + static_cast<std::size_t>(4.0 * uniform(random)));
    const bool absorbs = k % 2 == 1;
    for (ThickLayer& layer : layers)
      layer = {1.0 + uniform(random), uniform(random), absorbs ? 2.0 * uniform(random) : 0.0};
    const double outside = 0.05 + 0.95 * uniform(random);
    const double body = cosine_in(kBody, 1.0, outside);
    const FresnelCoefficients in = fresnel_thick_layers({}, layers, StackSide::outside, 1.0, kBody, outside);
    const FresnelCoefficients out = fresnel_thick_layers({}, layers, StackSide::body, kBody, 1.0, body);
    EXPECT_NEAR(std::norm(in.t_s), std::norm(out.t_s), 1e-12);
    EXPECT_NEAR(std::norm(in.t_p), std::norm(out.t_p), 1e-12);
    for (const double left : {1.0 - std::norm(in.r_s) - std::norm(in.t_s), 1.0 - std::norm(in.r_p) - std::norm(in.t_p),
                              1.0 - std::norm(out.r_s) - std::norm(out.t_s)}) {
      if (absorbs)
        EXPECT_GT(left, 0.0);
      else
        EXPECT_NEAR(left, 0.0, 1e-13);
    }
    // Beyond the critical angle of air, all light is reflected except the light that layers absorb.
    const FresnelCoefficients total = fresnel_thick_layers({}, layers, StackSide::body, kBody, 1.0, 0.5);
    EXPECT_TRUE(total.total_reflection);
    EXPECT_EQ(std::norm(total.t_s) + std::norm(total.t_p), 0.0);
    EXPECT_NEAR(std::norm(total.r_s) + std::norm(total.r_p), 2.0, absorbs ? 2.0 : 1e-12);
  }
}

// A layer with the index of the body or of the air has no effect, whether it covers the whole face or half of it.
TEST(ThickLayers, MatchedLayersAreAbsent) {
  for (const StackSide side : {StackSide::body, StackSide::outside})
    for (const double cosine : {1.0, 0.9, 0.6}) {
      const double from = side == StackSide::body ? kBody : 1.0;
      const double to = side == StackSide::body ? 1.0 : kBody;
      const FresnelCoefficients bare = fresnel(from / to, cosine);
      for (const double index : {1.0, kBody}) {
        const std::vector<ThickLayer> layer = {{index, 1.0, 0.0}};
        const FresnelCoefficients f = fresnel_thick_layers({}, layer, side, from, to, cosine);
        expect_equal(of(f), of(bare), 1e-14);
        expect_equal(of(mixed(bare, f, 0.5)), of(bare), 1e-14);
      }
    }
}

TEST(ThickLayers, MixturesAreMeansOfPowers) {
  const std::vector<ThickLayer> water = {{kWater, 1.0, 0.0}};
  const FresnelCoefficients bare = fresnel(1.0 / kBody, 0.6);
  const FresnelCoefficients wet = fresnel_thick_layers({}, water, StackSide::outside, 1.0, kBody, 0.6);
  Means means;
  means.add(bare, 0.7);
  means.add(wet, 0.3);
  expect_equal(of(mixed(bare, wet, 0.3)), means, 1e-15);
  expect_equal(of(mixed(bare, wet, 0.0)), of(bare), 1e-15);
}

}  // namespace
}  // namespace retrace::materials::thick_layers_test
