// Tests of the tracer against an independent engine. Both engines share only the closed boundary of the part.
#include "tests/support/reference_tracer.h"

#include <gtest/gtest.h>

#include <cmath>

#include "materials/fresnel.h"
#include "raytrace/exact/beam_tracer.h"
#include "tests/support/designs.h"
#include "tests/support/engines.h"
#include "tests/support/sample_size.h"

namespace retrace::testing::reference_test {
namespace {

using namespace geometry;
using namespace raytrace;

using Case = TraceCase;

Optics body(double index, double absorption_per_mm = 0.0, double back_index = 1.0) {
  Optics optics;
  optics.index = index;
  optics.absorption_per_mm = absorption_per_mm;
  optics.back_index = back_index;
  return optics;
}

Optics with_black_walls(Optics optics) {
  optics.absorbing_walls = true;
  return optics;
}

Optics with_layers(Optics optics, const materials::LayerStack& facet_layers,
                   const materials::LayerStack& entrance_layers = {}) {
  optics.facet_layers = facet_layers;
  optics.entrance_layers = entrance_layers;
  return optics;
}

std::vector<Case> cases() {
  const RtpElement prism{0.5, 0.4, 90.0};
  PartSpec bricks = finite(prism, Arrangement::offset, 1.0, 0.8, 0.3);
  PartSpec spaced = finite(RtpElement{0.5, 0.5, 84.0}, Arrangement::checker, 1.4, 1.4, 0.3);
  spaced.array.x_gap_mm = spaced.array.y_gap_mm = 0.1;
  spaced.array.x_offset_mm = 0.1;
  PartSpec omitted = finite(HexagonalCube{1.0}, Arrangement::honeycomb, 1.9, 1.7, 0.3);
  omitted.array.partial_elements = PartialElements::omit;
  return {
      {"single prism across", single(prism, 0.3), 3.0, 0.0, body(1.4917)},
      {"single prism askew", single(prism, 0.3), 33.0, 25.0, body(1.4917, 0.1)},
      {"single hexagon", single(HexagonalCube{1.0}, 0.4), 24.0, 70.0, body(1.4917)},
      {"single triangle", single(TriangularCube{1.0}, 0.4), 18.0, 200.0, body(1.585)},
      {"bricks along the roof", bricks, 36.0, 270.0, body(1.4917)},
      {"bricks askew, low index", bricks, 50.0, 110.0, body(1.3)},
      {"spaced checker", spaced, 12.0, 40.0, body(1.4917, 0.05)},
      {"honeycomb, partial omitted", omitted, 28.0, 15.0, body(1.4917)},
      {"triangular, cut", finite(TriangularCube{1.0}, Arrangement::triangular, 2.0, 1.6, 0.2), 40.0, 300.0, body(1.8)},
      {"hexagon in water", single(HexagonalCube{1.0}, 0.4), 14.0, 70.0, body(1.4917, 0.0, 1.333)},
      {"bricks in a denser glue", bricks, 20.0, 35.0, body(1.4917, 0.0, 1.6)},
      {"spaced checker, black walls", spaced, 12.0, 40.0, with_black_walls(body(1.4917, 0.05))},
      {"honeycomb, black walls", omitted, 28.0, 15.0, with_black_walls(body(1.4917))},
      {"bricks askew, black walls", bricks, 50.0, 110.0, with_black_walls(body(1.3))},
      {"aluminised hexagon in glue", single(HexagonalCube{1.0}, 0.4), 35.0, 70.0,
       with_layers(body(1.4917, 0.0, 1.5), opaque({1.1, 6.9}))},
      {"poor metal on bricks", bricks, 30.0, 35.0, with_layers(body(1.4917, 0.1), opaque({2.5, 1.2}))},
      {"thin aluminium on bricks", bricks, 30.0, 35.0, with_layers(body(1.4917, 0.1), thin_aluminium())},
      {"coated bricks in water", bricks, 20.0, 70.0,
       with_layers(body(1.4917, 0.0, 1.333), anti_reflection(), anti_reflection())},
      {"silver between layers on a hexagon", single(HexagonalCube{1.0}, 0.4), 25.0, 15.0,
       with_layers(body(1.585), {{{1.9, 0.2}, {{0.14, 3.5}, kInfinity}, {1.5, 2.0}}}, thin_aluminium())}};
}

class AgainstReference : public ::testing::TestWithParam<std::size_t> {};

TEST_P(AgainstReference, EveryAccountAgrees) {
  const Case c = cases()[GetParam()];
  const Part part = build_part(c.spec);
  // The cone is wide, so that there is light inside and outside of it.
  const double cone_deg = 8.0;
  const ReferenceResult reference = reference_trace(part, c.optics, from(c.incidence_deg, c.azimuth_deg), cone_deg,
                                                    test::sample_size<std::uint64_t>(5000, 40000), 7);
  const MonteCarloResult traced =
      MonteCarlo(part).trace(c.optics, from(c.incidence_deg, c.azimuth_deg), {cone_deg}, rays(1U << 16), {});
  const Ledger& ledger = traced.cones[0].ledger;
  // The error of the tracer is much smaller than the error of the reference.
  ASSERT_LT(traced.cones[0].std_error, 5e-4);
  EXPECT_LT(reference.mean[Account::truncated], 2e-3) << c.name;
  expect_accounts_of(reference, ledger, cases().size() * kAccountCount, 2e-4, c.name);
}

// In water, the facets of a prism at 45 degrees reflect little light at normal incidence. The returned power is (R_s^2
// + R_p^2) / 2 in both engines.
TEST(BackIndex, PrismInWater) {
  const Part part = build_part(single(RtpElement{0.5, 0.5, 90.0}, 0.5));
  Optics optics = pmma();
  optics.lossless_entrance = true;
  optics.back_index = 1.333;
  const materials::FresnelCoefficients f = materials::fresnel(kPmma / 1.333, std::sqrt(0.5));
  const double expected = 0.5 * (std::pow(std::norm(f.r_s), 2) + std::pow(std::norm(f.r_p), 2));
  EXPECT_NEAR(BeamTracer(part).trace(optics, {}, {0.5}, {}).ledgers[0][Account::retroreflected], expected, 1e-9);
  const ConeResult sampled = MonteCarlo(part).trace(optics, {}, {0.5}, rays(1U << 14), {}).cones[0];
  EXPECT_NEAR(sampled.rre, expected, 4.0 * sampled.spread + 1e-6);
}

// With metal facets, light is reflected twice for any medium behind the part. The remaining light is absorbed.
TEST(FacetCoating, AluminisedPrism) {
  const Part part = build_part(single(RtpElement{0.5, 0.5, 90.0}, 0.5));
  Optics optics = pmma();
  optics.lossless_entrance = true;
  optics.back_index = 1.333;
  const std::complex<double> n2(1.13, 6.85);
  optics.facet_layers = opaque(n2);
  const double n1 = kPmma;
  const std::complex<double> cos2 = std::sqrt(1.0 - 0.5 * n1 * n1 / (n2 * n2));
  const std::complex<double> r_s = (n1 * std::sqrt(0.5) - n2 * cos2) / (n1 * std::sqrt(0.5) + n2 * cos2);
  const std::complex<double> r_p = (n2 * std::sqrt(0.5) - n1 * cos2) / (n2 * std::sqrt(0.5) + n1 * cos2);
  const double expected = 0.5 * (std::pow(std::norm(r_s), 2) + std::pow(std::norm(r_p), 2));
  const Ledger exact = BeamTracer(part).trace(optics, {}, {0.5}, {}).ledgers[0];
  EXPECT_NEAR(exact[Account::retroreflected], expected, 1e-9);
  EXPECT_NEAR(exact[Account::absorbed], 1.0 - expected, 1e-9);
  const ConeResult sampled = MonteCarlo(part).trace(optics, {}, {0.5}, rays(1U << 14), {}).cones[0];
  EXPECT_NEAR(sampled.rre, expected, 4.0 * sampled.spread + 1e-6);
}

INSTANTIATE_TEST_SUITE_P(Cases, AgainstReference, ::testing::Range(std::size_t{0}, cases().size()));

}  // namespace
}  // namespace retrace::testing::reference_test
