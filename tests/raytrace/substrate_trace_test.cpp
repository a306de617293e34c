// Tests of light in parts whose elements are on substrates: conservation of power, agreement of the engines, and closed
// forms for planes, rotated cubes and pins.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "raytrace/exact/beam_tracer.h"
#include "tests/support/designs.h"
#include "tests/support/engines.h"
#include "tests/support/reference_tracer.h"

namespace retrace::testing::substrate_trace_test {
namespace {

using namespace geometry;
using namespace raytrace;

constexpr double kDeg = std::numbers::pi / 180.0;

Substrate formula(const std::string& text, ElementAxes element_axes = ElementAxes::normal) {
  return {formula_substrate(text), element_axes};
}

PartSpec on(const Substrate& substrate, PartSpec spec) {
  spec.substrate = substrate;
  return spec;
}

const RtpElement kPrism{0.5, 0.5, 90.0};

using Case = NamedPart;

std::vector<Case> cases() {
  PartSpec prisms = finite(kPrism, Arrangement::offset, 2.5, 2.5, 1.5);
  PartSpec gaps = finite(kPrism, Arrangement::aligned, 2.6, 2.7, 1.5);
  gaps.array.x_gap_mm = 0.05;
  gaps.array.partial_elements = PartialElements::omit;
  PartSpec cubes = finite(HexagonalCube{1.0}, Arrangement::honeycomb, 3.1, 2.9, 2.0);
  PartSpec pins = cubes;
  pins.is_pin_bundle = true;
  pins.edges.root_radius_mm = 0.03;
  PartSpec triangles = finite(TriangularCube{1.0}, Arrangement::triangular, 2.4, 2.3, 2.0);
  triangles.random_tilts = {3.0, 5};
  return {{"prisms on an incline", on({PlaneSubstrate{20.0, 40.0}, ElementAxes::normal}, prisms)},
          {"prisms in steps", on({PlaneSubstrate{20.0, 0.0}, ElementAxes::parallel}, gaps)},
          {"prisms on a cylinder", on({CylinderSubstrate{4.0, true}, ElementAxes::normal}, gaps)},
          {"prisms in a hollow", on({SphereSubstrate{-5.0}, ElementAxes::normal}, prisms)},
          {"cubes on a sphere", on({SphereSubstrate{6.0}, ElementAxes::normal}, cubes)},
          {"pins on an incline", on({PlaneSubstrate{15.0, 10.0}, ElementAxes::parallel}, pins)},
          {"pins on a formula", on(formula("0.1*x*y - 0.05*x^2", ElementAxes::parallel), pins)},
          {"triangles on a formula", on(formula("0.05*x^2 + 0.1*y - 0.02*y^3"), triangles)}};
}

class OnSubstrate : public ::testing::TestWithParam<std::size_t> {};

TEST_P(OnSubstrate, NothingIsLost) {
  const Case c = cases()[GetParam()];
  const Part part = build_part(c.spec);
  expect_nothing_lost(part, {0.0, 25.0, 70.0}, 2048, c.name);
}

TEST_P(OnSubstrate, EnginesAgree) {
  const Case c = cases()[GetParam()];
  const Part part = build_part(c.spec);
  expect_same_accounts(part, from(5.0, 30.0), 1e-4, 3e-3, c.name);
}

INSTANTIATE_TEST_SUITE_P(Cases, OnSubstrate, ::testing::Range(std::size_t{0}, cases().size()));

TEST(OnSubstrate, AgreesWithTheReference) {
  for (const std::size_t k : {2U, 5U}) {
    const Case c = cases()[k];
    const Part part = build_part(c.spec);
    expect_agrees_with_reference(part, from(10.0, 70.0), 1500, 1U << 16, c.name);
  }
}

std::vector<PartSpec> planar() {
  return {finite(kPrism, Arrangement::offset, 2.5, 2.5, 1.5),
          finite(HexagonalCube{1.0}, Arrangement::honeycomb, 3.1, 2.9, 2.0),
          finite(TriangularCube{1.0}, Arrangement::triangular, 2.4, 2.3, 2.0)};
}

// With the same seed, the rays through the planar array and through the array on the plane formula are the same.
TEST(PlaneAsFormula, SendsBackWhatThePlanarArrayDoes) {
  for (const PartSpec& plain : planar())
    for (const double t : {0.0, 7.0, 30.0}) {
      const auto traced = [&](const PartSpec& spec) {
        const Part part = build_part(spec);
        return MonteCarlo(part).trace(pmma(), from(t, 20.0), {0.5}, rays(1U << 14), {}).cones[0].ledger;
      };
      const Ledger expected = traced(plain);
      const Ledger found = traced(on(formula("0.3"), plain));
      for (std::size_t a = 0; a < kAccountCount; ++a) EXPECT_NEAR(found.power[a], expected.power[a], 1e-9);
    }
}

TEST(HugeCylinder, SendsBackWhatThePlanarArrayDoes) {
  for (const PartSpec& plain : planar()) {
    const auto exact = [&](const PartSpec& spec) {
      BeamPolicy policy;
      policy.cutoff = 1e-6;
      return BeamTracer(build_part(spec)).trace(pmma(), from(0.0, 20.0), {0.5}, policy).ledgers[0];
    };
    const Ledger expected = exact(plain);
    const Ledger found = exact(on({CylinderSubstrate{1e7, false}, ElementAxes::normal}, plain));
    const double slack = 1e-6 + expected[Account::truncated] + found[Account::truncated];
    EXPECT_NEAR(found[Account::retroreflected], expected[Account::retroreflected], slack);
  }
}

// A bundle consists of hexagonal pins with a cube corner at the end of each pin. Light along the axis of a pin stays
// above the hexagon of the pin, whatever the heights of its neighbours. All three reflections of a full cube are within
// the hexagon, and the walls are parallel to the light.
TEST(PinBundle, SendsBackLightAlongThePinsWhateverTheIncline) {
  PartSpec pins = finite(HexagonalCube{1.0}, Arrangement::honeycomb, 6.2, 5.3, 2.0);
  pins.is_pin_bundle = true;
  pins.array.partial_elements = PartialElements::omit;
  BeamPolicy policy;
  policy.cutoff = 1e-9;
  const double level =
      BeamTracer(build_part(pins)).trace(ideal(), from(0.0), {0.5}, policy).ledgers[0][Account::retroreflected];
  const double full =
      static_cast<double>(build_part(pins).elements_full) * area(aperture_outline(pins.element)) / (6.2 * 5.3);
  EXPECT_GT(level, full - 1e-9);
  for (const double incline : {5.0, 17.0, 30.0}) {
    const Part part = build_part(on({PlaneSubstrate{incline, 33.0}, ElementAxes::parallel}, pins));
    const Ledger ledger = BeamTracer(part).trace(ideal(), from(0.0), {0.5}, policy).ledgers[0];
    // Omitted pins are replaced by land (a flat surface without elements). The land remains horizontal if the bundle is
    // inclined, and reflects the same light.
    EXPECT_NEAR(ledger[Account::retroreflected], level, 1e-9) << incline;
  }
}

// For oblique light, walls shade more and more light as the incline grows. The RRE decreases continuously.
TEST(PinBundle, LosesLightContinuouslyAsTheInclineGrows) {
  PartSpec pins = finite(HexagonalCube{1.0}, Arrangement::honeycomb, 12.0, 12.0, 2.0);
  pins.is_pin_bundle = true;
  const auto rre = [&](double incline) {
    const PartSpec spec = on({PlaneSubstrate{incline, 0.0}, ElementAxes::parallel}, pins);
    const Part part = build_part(spec);
    return MonteCarlo(part).trace(pmma(), from(10.0, 0.0), {0.5}, rays(1U << 14), {}).cones[0].rre;
  };
  double before = rre(0.0);
  const double first = before;
  for (double incline = 1.0; incline <= 30.0; incline += 2.0) {
    const double here = rre(incline);
    EXPECT_LT(std::abs(here - before), 0.05) << incline;
    before = here;
  }
  EXPECT_LT(before, first - 0.05);
}

// Closed form of the effective aperture of triangular cubes (Eckhardt, Appl. Opt. 10, 1559 (1971)). For mirrors behind
// a lossless entrance face, the RRE is 2 - (4/3) / cos^2 t', where t' is the angle of incidence on the cubes inside the
// part. On an inclined substrate, light along the normal of the part meets the cubes at the angle of the inclination.
// The effect of border elements is proportional to the length of the border, so that it is eliminated with two sizes of
// the part.
TEST(InclinedArray, HasTheApertureOfCubesAtThatAngle) {
  const auto rre = [](double size_mm, double incline_deg) {
    const PartSpec spec = on({PlaneSubstrate{incline_deg, 90.0}, ElementAxes::normal},
                             finite(TriangularCube{1.0}, Arrangement::triangular, size_mm, size_mm, 1.0 + size_mm));
    const Part part = build_part(spec);
    return MonteCarlo(part).trace(ideal(), from(0.0), {0.01}, rays(1U << 16), {}).cones[0];
  };
  for (const double incline : {5.0, 12.0, 18.0}) {
    const ConeResult small = rre(30.0, incline);
    const ConeResult large = rre(60.0, incline);
    const double expected = 2.0 - 4.0 / 3.0 / std::pow(std::cos(incline * kDeg), 2);
    const double error = std::hypot(small.spread, 2.0 * large.spread);
    EXPECT_NEAR(2.0 * large.rre - small.rre, expected, 4.0 * error + 2e-3) << incline;
  }
}

// A cylinder with prisms across its axis is symmetric.
TEST(Cylinder, SendsBackAlikeFromBothSides) {
  const Part part = build_part(
      on({CylinderSubstrate{5.0, false}, ElementAxes::normal}, finite(kPrism, Arrangement::aligned, 3.0, 2.0, 1.5)));
  BeamPolicy policy;
  policy.cutoff = 1e-7;
  for (const double t : {4.0, 15.0}) {
    const double left = BeamTracer(part).trace(pmma(), from(-t), {0.5}, policy).ledgers[0][Account::retroreflected];
    const double right = BeamTracer(part).trace(pmma(), from(t), {0.5}, policy).ledgers[0][Account::retroreflected];
    EXPECT_NEAR(left, right, 1e-6) << t;
    EXPECT_GT(left, 1e-3);
  }
}

// Several patches at different heights form one continuous surface.
TEST(Placements, AtDifferentHeightsAreOneSurface) {
  const PartSpec spec =
      on({PlaneSubstrate{10.0, 20.0}, ElementAxes::normal}, finite(kPrism, Arrangement::aligned, 30.0, 30.0, 8.0));
  const Part part = build_part(spec);
  ASSERT_GT(part.placements.size(), 1U);
  const MonteCarloResult result = MonteCarlo(part).trace(pmma(), from(8.0, 20.0), {0.5}, rays(1U << 16), {});
  EXPECT_EQ(result.misses, 0U);
  EXPECT_NEAR(result.cones[0].ledger.total(), 1.0, 1e-9);
  // A smaller part consists of a single patch. Both parts have the same inner region, and the allowed difference covers
  // the effect of the different borders.
  PartSpec small = spec;
  small.array.x_length_mm = small.array.y_length_mm = 15.0;
  const Part one = build_part(small);
  ASSERT_EQ(one.placements.size(), 1U);
  const double of_one = MonteCarlo(one).trace(pmma(), from(8.0, 20.0), {0.5}, rays(1U << 16), {}).cones[0].rre;
  EXPECT_NEAR(result.cones[0].rre, of_one, 0.03);
}

}  // namespace
}  // namespace retrace::testing::substrate_trace_test
