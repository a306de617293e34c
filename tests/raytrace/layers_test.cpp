// Tests of parts with layers on their faces: closed forms, and ledgers that add up to 1 in every engine.
#include <gtest/gtest.h>

#include <cmath>

#include "geometry/part/part.h"
#include "materials/thin_film.h"
#include "raytrace/exact/beam_tracer.h"
#include "raytrace/light/light_setup.h"
#include "raytrace/paths/monte_carlo.h"
#include "tests/support/designs.h"
#include "tests/support/engines.h"

namespace retrace::testing::layers_test {
namespace {

using namespace geometry;
using namespace raytrace;
using materials::FresnelCoefficients, materials::LayerStack, materials::StackSide, materials::fresnel_layers;

const LayerStack kProtected{{{std::complex<double>(1.13, 6.85), 0.15}, {1.4585, 0.25}}};

/// Returns the absorbed power of s and p polarised light: 1 less the reflected and the transmitted power.
std::array<double, 2> absorbed(const FresnelCoefficients& f) {
  return {1.0 - std::norm(f.r_s) - std::norm(f.t_s), 1.0 - std::norm(f.r_p) - std::norm(f.t_p)};
}

// All light that enters is reflected along the normal by mirrors. Multiple reflections give the RRE R + T^2 / (1 - R').
// R and T are the reflectance and transmittance of the coated face for light from outside. R' is its reflectance for
// light from inside.
TEST(Layers, CoatedEntranceBeforeMirrors) {
  const Part part = build_part(single(RtpElement{0.5, 0.5, 90.0}, 0.5));
  for (const LayerStack& stack : {anti_reflection(), thin_aluminium(), LayerStack{{{2.3, 0.1}, {1.46, 0.2}}}}) {
    Optics optics = pmma();
    optics.mirror_facets = true;
    optics.entrance_layers = stack;
    const FresnelCoefficients out = fresnel_layers(stack, StackSide::body, kPmma, 1.0, 1.0);
    const FresnelCoefficients in = fresnel_layers(stack, StackSide::outside, 1.0, kPmma, 1.0);
    const double passed = std::norm(in.t_s);
    const double expected = std::norm(in.r_s) + passed * passed / (1.0 - std::norm(out.r_s));
    expect_returned_or_absorbed(part, optics, expected);
    const ConeResult sampled = MonteCarlo(part).trace(optics, {}, {0.5}, rays(1U << 14), {}).cones[0];
    EXPECT_NEAR(sampled.rre, expected, 4.0 * sampled.spread + 1e-6);
    EXPECT_NEAR(sampled.ledger.total(), 1.0, 1e-9);
  }
}

// Light hits both facets at 45 degrees. Light that a facet transmits does not hit another facet.
TEST(Layers, CoatedFacetsOfAPrism) {
  const Part part = build_part(single(RtpElement{0.5, 0.5, 90.0}, 0.5));
  const LayerStack dielectric{{{2.1, 0.12}, {1.3777, 0.2}}};
  for (const double behind : {1.0, 1.333})
    for (const LayerStack& stack : {dielectric, thin_aluminium(), kProtected}) {
      Optics optics = pmma();
      optics.lossless_entrance = true;
      optics.back_index = behind;
      optics.facet_layers = stack;
      const FresnelCoefficients f = fresnel_layers(stack, StackSide::body, kPmma, behind, std::sqrt(0.5));
      const double r_s = std::norm(f.r_s);
      const double r_p = std::norm(f.r_p);
      const auto [a_s, a_p] = absorbed(f);
      const double returned = 0.5 * (r_s * r_s + r_p * r_p);
      const double taken = 0.5 * (a_s * (1.0 + r_s) + a_p * (1.0 + r_p));
      const Ledger exact = BeamTracer(part).trace(optics, {}, {0.5}, {}).ledgers[0];
      EXPECT_NEAR(exact[Account::retroreflected], returned, 1e-9);
      EXPECT_NEAR(exact[Account::absorbed], taken, 1e-9);
      EXPECT_NEAR(exact[Account::transmitted], 1.0 - returned - taken, 1e-9);
      const ConeResult sampled = MonteCarlo(part).trace(optics, {}, {0.5}, rays(1U << 14), {}).cones[0];
      // A thick film transmits so little light that possibly none of the traced rays is transmitted. The tolerance
      // includes this light.
      const double passed = 0.5 * (std::norm(f.t_s) + std::norm(f.t_p));
      const double unseen = passed < 1e-5 ? 2.0 * passed : 0.0;
      EXPECT_NEAR(sampled.rre, returned, 4.0 * sampled.spread + 1e-6 + unseen);
    }
}

// Compares the light that the entrance face reflects externally with the reflectance for the polarisation of the light.
TEST(Layers, FrontReflection) {
  const Part part = build_part(infinite(HexagonalCube{1.0}, Arrangement::honeycomb, 1.0));
  for (const double degrees : {0.0, 30.0, 60.0, 80.0})
    for (const double q : {-1.0, 0.0, 1.0}) {
      Optics optics = pmma();
      optics.entrance_layers = thin_aluminium();
      Illumination light = from(degrees, 90.0);  // +x is perpendicular to the plane of incidence, so that q > 0 is s
      light.stokes = {1.0, q, 0.0, 0.0};
      const FresnelCoefficients f =
          fresnel_layers(optics.entrance_layers, StackSide::outside, 1.0, kPmma, std::cos(light.incidence.rad()));
      const double expected = 0.5 * ((1.0 + q) * std::norm(f.r_s) + (1.0 - q) * std::norm(f.r_p));
      const LightSetup setup(part, Vec2::Zero(), optics, light, {0.5});
      EXPECT_NEAR(setup.entry.reflected.i, expected, 1e-14) << degrees << ' ' << q;
      EXPECT_NEAR(setup.entry.reflected.i + setup.entry.light.power() + setup.entry.absorbed, 1.0, 1e-14);
    }
}

// The accounts of every ledger add up to 1.
TEST(Layers, LedgersClose) {
  const std::vector<PartSpec> parts = {infinite(RtpElement{0.5, 0.5, 90.0}, Arrangement::offset, 0.5),
                                       single(HexagonalCube{1.0}, 0.4),
                                       finite(TriangularCube{1.0}, Arrangement::triangular, 2.0, 1.6, 0.2)};
  const LayerStack absorbing{{{std::complex<double>(1.7, 0.05), 0.4}}};
  for (const PartSpec& spec : parts) {
    const Part part = build_part(spec);
    for (const LayerStack& facets : {anti_reflection(), thin_aluminium(), kProtected, absorbing})
      for (const LayerStack& entrance : {anti_reflection(), absorbing})
        for (const double degrees : {0.0, 25.0, 70.0}) {
          Optics optics = pmma();
          optics.absorption_per_mm = 0.05;
          optics.facet_layers = facets;
          optics.entrance_layers = entrance;
          BeamPolicy policy;
          policy.cutoff = 1e-4;
          const Ledger exact = BeamTracer(part).trace(optics, from(degrees, 20.0), {0.5}, policy).ledgers[0];
          EXPECT_NEAR(exact.total(), 1.0, 1e-9);
          const MonteCarloResult traced =
              MonteCarlo(part).trace(optics, from(degrees, 20.0), {0.5}, rays(1U << 11), {});
          EXPECT_NEAR(traced.cones[0].ledger.total(), 1.0, 1e-9);
          EXPECT_EQ(traced.misses, 0U);
          for (const double power : exact.power) EXPECT_GE(power, 0.0);
        }
  }
}

// Layers with a negligible thickness have no effect in any engine.
TEST(Layers, NoThicknessIsABareFace) {
  const Part part = build_part(infinite(RtpElement{0.5, 0.5, 90.0}, Arrangement::offset, 0.5));
  Optics empty = pmma();
  empty.facet_layers = {{{std::complex<double>(1.13, 6.85), 0.0}}};
  empty.entrance_layers = {{{2.3, 0.0}}};
  BeamPolicy policy;
  policy.cutoff = 1e-5;
  const Ledger bare = BeamTracer(part).trace(pmma(), from(20.0, 35.0), {0.5}, policy).ledgers[0];
  const Ledger thin = BeamTracer(part).trace(empty, from(20.0, 35.0), {0.5}, policy).ledgers[0];
  for (std::size_t a = 0; a < kAccountCount; ++a) EXPECT_NEAR(thin.power[a], bare.power[a], 1e-12);
}

}  // namespace
}  // namespace retrace::testing::layers_test
