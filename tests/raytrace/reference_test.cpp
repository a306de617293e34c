// The tracer against an independent engine that shares only the closed boundary with it.
#include "tests/support/reference_tracer.h"

#include <gtest/gtest.h>

#include "tests/support/designs.h"
#include "tests/support/statistics.h"

namespace retrace::testing {
namespace {

using namespace geometry;
using namespace raytrace;

struct Case {
  std::string name;
  PartSpec spec;
  double incidence_deg;
  double azimuth_deg;
  double index;
  double absorption_per_mm;
};

std::vector<Case> cases() {
  const RtpElement prism{0.5, 0.4, 90.0};
  PartSpec bricks = finite(prism, Arrangement::offset, 1.0, 0.8, 0.3);
  PartSpec spaced = finite(RtpElement{0.5, 0.5, 84.0}, Arrangement::checker, 1.4, 1.4, 0.3);
  spaced.x_gap_mm = spaced.y_gap_mm = 0.1;
  spaced.x_offset_mm = 0.1;
  PartSpec omitted = finite(HexagonalCube{1.0}, Arrangement::honeycomb, 1.9, 1.7, 0.3);
  omitted.partial_elements = PartialElements::omit;
  return {
      {"single prism across", single(prism, 0.3), 3.0, 0.0, 1.4917, 0.0},
      {"single prism askew", single(prism, 0.3), 33.0, 25.0, 1.4917, 0.1},
      {"single hexagon", single(HexagonalCube{1.0}, 0.4), 24.0, 70.0, 1.4917, 0.0},
      {"single triangle", single(TriangularCube{1.0}, 0.4), 18.0, 200.0, 1.585, 0.0},
      {"bricks along the roof", bricks, 36.0, 270.0, 1.4917, 0.0},
      {"bricks askew, low index", bricks, 50.0, 110.0, 1.3, 0.0},
      {"spaced checker", spaced, 12.0, 40.0, 1.4917, 0.05},
      {"honeycomb, partial omitted", omitted, 28.0, 15.0, 1.4917, 0.0},
      {"triangular, cut", finite(TriangularCube{1.0}, Arrangement::triangular, 2.0, 1.6, 0.2), 40.0, 300.0, 1.8, 0.0}};
}

class AgainstReference : public ::testing::TestWithParam<std::size_t> {};

TEST_P(AgainstReference, EveryAccountAgrees) {
  const Case c = cases()[GetParam()];
  const Part part = build_part(c.spec);
  Optics optics;
  optics.index = c.index;
  optics.absorption_per_mm = c.absorption_per_mm;
  // A wide cone puts power on both sides of its edge.
  const double cone_deg = 8.0;
  const ReferenceResult reference =
      reference_trace(part, optics, from(c.incidence_deg, c.azimuth_deg), cone_deg, 40000, 7);
  const MonteCarloResult traced =
      MonteCarlo(part).trace(optics, from(c.incidence_deg, c.azimuth_deg), {cone_deg}, rays(1U << 20), {});
  const Ledger& ledger = traced.cones[0].ledger;
  // The program's own error is far below the reference's.
  ASSERT_LT(traced.cones[0].std_error, 5e-4);
  const double z = student_bound(cases().size() * kAccountCount);
  const double slack = reference.mean[Account::truncated] + 2e-4;
  EXPECT_LT(reference.mean[Account::truncated], 2e-3) << c.name;
  for (std::size_t a = 0; a < kAccountCount; ++a) {
    if (a == static_cast<std::size_t>(Account::truncated)) continue;
    EXPECT_NEAR(ledger.power[a], reference.mean.power[a], z * reference.std_error[a] + slack)
        << c.name << ": " << kAccountNames[a];
  }
}

INSTANTIATE_TEST_SUITE_P(Cases, AgainstReference, ::testing::Range(std::size_t{0}, cases().size()));

}  // namespace
}  // namespace retrace::testing
