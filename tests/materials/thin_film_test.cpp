// Tests of layers on faces against closed forms, conservation laws, and sums over multiple reflections.
#include "materials/thin_film.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "core/infinity.h"

namespace retrace::materials::thin_film_test {
namespace {

using Complex = std::complex<double>;

constexpr double kGlass = 1.4917;
constexpr double kMgF2 = 1.3777;
const Complex kAluminium(1.15, 6.9);

ThinLayer quarter_wave(double index) {
  return {index, 0.25 / index};
}

double reflectance_of(const LayerStack& stack, StackSide from, double from_index, double to_index) {
  return std::norm(fresnel_layers(stack, from, from_index, to_index, 1.0).r_s);
}

/// Returns the component of a wave vector along the normal. Evanescent waves decay.
Complex along_normal(Complex index, double from_index, double ci) {
  const Complex w = std::sqrt(index * index - from_index * from_index * (1.0 - ci * ci));
  return w.imag() < 0.0 ? -w : w;
}

struct Amplitudes {
  Complex r, t;
};

/// Returns the amplitudes of an interface between media with these indices and normal components. t is the ratio of the
/// field E for s, and of H for p.
Amplitudes interface(Complex n1, Complex w1, Complex n2, Complex w2, bool is_p) {
  const Complex a = is_p ? w1 * n2 * n2 : w1;
  const Complex b = is_p ? w2 * n1 * n1 : w2;
  return {(a - b) / (a + b), 2.0 * a / (a + b)};
}

/// Computes the amplitudes by recursion from the last layer (Rouard; Parratt), with interfaces and phases only and
/// without matrices.
/// \param layers in the order in which the wave reaches them
Amplitudes by_recursion(const std::vector<ThinLayer>& layers, double from_index, Complex last, double ci, bool is_p) {
  const auto w = [&](Complex n) { return along_normal(n, from_index, ci); };
  const auto n = [&](std::size_t k) { return k == 0 ? Complex(from_index) : layers[k - 1].index; };
  Amplitudes sum = interface(n(layers.size()), w(n(layers.size())), last, w(last), is_p);
  for (std::size_t k = layers.size(); k-- > 0;) {
    const Complex once = std::exp(Complex(0.0, 2.0 * std::numbers::pi * layers[k].thickness) * w(layers[k].index));
    const Amplitudes front = interface(n(k), w(n(k)), n(k + 1), w(n(k + 1)), is_p);
    const Complex loop = 1.0 + front.r * sum.r * once * once;
    sum = {(front.r + sum.r * once * once) / loop, front.t * sum.t * once / loop};
  }
  return sum;
}

/// Returns the power behind the stack that corresponds to an amplitude of E or H, as a fraction of the incident power.
double passed(const Amplitudes& a, double from_index, double to_index, double ci, bool is_p) {
  const double far = along_normal(to_index, from_index, ci).real() / (is_p ? to_index * to_index : 1.0);
  return std::norm(a.t) * far / (is_p ? ci / from_index : from_index * ci);
}

/// Returns a stack of 1 to 12 layers with thicknesses of up to two wavelengths.
LayerStack random_stack(std::mt19937_64& generator, bool is_absorbing) {
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  LayerStack stack;
  const auto count = static_cast<std::size_t>(1.0 + 12.0 * uniform(generator));
  for (std::size_t k = 0; k < count; ++k) {
    const double n = 1.0 + 1.6 * uniform(generator);
    const double absorbed = is_absorbing ? 3.0 * std::pow(uniform(generator), 4.0) : 0.0;
    stack.layers.push_back({{n, absorbed}, 2.0 * std::pow(uniform(generator), 3.0)});
  }
  return stack;
}

// The reflectance is ((n0 ns - n1^2) / (n0 ns + n1^2))^2, because a quarter-wave layer changes the admittance ns into
// n1^2 / ns.
TEST(ThinFilm, QuarterWaveOfOneLayer) {
  for (const double body : {1.3, kGlass, 1.585, 1.9, 2.4}) {
    const double expected = std::pow((body - kMgF2 * kMgF2) / (body + kMgF2 * kMgF2), 2.0);
    const LayerStack coat{{quarter_wave(kMgF2)}};
    EXPECT_NEAR(reflectance_of(coat, StackSide::outside, 1.0, body), expected, 1e-15);
    EXPECT_NEAR(reflectance_of(coat, StackSide::body, body, 1.0), expected, 1e-15);
  }
  // If n1 is the geometric mean of the neighbouring indices, nothing is reflected.
  EXPECT_NEAR(reflectance_of({{quarter_wave(std::sqrt(kGlass))}}, StackSide::outside, 1.0, kGlass), 0.0, 1e-30);
}

// N pairs of quarter-wave layers change the admittance into (n_H / n_L)^(2N) ns.
TEST(ThinFilm, QuarterWavePairs) {
  const double high = 2.3;
  const double low = 1.46;
  LayerStack stack;
  for (int pairs = 1; pairs <= 12; ++pairs) {
    stack.layers.push_back(quarter_wave(low));  // next to the body, so that light from outside meets H first
    stack.layers.push_back(quarter_wave(high));
    const double admittance = std::pow(high / low, 2.0 * pairs) * kGlass;
    const double expected = std::pow((1.0 - admittance) / (1.0 + admittance), 2.0);
    EXPECT_NEAR(reflectance_of(stack, StackSide::outside, 1.0, kGlass), expected, 1e-14) << pairs;
    EXPECT_NEAR(std::norm(fresnel_layers(stack, StackSide::outside, 1.0, kGlass, 1.0).t_p), 1.0 - expected, 1e-14);
  }
}

// Half-wave layers have no effect.
TEST(ThinFilm, HalfWavesAreAbsent) {
  for (const double n : {1.2, kMgF2, 2.3})
    EXPECT_NEAR(reflectance_of({{ThinLayer{n, 0.5 / n}}}, StackSide::body, kGlass, 1.0), reflectance(kGlass, 1.0),
                1e-15);
}

// Layers without thickness have no effect for any index. The face is a bare face, including total reflection and its
// phases.
TEST(ThinFilm, NoThicknessIsTheBareFace) {
  const LayerStack stack{{{2.3, 0.0}, {kAluminium, 0.0}, {1.0, 0.0}}};
  for (const double ratio : {kGlass, 1.0 / kGlass, 1.2})
    for (const StackSide side : {StackSide::body, StackSide::outside})
      for (double ci = 0.0; ci <= 1.0; ci += 1.0 / 64.0) {
        const double from = side == StackSide::body ? kGlass : 1.0;
        const FresnelCoefficients bare = fresnel(ratio, ci);
        const FresnelCoefficients f = fresnel_layers(stack, side, from, from / ratio, ci);
        EXPECT_NEAR(std::abs(f.r_s - bare.r_s), 0.0, 1e-12) << ratio << ' ' << ci;
        EXPECT_NEAR(std::abs(f.r_p - bare.r_p), 0.0, 1e-12) << ratio << ' ' << ci;
        EXPECT_NEAR(std::abs(f.t_s - bare.t_s), 0.0, 1e-12) << ratio << ' ' << ci;
        EXPECT_NEAR(std::abs(f.t_p - bare.t_p), 0.0, 1e-12) << ratio << ' ' << ci;
        EXPECT_NEAR(f.cos_refracted, bare.cos_refracted, 1e-15);
        EXPECT_EQ(f.total_reflection, bare.total_reflection);
      }
}

// Without layers, the results equal those of the bare face exactly. With a metal layer only, they equal those of the
// metal exactly.
TEST(ThinFilm, NothingAndMetalAloneAreTheirOwnFormulas) {
  const LayerStack metal{{{kAluminium, kInfinity}}};
  for (double ci = 0.0; ci <= 1.0; ci += 1.0 / 64.0) {
    const FresnelCoefficients bare = fresnel_layers({}, StackSide::body, kGlass, 1.333, ci);
    EXPECT_EQ(bare.r_s, fresnel(kGlass / 1.333, ci).r_s);
    EXPECT_EQ(bare.t_p, fresnel(kGlass / 1.333, ci).t_p);
    for (const auto& [side, index] : {std::pair(StackSide::body, kGlass), {StackSide::outside, 1.0}}) {
      const FresnelCoefficients f = fresnel_layers(metal, side, index, 1.0, ci);
      EXPECT_EQ(f.r_s, fresnel_metal(index / kAluminium, ci).r_s);
      EXPECT_EQ(f.r_p, fresnel_metal(index / kAluminium, ci).r_p);
      EXPECT_EQ(f.t_s, Complex());
      EXPECT_TRUE(f.total_reflection);
    }
  }
}

// A metal layer of 300 nm transmits nothing. The layers behind it have no effect, but the layers in front of it do.
TEST(ThinFilm, ThickMetalIsOpaque) {
  const LayerStack thick{{{1.46, 0.3}, {kAluminium, 0.51}, {1.6, 2.0}}};
  const LayerStack opaque{{{1.46, 0.3}, {kAluminium, kInfinity}, {1.6, 2.0}}};
  for (double ci = 0.01; ci <= 1.0; ci += 0.01)
    for (const StackSide side : {StackSide::body, StackSide::outside}) {
      const double from = side == StackSide::body ? kGlass : 1.0;
      const FresnelCoefficients a = fresnel_layers(thick, side, from, 1.0, ci);
      const FresnelCoefficients b = fresnel_layers(opaque, side, from, 1.0, ci);
      EXPECT_NEAR(std::abs(a.r_s - b.r_s), 0.0, 1e-9);
      EXPECT_NEAR(std::abs(a.r_p - b.r_p), 0.0, 1e-9);
      EXPECT_LT(std::norm(a.t_s) + std::norm(a.t_p), 1e-15);
    }
  // For any thickness, the amplitudes remain finite.
  const FresnelCoefficients f = fresnel_layers({{{kAluminium, 1e6}}}, StackSide::body, kGlass, 1.0, 0.5);
  EXPECT_NEAR(std::abs(f.r_s - fresnel_metal(kGlass / kAluminium, 0.5).r_s), 0.0, 1e-14);
  EXPECT_EQ(f.t_s, Complex());
}

TEST(ThinFilm, PowerIsConserved) {
  std::mt19937_64 generator(1);
  for (int k = 0; k < 400; ++k)
    for (const bool is_absorbing : {false, true}) {
      const LayerStack stack = random_stack(generator, is_absorbing);
      for (double ci = 0.0; ci <= 1.0; ci += 1.0 / 32.0)
        for (const auto& [side, from, to] :
             {std::tuple(StackSide::body, kGlass, 1.0), {StackSide::outside, 1.0, kGlass}}) {
          const FresnelCoefficients f = fresnel_layers(stack, side, from, to, ci);
          for (const double sum : {std::norm(f.r_s) + std::norm(f.t_s), std::norm(f.r_p) + std::norm(f.t_p)}) {
            if (is_absorbing)
              EXPECT_LE(sum, 1.0 + 1e-12);
            else
              EXPECT_NEAR(sum, 1.0, 1e-12) << k << ' ' << ci;
          }
        }
    }
}

// Reciprocity: the transmission amplitude is the same in both directions, including its phase, also with absorption.
// Without absorption, the reflection amplitudes of both directions follow from each other: r' = -conj(r) t / conj(t).
// These are Stokes' relations with reversed time.
TEST(ThinFilm, Reversible) {
  std::mt19937_64 generator(2);
  for (int k = 0; k < 200; ++k)
    for (const bool is_absorbing : {false, true}) {
      const LayerStack stack = random_stack(generator, is_absorbing);
      for (double ci = 0.05; ci <= 1.0; ci += 0.05) {
        const FresnelCoefficients in = fresnel_layers(stack, StackSide::outside, 1.0, kGlass, ci);
        const FresnelCoefficients out = fresnel_layers(stack, StackSide::body, kGlass, 1.0, in.cos_refracted);
        EXPECT_NEAR(std::abs(in.t_s - out.t_s), 0.0, 1e-12);
        EXPECT_NEAR(std::abs(in.t_p - out.t_p), 0.0, 1e-12);
        EXPECT_NEAR(out.cos_refracted, ci, 1e-14);
        if (is_absorbing) continue;
        EXPECT_NEAR(std::abs(out.r_s * std::conj(in.t_s) + std::conj(in.r_s) * in.t_s), 0.0, 1e-12);
        EXPECT_NEAR(std::abs(out.r_p * std::conj(in.t_p) + std::conj(in.r_p) * in.t_p), 0.0, 1e-12);
      }
    }
}

// The result for a single layer is the sum over its multiple reflections (Airy).
TEST(ThinFilm, SumOfAiry) {
  for (const Complex index : {Complex(kMgF2), Complex(2.3), Complex(1.0), Complex(1.7, 0.4), Complex(0.9, 2.0)})
    for (const bool is_p : {false, true})
      for (double ci = 0.1; ci <= 1.0; ci += 0.05) {
        const ThinLayer layer{index, 0.37};
        const Complex w0 = along_normal(kGlass, kGlass, ci);
        const Complex w1 = along_normal(index, kGlass, ci);
        const Complex w2 = along_normal(1.0, kGlass, ci);
        const Amplitudes front = interface(kGlass, w0, index, w1, is_p);
        const Amplitudes front_again = interface(index, w1, kGlass, w0, is_p);
        const Amplitudes back = interface(index, w1, 1.0, w2, is_p);
        const Complex once = std::exp(Complex(0.0, 2.0 * std::numbers::pi * layer.thickness) * w1);
        Complex inside = front.t * once;
        Complex r = front.r;
        Complex t = 0.0;
        for (int trip = 0; trip < 4000; ++trip) {
          t += inside * back.t;
          inside *= back.r * once;
          r += inside * front_again.t;
          inside *= front_again.r * once;
        }
        const FresnelCoefficients f = fresnel_layers({{layer}}, StackSide::body, kGlass, 1.0, ci);
        EXPECT_NEAR(std::abs((is_p ? f.r_p : f.r_s) - r), 0.0, 1e-11) << index << ci << is_p;
        if (!f.total_reflection) {
          EXPECT_NEAR(std::norm(is_p ? f.t_p : f.t_s), passed({r, t}, kGlass, 1.0, ci, is_p), 1e-11) << index << ci;
        }
      }
}

TEST(ThinFilm, ManyLayersAgreeWithRecursion) {
  std::mt19937_64 generator(3);
  for (int k = 0; k < 300; ++k) {
    const LayerStack stack = random_stack(generator, k % 2 == 0);
    const std::vector<ThinLayer> reversed(stack.layers.rbegin(), stack.layers.rend());
    for (double ci = 1.0 / 64.0; ci <= 1.0; ci += 1.0 / 32.0)
      for (const bool is_p : {false, true})
        for (const auto& [side, from, to] :
             {std::tuple(StackSide::body, kGlass, 1.0), {StackSide::outside, 1.0, kGlass}}) {
          const FresnelCoefficients f = fresnel_layers(stack, side, from, to, ci);
          const Amplitudes expected =
              by_recursion(side == StackSide::body ? stack.layers : reversed, from, to, ci, is_p);
          EXPECT_NEAR(std::abs((is_p ? f.r_p : f.r_s) - expected.r), 0.0, 1e-10) << k << ' ' << ci;
          if (f.total_reflection) continue;
          EXPECT_NEAR(std::norm(is_p ? f.t_p : f.t_s), passed(expected, from, to, ci, is_p), 1e-10) << k << ' ' << ci;
          EXPECT_NEAR(std::arg((is_p ? f.t_p : f.t_s) * std::conj(expected.t)), 0.0, 1e-9) << k << ' ' << ci;
        }
  }
}

// For a gap of air between two glasses, 1 / T = 1 + ((a^2 + b^2) / (2 a b))^2 sinh^2(k d |w|). The admittances of glass
// and gap are a and i b.
TEST(ThinFilm, FrustratedTotalReflection) {
  const double ci = 0.5;
  const double decay = std::sqrt(kGlass * kGlass * (1.0 - ci * ci) - 1.0);
  for (const double gap : {0.01, 0.1, 0.3, 1.0, 3.0}) {
    const FresnelCoefficients f = fresnel_layers({{{1.0, gap}}}, StackSide::body, kGlass, kGlass, ci);
    const auto expected = [&](double a, double b) {
      return 1.0 /
             (1.0 + std::pow((a * a + b * b) / (2.0 * a * b) * std::sinh(2.0 * std::numbers::pi * gap * decay), 2));
    };
    EXPECT_NEAR(std::norm(f.t_s) / expected(kGlass * ci, decay), 1.0, 1e-12) << gap;
    EXPECT_NEAR(std::norm(f.t_p) / expected(ci / kGlass, decay), 1.0, 1e-12) << gap;
    EXPECT_FALSE(f.total_reflection);
  }
}

// The absorbed power of a film follows from the field inside it. For s, it is 2 pi Im(n^2) times the integral of |E|^2
// over the thickness in wavelengths, divided by n0 cos t (Born and Wolf, 14.1).
TEST(ThinFilm, AbsorbedPowerIsThatOfTheField) {
  const ThinLayer film{kAluminium, 0.02};
  for (const double to : {1.0, 1.333})
    for (double ci = 0.1; ci <= 1.0; ci += 0.1) {
      const FresnelCoefficients f = fresnel_layers({{film}}, StackSide::body, kGlass, to, ci);
      const Complex w = along_normal(film.index, kGlass, ci);
      const Amplitudes back = interface(film.index, w, to, along_normal(to, kGlass, ci), false);
      const Complex once = std::exp(Complex(0.0, 2.0 * std::numbers::pi * film.thickness) * w);
      const Complex down = (1.0 + f.r_s) / (1.0 + back.r * once * once);  // E is continuous
      constexpr int kSteps = 2000;
      double integral = 0.0;
      for (int k = 0; k < kSteps; ++k) {  // midpoint rule
        const double z = film.thickness * (k + 0.5) / kSteps;
        const Complex turn = std::exp(Complex(0.0, 2.0 * std::numbers::pi * z) * w);
        integral += std::norm(down * (turn + back.r * once * once / turn)) * film.thickness / kSteps;
      }
      const double heat = 2.0 * std::numbers::pi * (film.index * film.index).imag() * integral / (kGlass * ci);
      EXPECT_NEAR(1.0 - std::norm(f.r_s) - std::norm(f.t_s), heat, 1e-6);
      EXPECT_GT(heat, 0.02);
    }
}

}  // namespace
}  // namespace retrace::materials::thin_film_test
