// Tests of the scattering of light by textures: sampling against densities, energy, reciprocity, and closed forms.
#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <boost/math/special_functions/bessel.hpp>

#include "core/error.h"
#include "materials/fresnel.h"
#include "surface_models/scatter/phase.h"
#include "tests/support/statistics.h"
#include "tests/surface_models/scatter_checks.h"

namespace retrace::testing::scatter_test {
namespace {

using namespace scatter_checks;

const std::vector<Roughness>& roughnesses() {
  static const std::vector<Roughness> all = {{20.0, 2.0, 0.0, 0.0},    // facet cut by diamond: narrow lobe
                                             {60.0, 0.6, 0.0, 0.0},    // wide lobe; light is diffracted several times
                                             {10.0, 0.15, 0.0, 0.0},   // lobe cut by the horizon
                                             {15.0, 1.0, 40.0, 20.0},  // waviness that diffracts
                                             {0.0, 0.0, 60.0, 15.0}};
  return all;
}

double lobe_width(const Roughness& r, const ScatterEvent& event, Lobe lobe) {
  const double length = r.sq_nm > 0.0 ? r.correlation_length_um : r.waviness_length_um / std::numbers::pi;
  return 1e-3 * event.wavelength_nm / (std::sqrt(2.0) * std::numbers::pi * event.index_of(lobe) * length);
}

TEST(HarveyShack, SamplesFollowTheDensity) {
  const double level = sidak_level(cases().size() * roughnesses().size());
  std::uint32_t seed = 0;
  for (const Roughness& r : roughnesses())
    for (const Case& c : cases()) {
      const HarveyShack model(r);
      const Rings rings(specular_direction(c.event, Vec3::UnitZ(), c.lobe)->head<2>(), lobe_width(r, c.event, c.lobe));
      EXPECT_GT(chi_square_p(rings, scaled_density(model, c.event, c.lobe), draw_of(model, c.event, c.lobe), ++seed),
                level)
          << c.name << ", Sq " << r.sq_nm << " nm, length " << r.correlation_length_um << " um";
    }
}

// The specular and the scattered light can be drawn together, with a random choice between them, or separately. Both
// methods must give the same powers, and the same mean and spread of the scattered directions.
TEST(HarveyShack, SharesDrawnApartAreThoseOfOneDraw) {
  constexpr std::uint32_t kDraws = 40000;
  const HarveyShack model({40.0, 2.0, 0.0, 0.0});
  const ScatterEvent event = inside(45.0);
  const double share = specular_fraction(model, event, {}, Lobe::reflection);
  std::array<double, 2> mean{};
  std::array<double, 2> square{};
  std::array<double, 2> count{};
  for (std::uint32_t k = 0; k < kDraws; ++k) {
    RandomStream random = stream(77, k);
    const auto both = sample_split(model, event, {}, Lobe::reflection, 0.01, random);
    ASSERT_TRUE(both && both->specular && both->scattered);
    EXPECT_NEAR(both->specular->weight, share, 1e-12);
    EXPECT_NEAR(both->scattered->weight, 1.0 - share, 1e-12);
    EXPECT_TRUE(both->specular->is_specular);
    RandomStream other = stream(78, k);
    const auto one = sample(model, event, {}, Lobe::reflection, other);
    const auto add = [&](std::size_t which, const ScatterSample& drawn) {
      const double off = drawn.direction.x() - drawn.specular_direction.x();
      mean[which] += off;
      square[which] += off * off;
      count[which] += 1.0;
    };
    add(0, *both->scattered);
    if (one && !one->is_specular) add(1, *one);
  }
  EXPECT_NEAR(count[1] / kDraws, 1.0 - share, 4.0 * std::sqrt(share * (1.0 - share) / kDraws));
  const double sigma = std::sqrt(square[0] / count[0]);
  EXPECT_NEAR(mean[0] / count[0], mean[1] / count[1], 4.0 * sigma * std::sqrt(1.0 / count[0] + 1.0 / count[1]));
  EXPECT_NEAR(std::sqrt(square[1] / count[1]) / sigma, 1.0, 0.05);
  RandomStream random = stream(79, 0);
  EXPECT_FALSE(sample_split(model, event, {}, Lobe::reflection, 0.9, random));
  EXPECT_FALSE(sample_split(Smooth{}, event, {}, Lobe::reflection, 0.01, random));
}

TEST(HarveyShack, ConservesEnergy) {
  for (const Roughness& r : {roughnesses()[1], roughnesses()[2]})
    for (const Case& c : cases()) {
      const HarveyShack model(r);
      const double scattered = disc_integral(scaled_density(model, c.event, c.lobe));
      EXPECT_NEAR(scattered + specular_fraction(model, c.event, {}, c.lobe), 1.0, 1e-5) << c.name;
    }
}

// The specular fraction is also measured by random sampling, so that the test is independent of the formula.
TEST(HarveyShack, SpecularShareIsTheClosedForm) {
  const auto draws = test::sample_size<std::uint32_t>(40000, 200000);
  std::uint32_t seed = 100;
  for (const double sq_nm : {5.0, 10.0, 20.0, 40.0, 80.0})
    for (const double waves : {2.0, 3.0, 10.0, 100.0})
      for (const double t_deg : {0.0, 45.0, 54.74, 75.0}) {
        const ScatterEvent event = inside(t_deg);
        const HarveyShack model({sq_nm, waves * 0.55 / kIndex, 0.0, 0.0});
        const double g = std::pow(4.0 * std::numbers::pi * kIndex * sq_nm * std::cos(t_deg * kRadians) / 550.0, 2);
        EXPECT_NEAR(specular_fraction(model, event, {}, Lobe::reflection), std::exp(-g), 1e-12);
        const double p = std::exp(-g);
        // The last term is one draw, because a fraction of draws is a multiple of it.
        EXPECT_NEAR(specular_draws(model, event, Lobe::reflection, ++seed, draws), p,
                    normal_bound(80) * std::sqrt(p * (1.0 - p) / draws) + 1.0 / draws)
            << sq_nm << " nm, " << waves << " waves, " << t_deg << " deg";
      }
}

// The specular fraction is also measured by random sampling for transmitted light and for light from outside.
TEST(HarveyShack, SpecularShareIsTheClosedFormOnBothSides) {
  std::uint32_t seed = 700;
  for (const Case& c : cases())
    for (const double sq_nm : {20.0, 60.0})
      expect_closed_form_share(HarveyShack({sq_nm, 4.0, 0.0, 0.0}), sq_nm, c, ++seed, 2 * cases().size());
}

TEST(HarveyShack, PublishedValues) {
  const auto scattered = [](double sq_nm, double t_deg, double w_nm) {
    return 1.0 - specular_fraction(HarveyShack({sq_nm, 5.0, 0.0, 0.0}), inside(t_deg, w_nm), {}, Lobe::reflection);
  };
  EXPECT_NEAR(scattered(10.0, 54.74, 550.0), 0.038, 5e-4);
  EXPECT_NEAR(scattered(20.0, 54.74, 550.0), 0.14, 5e-3);
  // With Sq = 30 nm, 63 % of the light remains specular after one total reflection in a right-angle prism at the d
  // line.
  EXPECT_NEAR(scattered(30.0, 45.0, 587.56), 0.37, 5e-3);
  EXPECT_NEAR(gaussian_sa(10.0), 7.978845608028654, 1e-12);
}

TEST(HarveyShack, TransmissionHasThePhaseOfTheDifferenceOfPaths) {
  const double t = 30.0 * kRadians;
  const double refracted = std::asin(kIndex * std::sin(t));
  const double phase = 2.0 * std::numbers::pi * 40.0 * (kIndex * std::cos(t) - std::cos(refracted)) / 550.0;
  EXPECT_NEAR(specular_fraction(HarveyShack({40.0, 5.0, 0.0, 0.0}), inside(30.0), {}, Lobe::transmission),
              std::exp(-phase * phase), 1e-12);
}

// Roughness with spatial frequencies above n / w does not scatter.
TEST(HarveyShack, FineRoughnessIsNotRelevant) {
  const double coarse = specular_fraction(HarveyShack({20.0, 1.0, 0.0, 0.0}), inside(45.0), {}, Lobe::reflection);
  const double fine = specular_fraction(HarveyShack({20.0, 0.02, 0.0, 0.0}), inside(45.0), {}, Lobe::reflection);
  EXPECT_GT(fine, 0.99);
  EXPECT_LT(coarse, 0.8);
}

// For small heights, first-order perturbation theory (Rayleigh-Rice without its polarisation factor) gives the BRDF (2
// pi n / w)^2 (cos t_i + cos t_s)^2 PSD / (w / n)^2.
TEST(HarveyShack, SmallRoughnessScattersAsThePsd) {
  const double sq_um = 1e-5, length_um = 1.0, wave_um = 0.55 / kIndex;
  const ScatterEvent event = inside(30.0);
  const HarveyShack model({1e3 * sq_um, length_um, 0.0, 0.0});
  const Vec2 beta(0.3, -0.1);
  const double f2 = (beta - event.direction_in.head<2>()).squaredNorm() / (wave_um * wave_um);
  const double pi = std::numbers::pi;
  const double psd = sq_um * sq_um * pi * length_um * length_um * std::exp(-pi * pi * length_um * length_um * f2);
  const double cosines = std::cos(30.0 * kRadians) + std::sqrt(1.0 - beta.squaredNorm());
  const double expected = std::pow(2.0 * pi / wave_um * cosines, 2) * psd / (wave_um * wave_um);
  EXPECT_NEAR(model.unscaled_density(event, {}, Lobe::reflection, beta) / expected, 1.0, 1e-4);
}

// The model computes the density by a series. The reference is the Fourier transform of the surface transfer function
// without its specular part (Krywonos et al. 2011), computed by numerical integration.
TEST(HarveyShack, DensityIsTheTransformOfTheSurfaceTransferFunction) {
  const double pi = std::numbers::pi;
  for (const Roughness& r : {Roughness{60.0, 1.2, 0.0, 0.0}, Roughness{25.0, 1.2, 40.0, 12.0}})
    for (const Case& c : cases()) {
      const double n_out = c.event.index_of(c.lobe), wave_um = 0.55 / n_out;
      const double waviness_correlation_um = r.waviness_length_um / pi;
      const Vec2 specular = specular_direction(c.event, Vec3::UnitZ(), c.lobe)->head<2>();
      for (const double shift : {0.0, 0.02, 0.1}) {
        const Vec2 beta = specular * (1.0 - shift);
        const double moved = (beta - specular).norm();
        const double out = std::sqrt(1.0 - beta.squaredNorm()) * n_out;
        const double cosines = c.event.index_from * c.event.cos_in() + (c.lobe == Lobe::reflection ? out : -out);
        const double k2 = std::pow(2.0 * pi / 550.0 * cosines, 2);
        const double rough = k2 * r.sq_nm * r.sq_nm, wavy = k2 * r.waviness_sq_nm * r.waviness_sq_nm;
        const auto transfer_less_specular = [&](double d_um) {
          const double x = d_um / r.correlation_length_um;
          double correlated = rough * std::exp(-x * x);
          if (wavy > 0.0) correlated += wavy * std::exp(-std::pow(d_um / waviness_correlation_um, 2));
          return std::exp(-rough - wavy) * std::expm1(correlated);
        };
        const double transform = boost::math::quadrature::gauss_kronrod<double, 61>::integrate(
            [&](double d_um) {
              return d_um * transfer_less_specular(d_um) *
                     boost::math::cyl_bessel_j(0, 2.0 * pi * d_um * moved / wave_um);
            },
            0.0, 8.0 * std::max(r.correlation_length_um, waviness_correlation_um), 10, 1e-12);
        const double expected = 2.0 * pi / (wave_um * wave_um) * transform;
        const double peak = HarveyShack(r).unscaled_density(c.event, {}, c.lobe, specular);
        EXPECT_NEAR(HarveyShack(r).unscaled_density(c.event, {}, c.lobe, beta), expected, 1e-6 * peak) << c.name;
      }
    }
}

TEST(HarveyShack, IsReciprocalBeforeScaling) {
  for (const Roughness& r : roughnesses()) {
    if (r.correlation_length_um == 0.15) continue;  // too short for reciprocity
    const HarveyShack model(r);
    for (const double a : {0.1, 0.35, 0.6})
      for (const double b : {0.05, 0.4, 0.63}) {
        const Vec3 down = -direction_of(Vec2(-a, 0.1), Lobe::reflection);
        const Vec3 up = direction_of(Vec2(b, -0.1), Lobe::reflection);
        ScatterEvent forward = inside(0.0), backward = inside(0.0);
        forward.direction_in = down;
        backward.direction_in = -up;
        const double there = model.unscaled_density(forward, {}, Lobe::reflection, up.head<2>());
        const double back = model.unscaled_density(backward, {}, Lobe::reflection, -down.head<2>());
        EXPECT_NEAR(there, back, 1e-9 * there);

        if (r.correlation_length_um == 0.6) continue;  // shorter than two wavelengths in air
        ScatterEvent out = inside(0.0), in = outside(0.0);
        out.direction_in = down;
        const Vec3 left = direction_of(Vec2(b, -0.1), Lobe::transmission);
        // As seen from outside, the directions are rotated by 180 degrees about x.
        const auto turned = [](const Vec3& v) { return Vec3(v.x(), -v.y(), -v.z()); };
        in.direction_in = turned(-left);
        const double leaves = model.unscaled_density(out, {}, Lobe::transmission, left.head<2>());
        const double enters = model.unscaled_density(in, {}, Lobe::transmission, turned(-down).head<2>());
        EXPECT_NEAR(leaves * kIndex * kIndex, enters, 1e-9 * enters);
      }
  }
}

// The waviness model changes from diffraction to reflection by slopes at a threshold of the phase. There, both must
// give the same spread.
TEST(HarveyShack, WavinessHasOneWidthOnBothSidesOfItsThreshold) {
  const double waviness_length_um = 40.0;
  const auto spread = [&](double phase2) {
    const double sq_nm = std::sqrt(phase2) * 550.0 / (4.0 * std::numbers::pi * kIndex * std::cos(45.0 * kRadians));
    const HarveyShack model({0.0, 0.0, sq_nm, waviness_length_um});
    const ScatterEvent event = inside(45.0);
    double sum = 0.0;
    constexpr std::uint32_t kDraws = 100000;
    for (std::uint32_t k = 0; k < kDraws; ++k) {
      RandomStream random = stream(5, k);
      const Facet facet = sample_facet(model, event, random);
      EXPECT_EQ(facet.is_tilted, phase2 >= kSlopePhase2);
      const auto drawn = sample(model, event, facet, Lobe::reflection, random);
      EXPECT_TRUE(drawn);
      sum += (drawn->direction - event.direction_in).head<2>().squaredNorm();
    }
    return std::sqrt(sum / kDraws / phase2);
  };
  EXPECT_NEAR(spread(9.999) / spread(10.001), 1.0, 0.01);
}

TEST(HarveyShack, OnlyTheWavinessOwnPhaseDecidesOnSlopes) {
  const HarveyShack rough({500.0, 5.0, 10.0, 20.0});
  RandomStream random = stream(1, 1);
  EXPECT_FALSE(sample_facet(rough, inside(0.0), random).is_tilted);
  const HarveyShack wavy({5.0, 5.0, 300.0, 50.0});
  EXPECT_TRUE(sample_facet(wavy, inside(45.0), random).is_tilted);
  EXPECT_FALSE(sample_facet(wavy, inside(85.0), random).is_tilted);
}

// Light is scattered by roughness on a facet that waviness has tilted. Given the facet, the weight of a draw is BSDF *
// cosine / pdf.
TEST(HarveyShack, WeightOnATiltedFacet) {
  const ScatterModel model = HarveyShack({20.0, 1.0, 400.0, 20.0});
  const ScatterEvent event = inside(50.0);
  int compared = 0;
  for (std::uint32_t k = 0; compared < 20; ++k) {
    RandomStream random = stream(6, k);
    const Facet facet = sample_facet(model, event, random);
    const auto drawn = sample(model, event, facet, Lobe::reflection, random);
    if (!drawn || drawn->is_specular) continue;
    ++compared;
    const double cosine = drawn->direction.dot(facet.normal);
    const double bsdf = evaluate(model, event, facet, Lobe::reflection, drawn->direction);
    EXPECT_NEAR(drawn->weight, bsdf * cosine / pdf(model, event, facet, Lobe::reflection, drawn->direction), 1e-12);
    EXPECT_LE(drawn->weight, 1.0);
    EXPECT_GT(bsdf, 0.0);
  }
}

const std::vector<std::array<double, 3>>& abg_parameters() {
  static const std::vector<std::array<double, 3>> all = {
      {0.02, 1e-2, 1.0}, {0.02, 1e-3, 2.0}, {1e-3, 1e-4, 2.5}, {1e-5, 1e-6, 3.0}};
  return all;
}

TEST(Abg, SamplesFollowTheDensity) {
  const double level = sidak_level(cases().size() * abg_parameters().size());
  std::uint32_t seed = 300;
  for (const auto& [a, b, g] : abg_parameters())
    for (const Case& c : cases()) {
      const Abg model(a, b, g);
      const Rings rings(specular_direction(c.event, Vec3::UnitZ(), c.lobe)->head<2>(), 2.0 * std::pow(b, 1.0 / g));
      const Density density = [&](const Vec2& beta) { return model.scattered_density(c.event, {}, c.lobe, beta); };
      EXPECT_GT(chi_square_p(rings, density, draw_of(model, c.event, c.lobe), ++seed, 2000000), level)
          << c.name << ", g " << g;
    }
}

TEST(Abg, WhatDoesNotScatterIsSpecular) {
  const Abg model(0.02, 0.01, 1.0);
  for (const Case& c : cases()) {
    const Density density = [&](const Vec2& beta) { return model.scattered_density(c.event, {}, c.lobe, beta); };
    EXPECT_NEAR(disc_integral(density), 1.0 - specular_fraction(model, c.event, {}, c.lobe), 2e-4) << c.name;
  }
}

TEST(Abg, IsReciprocalInReflection) {
  for (const auto& [a, b, g] : abg_parameters()) {
    const ScatterModel model = Abg(a, b, g);
    for (const double x : {0.1, 0.35, 0.6})
      for (const double y : {0.05, 0.4, 0.63})
        for (const bool is_inside : {true, false}) {
          ScatterEvent forward = is_inside ? inside(0.0) : outside(0.0), backward = forward;
          forward.direction_in = -direction_of(Vec2(-x, 0.1), Lobe::reflection);
          const Vec3 up = direction_of(Vec2(y, -0.1), Lobe::reflection);
          backward.direction_in = -up;
          const double there = evaluate(model, forward, {}, Lobe::reflection, up);
          EXPECT_GT(there, 0.0);
          EXPECT_NEAR(evaluate(model, backward, {}, Lobe::reflection, -forward.direction_in), there, 1e-12 * there);
        }
  }
}

// The total integrated scatter at normal incidence is pi A ln(1 + 1 / B) for g = 2.
TEST(Abg, TotalScatterInClosedForm) {
  EXPECT_NEAR(specular_fraction(Abg(0.01, 1e-3, 2.0), inside(0.0), {}, Lobe::reflection),
              1.0 - std::numbers::pi * 0.01 * std::log1p(1e3), 1e-7);
}

TEST(Abg, RefusesMoreScatterThanLight) {
  EXPECT_NO_THROW(Abg(0.03, 1e-3, 2.0));
  EXPECT_THROW(Abg(0.05, 1e-3, 2.0), InputError);
  EXPECT_THROW(Abg(0.0, 1e-3, 2.0), InputError);
  EXPECT_THROW(Abg(0.01, 0.0, 2.0), InputError);
  EXPECT_THROW(Abg(0.01, 1e-3, 0.0), InputError);
}

struct MicrofacetCase {
  SlopeShape shape;
  double rms_slope;
};
constexpr MicrofacetCase kMicrofacets[] = {{SlopeShape::beckmann, 0.02}, {SlopeShape::beckmann, 0.3},
                                           {SlopeShape::beckmann, 0.8},  {SlopeShape::ggx, 0.02},
                                           {SlopeShape::ggx, 0.3},       {SlopeShape::ggx, 0.8}};

Draw facet_draw(const Microfacet& model, const ScatterEvent& event, Lobe lobe) {
  return [=](RandomStream& random) -> std::optional<Vec2> {
    const Facet facet = sample_facet(model, event, random);
    const auto drawn = sample(model, event, facet, lobe, random);
    if (!drawn) return std::nullopt;
    return Vec2(drawn->direction.head<2>());
  };
}

TEST(Microfacet, SamplesFollowTheDensity) {
  const double level = sidak_level(cases().size() * std::size(kMicrofacets));
  std::uint32_t seed = 400;
  for (const auto& [shape, rms_slope] : kMicrofacets)
    for (const Case& c : cases()) {
      const Microfacet model(shape, rms_slope);
      const Rings rings(specular_direction(c.event, Vec3::UnitZ(), c.lobe)->head<2>(), rms_slope);
      const Density density = [&](const Vec2& beta) {
        const Vec3 direction = direction_of(beta, c.lobe);
        return model.pdf_per_sr(c.event, c.lobe, direction) / std::abs(direction.z());
      };
      EXPECT_GT(chi_square_p(rings, density, facet_draw(model, c.event, c.lobe), ++seed), level)
          << c.name << ", slope " << rms_slope << (shape == SlopeShape::ggx ? " ggx" : " beckmann");
    }
}

TEST(Microfacet, WeightIsBsdfTimesCosineOverPdf) {
  for (const auto& [shape, rms_slope] : kMicrofacets)
    for (const Case& c : cases()) {
      const Microfacet model(shape, rms_slope);
      for (std::uint32_t k = 0; k < 1000; ++k) {
        RandomStream random = stream(7, k);
        const Facet facet = sample_facet(model, c.event, random);
        EXPECT_NEAR(facet.normal.norm(), 1.0, 1e-12);
        EXPECT_LT(facet.normal.dot(c.event.direction_in), 0.0);
        const auto drawn = sample(model, c.event, facet, c.lobe, random);
        if (!drawn) continue;
        const auto found = model.facet_towards(c.event, c.lobe, drawn->direction);
        ASSERT_TRUE(found);
        EXPECT_NEAR((*found - facet.normal).norm(), 0.0, 1e-7);
        const double expected = model.bsdf_per_sr(c.event, c.lobe, drawn->direction) * std::abs(drawn->direction.z()) /
                                model.pdf_per_sr(c.event, c.lobe, drawn->direction);
        EXPECT_NEAR(drawn->weight, expected, 1e-9);
        EXPECT_LE(drawn->weight, 1.0);
      }
    }
}

// Reflection and transmission, with Fresnel's factors at the facet, together contain at most all light. The remainder
// is masked, which is little for moderate Gaussian slopes.
TEST(Microfacet, EnergyOfBothLobes) {
  for (const auto& [shape, rms_slope] : kMicrofacets) {
    if (rms_slope < 0.1) continue;  // too narrow for the plain rule of the test; its weights are 1
    for (const ScatterEvent& event : {inside(0.0), inside(30.0), inside(54.74), inside(80.0), outside(40.0)}) {
      const Microfacet model(shape, rms_slope);
      double sum = 0.0;
      for (const Lobe lobe : {Lobe::reflection, Lobe::transmission})
        sum += disc_integral([&](const Vec2& beta) {
          const Vec3 direction = direction_of(beta, lobe);
          const auto normal = model.facet_towards(event, lobe, direction);
          if (!normal) return 0.0;
          const double r = materials::reflectance(event.index_from / event.index_to, -event.direction_in.dot(*normal));
          return (lobe == Lobe::reflection ? r : 1.0 - r) * model.bsdf_per_sr(event, lobe, direction);
        });
      EXPECT_LT(sum, 1.0 + 1e-3);
      const bool is_moderate = shape == SlopeShape::beckmann && rms_slope < 0.5 && event.cos_in() > 0.5;
      EXPECT_GT(sum, is_moderate ? 0.85 : 0.4);
    }
  }
}

TEST(Microfacet, IsReciprocal) {
  for (const auto& [shape, rms_slope] : kMicrofacets) {
    const Microfacet model(shape, std::max(0.1, rms_slope));
    for (const double a : {0.1, 0.35, 0.6})
      for (const double b : {0.05, 0.4, 0.63}) {
        ScatterEvent forward = inside(0.0), backward = inside(0.0), in = outside(0.0);
        forward.direction_in = -direction_of(Vec2(-a, 0.1), Lobe::reflection);
        const Vec3 up = direction_of(Vec2(b, -0.1), Lobe::reflection);
        backward.direction_in = -up;
        const double there = model.bsdf_per_sr(forward, Lobe::reflection, up);
        EXPECT_NEAR(there, model.bsdf_per_sr(backward, Lobe::reflection, -forward.direction_in), 1e-12 * there);
        const Vec3 left = direction_of(Vec2(b, -0.1), Lobe::transmission);
        const auto turned = [](const Vec3& v) { return Vec3(v.x(), -v.y(), -v.z()); };
        in.direction_in = turned(-left);
        const double leaves = model.bsdf_per_sr(forward, Lobe::transmission, left);
        const double enters = model.bsdf_per_sr(in, Lobe::transmission, turned(-forward.direction_in));
        EXPECT_NEAR(leaves * kIndex * kIndex, enters, 1e-9 * enters);
      }
  }
}

// The areal rms slope is 2 pi Sq / L. Light at normal incidence is deviated by twice the slope.
TEST(Microfacet, SlopeOfWaviness) {
  const Microfacet model = Microfacet::of_waviness(SlopeShape::beckmann, 100.0, 50.0);
  double sum = 0.0;
  constexpr std::uint32_t kDraws = 200000;
  for (std::uint32_t k = 0; k < kDraws; ++k) {
    RandomStream random = stream(8, k);
    sum += sample_facet(model, inside(0.0), random).normal.head<2>().squaredNorm();
  }
  const double slope = 2.0 * std::numbers::pi * 0.1 / 50.0;
  EXPECT_NEAR(std::sqrt(sum / kDraws) / slope, 1.0, 0.01);
}

TEST(Scatter, SmoothIsSpecular) {
  RandomStream random = stream(9, 0);
  for (const ScatterModel& model :
       {ScatterModel(Smooth()), ScatterModel(HarveyShack({})), ScatterModel(Microfacet(SlopeShape::ggx, 0.0))})
    for (const Case& c : cases()) {
      const Facet facet = sample_facet(model, c.event, random);
      EXPECT_EQ(facet.normal, Vec3(Vec3::UnitZ()));
      const auto drawn = sample(model, c.event, facet, c.lobe, random);
      ASSERT_TRUE(drawn);
      EXPECT_TRUE(drawn->is_specular);
      EXPECT_EQ(drawn->weight, 1.0);
      EXPECT_LT((drawn->direction - *specular_direction(c.event, Vec3::UnitZ(), c.lobe)).norm(), 1e-14);
      EXPECT_EQ(specular_fraction(model, c.event, facet, c.lobe), 1.0);
      EXPECT_EQ(evaluate(model, c.event, facet, c.lobe, drawn->direction), 0.0);
    }
}

// Tests every model that has a density, on both sides and in both lobes. Microfacet has a separate test. A long run
// tests every model in every case, the usual run every model in every second case. Each case then has two of the four
// models.
TEST(Scatter, WeightIsBsdfTimesCosineOverPdf) {
  const std::vector<ScatterModel> models = {HarveyShack({60.0, 0.6, 0.0, 0.0}), HarveyShack({15.0, 1.0, 40.0, 20.0}),
                                            Abg(0.02, 1e-2, 1.0),
                                            HeightMapScatter(random_map(32, 0.4, 40.0, 2.0, 1.0), 550.0)};
  std::size_t number = 0;
  for (std::size_t m = 0; m < models.size(); ++m)
    for (const Case& c : cases()) {
      if (number++ % 2 != m % 2 && !test::is_long_run()) continue;
      const ScatterModel& model = models[m];
      int compared = 0;
      for (std::uint32_t k = 0; compared < 1; ++k) {
        ASSERT_LT(k, 10000U) << c.name;
        RandomStream random = stream(30, k);
        const Facet facet = sample_facet(model, c.event, random);
        const auto drawn = sample(model, c.event, facet, c.lobe, random);
        ASSERT_TRUE(drawn) << c.name;
        EXPECT_LE(drawn->weight, 1.0);
        if (drawn->is_specular) continue;
        ++compared;
        const double bsdf = evaluate(model, c.event, facet, c.lobe, drawn->direction);
        const double density = pdf(model, c.event, facet, c.lobe, drawn->direction);
        EXPECT_GT(density, 0.0);
        EXPECT_NEAR(drawn->weight, bsdf * std::abs(drawn->direction.dot(facet.normal)) / density, 1e-12) << c.name;
      }
    }
}

TEST(Scatter, TotalReflectionTransmitsNothing) {
  const ScatterEvent event = inside(54.74);
  for (const ScatterModel& model :
       {ScatterModel(Smooth()), ScatterModel(HarveyShack({20.0, 1.0, 0.0, 0.0})), ScatterModel(Abg(0.01, 0.01, 2.0)),
        ScatterModel(Microfacet(SlopeShape::beckmann, 0.01)),
        ScatterModel(HeightMapScatter(random_map(32, 0.4, 20.0, 1.5, 1.5), 550.0))}) {
    RandomStream random = stream(10, 0);
    const Facet facet = sample_facet(model, event, random);
    EXPECT_FALSE(sample(model, event, facet, Lobe::transmission, random));
    EXPECT_EQ(specular_fraction(model, event, facet, Lobe::transmission), 0.0);
    EXPECT_EQ(evaluate(model, event, facet, Lobe::transmission, -Vec3::UnitZ()), 0.0);
  }
}

TEST(Scatter, SameCountersGiveTheSameSample) {
  const ScatterModel model = HarveyShack({20.0, 1.0, 400.0, 20.0});
  const auto draw = [&] {
    RandomStream random({1, 2}, 3, 4, 5);
    const Facet facet = sample_facet(model, inside(45.0), random);
    return sample(model, inside(45.0), facet, Lobe::reflection, random)->direction;
  };
  EXPECT_EQ(draw(), draw());
}

TEST(Scatter, WarnsOutsideItsRange) {
  EXPECT_TRUE(warnings(HarveyShack({20.0, 2.0, 60.0, 80.0}), kIndex, 550.0).empty());
  EXPECT_EQ(warnings(HarveyShack({20.0, 0.3, 0.0, 0.0}), kIndex, 550.0).size(), 1U);
  EXPECT_EQ(warnings(HarveyShack({300.0, 1.0, 0.0, 0.0}), kIndex, 550.0).size(), 2U);
  EXPECT_EQ(warnings(HarveyShack({0.0, 0.0, 60.0, 1.0}), kIndex, 550.0).size(), 2U);
  EXPECT_EQ(warnings(Microfacet(SlopeShape::ggx, 0.5), kIndex, 550.0).size(), 1U);
  EXPECT_EQ(warnings(Microfacet::of_waviness(SlopeShape::ggx, 20.0, 50.0), kIndex, 550.0).size(), 1U);
  EXPECT_TRUE(warnings(Microfacet::of_waviness(SlopeShape::ggx, 200.0, 50.0), kIndex, 550.0).empty());
  EXPECT_TRUE(warnings(Smooth(), kIndex, 550.0).empty());
  EXPECT_TRUE(warnings(Abg(1e-3, 1e-4, 2.0), kIndex, 550.0).empty());
  EXPECT_EQ(warnings(Abg(0.01, 1e-4, 2.0), kIndex, 550.0).size(), 1U);
}

// The slopes of roughness count only for spatial frequencies that scatter, which are below n / w.
TEST(Scatter, RefusesSlopesBeyondEveryModel) {
  EXPECT_THROW(HarveyShack({0.0, 0.0, 1000.0, 6.0}), InputError);
  EXPECT_NO_THROW(HarveyShack({0.0, 0.0, 1000.0, 6.5}));
  EXPECT_THROW(Microfacet(SlopeShape::beckmann, 1.01), InputError);
  EXPECT_THROW(require_in_range(HarveyShack({1010.0, 2.0, 0.0, 0.0}), kIndex, 550.0), InputError);
  EXPECT_NO_THROW(require_in_range(HarveyShack({990.0, 2.0, 0.0, 0.0}), kIndex, 550.0));
  EXPECT_NO_THROW(require_in_range(HarveyShack({20.0, 0.02, 0.0, 0.0}), kIndex, 550.0));
  EXPECT_NO_THROW(require_in_range(Smooth(), kIndex, 550.0));
}

TEST(Scatter, RefusesValuesOutOfRange) {
  EXPECT_THROW(HarveyShack({-1.0, 1.0, 0.0, 0.0}), InputError);
  EXPECT_THROW(HarveyShack({1.0, 0.0, 0.0, 0.0}), InputError);
  EXPECT_THROW(HarveyShack({0.0, 0.0, 1.0, 0.0}), InputError);
  EXPECT_THROW(Microfacet(SlopeShape::ggx, -0.1), InputError);
  EXPECT_THROW(Microfacet::of_waviness(SlopeShape::ggx, 1.0, 0.0), InputError);
}

}  // namespace
}  // namespace retrace::testing::scatter_test
