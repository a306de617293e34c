// Tests of facets with errors of angle: directions of the returned light, and conservation of power if the rims (upper
// edges of the outlines) of neighbouring cells have different heights.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "raytrace/exact/beam_tracer.h"
#include "tests/support/designs.h"
#include "tests/support/engines.h"
#include "tests/support/reference_tracer.h"
#include "tests/support/sample_size.h"

namespace retrace::testing::angle_errors_test {
namespace {

using namespace geometry;
using namespace raytrace;

constexpr double kArcmin = std::numbers::pi / 180.0 / 60.0;

PartSpec with(PartSpec spec, const AngleErrors& errors) {
  spec.angle_errors = errors;
  return spec;
}

using Case = NamedPart;

/// Returns parts with errors so large that the rims of their cells are well above and below z = 0. The last part is an
/// array that consists of many patches of cells.
std::vector<Case> cases() {
  const RtpElement prism{0.5, 0.5, 90.0};
  PartSpec spaced = finite(prism, Arrangement::checker, 2.2, 2.0, 0.3);
  spaced.array.x_gap_mm = spaced.array.y_gap_mm = 0.1;
  spaced.array.x_offset_mm = 0.1;
  PartSpec omitted = finite(HexagonalCube{1.0}, Arrangement::honeycomb, 3.1, 2.7, 0.3);
  omitted.array.partial_elements = PartialElements::omit;
  const AngleErrors twist{{}, {-300.0, 300.0, 0.0}};
  const AngleErrors unlike{{60.0, -90.0, 20.0}, {50.0, 0.0, -70.0}};
  const AngleErrors closed{{-80.0, -80.0, -80.0}, {}};
  return {{"single prism", with(single(prism, 0.3), twist)},
          {"single cube", with(single(HexagonalCube{1.0}, 0.3), closed)},
          {"single triangle", with(single(TriangularCube{1.0}, 0.3), unlike)},
          {"prisms", with(finite(prism, Arrangement::aligned, 1.6, 1.5, 0.3), twist)},
          {"bricks", with(finite(prism, Arrangement::offset, 1.5, 1.5, 0.3), twist)},
          {"spaced checker", with(spaced, twist)},
          {"honeycomb", with(finite(HexagonalCube{1.0}, Arrangement::honeycomb, 2.1, 1.9, 0.3), unlike)},
          {"honeycomb, partial omitted", with(omitted, closed)},
          {"triangular", with(finite(TriangularCube{1.0}, Arrangement::triangular, 2.1, 1.9, 0.3), unlike)},
          {"infinite prisms", with(infinite(prism, Arrangement::aligned, 0.3), twist)},
          {"infinite checker", with(infinite(prism, Arrangement::checker, 0.3), twist)},
          {"infinite honeycomb", with(infinite(HexagonalCube{1.0}, Arrangement::honeycomb, 0.3), unlike)},
          {"infinite triangular", with(infinite(TriangularCube{1.0}, Arrangement::triangular, 0.3), unlike)},
          {"bricks in pieces", with(finite(prism, Arrangement::offset, 40.0, 40.0, 0.3), twist)}};
}

class WithAngleErrors : public ::testing::TestWithParam<std::size_t> {};

TEST_P(WithAngleErrors, NothingIsLost) {
  const Case c = cases()[GetParam()];
  const Part part = build_part(c.spec);
  ASSERT_GT(part.top_mm, 1e-3);
  expect_nothing_lost(part, {0.0, 20.0, 60.0, 85.0}, 1024, c.name);
}

INSTANTIATE_TEST_SUITE_P(Cases, WithAngleErrors, ::testing::Range(std::size_t{0}, cases().size()));

class EnginesWithAngleErrors : public ::testing::TestWithParam<std::size_t> {};

TEST_P(EnginesWithAngleErrors, Agree) {
  const Case c = cases()[GetParam()];
  const Part part = build_part(c.spec);
  for (const double azimuth_deg : {0.0, 40.0}) expect_same_accounts(part, from(30.0, azimuth_deg), 1e-6, 2e-3, c.name);
}

INSTANTIATE_TEST_SUITE_P(Cases, EnginesWithAngleErrors, ::testing::Range(std::size_t{0}, cases().size() - 1));

TEST(AngleErrors, AgreeWithTheReference) {
  const std::vector<Case> all = cases();
  for (const std::size_t k : {std::size_t{4}, std::size_t{8}}) {
    const Part part = build_part(all[k].spec);
    expect_agrees_with_reference(part, from(20.0, 70.0), test::sample_size(4000U, 8000U), 1U << 16, all[k].name);
  }
}

// Parts have random facet tilts. The exact engine and the Monte Carlo engine agree, and less light returns into smaller
// cones.
TEST(RandomTilts, EnginesAgree) {
  for (PartSpec spec : {finite(RtpElement{0.5, 0.4, 90.0}, Arrangement::offset, 2.1, 1.7, 0.4),
                        finite(HexagonalCube{0.7}, Arrangement::honeycomb, 2.1, 1.7, 0.4)}) {
    spec.random_tilts = {3.0, 5};
    const Part part = build_part(spec);
    BeamPolicy policy;
    policy.truncated_goal = 1e-4;
    const std::vector<double> cones_deg = {0.05, 0.2, 2.0};
    const BeamResult exact = BeamTracer(part).trace(pmma(), from(2.0, 10.0), cones_deg, policy);
    const MonteCarloResult sampled = MonteCarlo(part).trace(pmma(), from(2.0, 10.0), cones_deg, rays(1U << 17), {});
    for (std::size_t k = 0; k < cones_deg.size(); ++k) {
      const double rre = exact.ledgers[k][Account::retroreflected];
      EXPECT_NEAR(rre, sampled.cones[k].rre, 4.0 * sampled.cones[k].spread + 2e-4);
      EXPECT_NEAR(exact.ledgers[k].total(), 1.0, 1e-9);
      if (k > 0) {
        EXPECT_GT(rre, exact.ledgers[k - 1][Account::retroreflected]);
      }
    }
  }
}

// A cube corner with equal dihedral errors returns six beams. Each beam deviates from the direction to the source by
// 4 sqrt(2/3) n times the error (Chandler, J. Opt. Soc. Am. 50, 1203 (1960)).
TEST(AngleErrors, EqualDihedralErrorsSendSixBeamsBack) {
  for (const double arcmin : {0.5, -0.5}) {
    const Part part = build_part(with(single(HexagonalCube{kCubeAperture}, 1.0), {{arcmin, arcmin, arcmin}, {}}));
    std::vector<double> azimuths_deg;
    const BeamObserver note = [&](const ReturnedBeam& beam) {
      if (beam.stokes.i < 1e-2 || beam.depth != 4) return;
      const double deviation = std::asin(beam.direction.head<2>().norm());
      EXPECT_NEAR(deviation, 4.0 * std::sqrt(2.0 / 3.0) * kPmma * std::abs(arcmin) * kArcmin, 1e-3 * deviation);
      azimuths_deg.push_back(std::atan2(beam.direction.y(), beam.direction.x()) * 180.0 / std::numbers::pi);
    };
    BeamTracer(part).trace(ideal(), from(0.0), {0.5}, {}, nullptr, note);
    std::sort(azimuths_deg.begin(), azimuths_deg.end());
    const auto alike = [](double a, double b) { return b - a < 0.01; };
    azimuths_deg.erase(std::unique(azimuths_deg.begin(), azimuths_deg.end(), alike), azimuths_deg.end());
    ASSERT_EQ(azimuths_deg.size(), 6U);
    for (std::size_t k = 1; k < 6; ++k) EXPECT_NEAR(azimuths_deg[k] - azimuths_deg[k - 1], 60.0, 0.1);
  }
}

// A cube corner with one dihedral error returns two beams. They deviate in opposite directions, by half the angle
// that three equal errors cause.
TEST(AngleErrors, OneDihedralErrorSendsTwoBeamsBack) {
  for (const std::size_t edge : {0U, 1U, 2U}) {
    AngleErrors errors;
    errors.dihedral_error_arcmin[edge] = 0.5;
    double power[2] = {0.0, 0.0};
    Vec2 spot[2];
    const BeamObserver note = [&](const ReturnedBeam& beam) {
      if (beam.depth != 4) return;
      const Vec2 at = beam.direction.head<2>();
      const std::size_t k = power[0] > 0.0 && (at - spot[0]).norm() > 1e-6 ? 1 : 0;
      spot[k] = at;
      power[k] += beam.stokes.i;
    };
    const Part part = build_part(with(single(HexagonalCube{kCubeAperture}, 1.0), errors));
    BeamTracer(part).trace(ideal(), from(0.0), {0.5}, {}, nullptr, note);
    const double expected = 2.0 * std::sqrt(2.0 / 3.0) * kPmma * 0.5 * kArcmin;
    for (std::size_t k = 0; k < 2; ++k) {
      EXPECT_NEAR(spot[k].norm(), expected, 1e-3 * expected);
      EXPECT_NEAR(power[k], 0.5, 1e-3);
    }
    EXPECT_NEAR((spot[0] + spot[1]).norm(), 0.0, 1e-3 * expected);
  }
}

// Two reflections rotate light by twice the angle between the facets. In air, the deviation is therefore 2 n times
// the error of the apex angle.
TEST(AngleErrors, ApexErrorSplitsTheReturnOfAPrism) {
  const double arcmin = 3.0;
  const Part part = build_part(with(single(RtpElement{1.0, 1.0, 90.0}, 1.0), {{}, {2.0, 1.0, 0.0}}));
  std::vector<double> deviations;
  const BeamObserver note = [&](const ReturnedBeam& beam) {
    if (beam.stokes.i > 1e-2 && beam.depth == 3) deviations.push_back(std::asin(beam.direction.x()));
  };
  BeamTracer(part).trace(ideal(), from(0.0), {0.5}, {}, nullptr, note);
  std::sort(deviations.begin(), deviations.end());
  ASSERT_EQ(deviations.size(), 2U);
  EXPECT_NEAR(deviations[0], -2.0 * kPmma * arcmin * kArcmin, 1e-8);
  EXPECT_NEAR(deviations[1], 2.0 * kPmma * arcmin * kArcmin, 1e-8);
}

}  // namespace
}  // namespace retrace::testing::angle_errors_test
