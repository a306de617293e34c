// Tests of light that falls along the axes of an array. Facets reflect such light into horizontal directions. RRE must
// be a continuous function of the azimuth at the axes.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "geometry/direction.h"
#include "raytrace/exact/flat_polygon.h"
#include "raytrace/exact/stochastic_beams.h"
#include "raytrace/observers/photometric_geometry.h"
#include "tests/support/designs.h"
#include "tests/support/sample_size.h"

namespace retrace::testing::level_beams_test {
namespace {

using namespace geometry;
using namespace raytrace;

/// Azimuths along the axes of arrays and between them. The usual azimuths leave out those that a mirror plane of most
/// arrays makes equivalent.
const std::vector<double> kAzimuths_deg = test::is_long_run()
                                              ? std::vector<double>{0.0, 30.0, 45.0, 60.0, 90.0, 180.0, 270.0}
                                              : std::vector<double>{0.0, 30.0, 45.0, 90.0, 270.0};
/// Small differences from an azimuth. A difference of 3e-13 is the rounding error of a unit conversion.
const std::vector<double> kNear_deg =
    test::is_long_run() ? std::vector<double>{-1e-9, -1e-11, 0.0, 3e-13, 1e-9} : std::vector<double>{-1e-9, 0.0, 3e-13};
constexpr double kContinuous = 1e-6;

struct Case {
  std::string name;
  PartSpec spec;
  double incidence_deg = 30.0;
  double index = 1.5;
};

/// Returns small finite parts and infinite parts, with all kinds of elements.
std::vector<Case> cases() {
  const RtpElement prism{1.0, 0.5, 90.0}, square{1.0, 1.0, 90.0};
  PartSpec odd_rows = finite(RtpElement{1.0, 2.0, 90.0}, Arrangement::offset, 2.5, 7.0, 1.0);
  odd_rows.array.shifted_rows = RowParity::odd;
  PartSpec with_gaps = finite(RtpElement{0.5, 1.0, 90.0}, Arrangement::offset, 1.25, 2.0, 2.0);
  with_gaps.array.y_gap_mm = 0.1;
  return {{"offset prisms", finite(prism, Arrangement::offset, 1.0, 1.5, 2.0)},
          {"offset prisms in odd rows", odd_rows, 40.0, 1.59},
          {"offset prisms with gaps", with_gaps, 30.0, 1.4917},
          {"aligned prisms", finite(square, Arrangement::aligned, 2.0, 2.0, 1.0), 50.0},
          {"checker of prisms", finite(square, Arrangement::checker, 2.0, 2.0, 1.0), 50.0},
          {"one prism", single(square, 1.0)},
          {"one cube corner", single(HexagonalCube{1.0}, 1.0), 10.0},
          {"full cubes", finite(HexagonalCube{1.0}, Arrangement::honeycomb, 1.5, 1.0, 1.0), 10.0},
          {"triangular cubes", finite(TriangularCube{1.0}, Arrangement::triangular, 1.0, 1.5, 1.0), 10.0},
          {"endless offset prisms", infinite(prism, Arrangement::offset, 1.0)},
          {"endless checker", infinite(square, Arrangement::checker, 1.0), 40.0},
          {"endless full cubes", infinite(HexagonalCube{1.0}, Arrangement::honeycomb, 1.0), 10.0},
          {"endless triangular cubes", infinite(TriangularCube{1.0}, Arrangement::triangular, 1.0), 10.0}};
}

Optics optics_of(const Case& c) {
  Optics optics = pmma();
  optics.index = c.index;
  return optics;
}

class LevelBeams : public ::testing::TestWithParam<std::size_t> {};

// In each direction RRE is between R and R + T, where R is the retroreflected power and T is the truncated power. The
// intervals from R to R + T of neighbouring directions must have a common point.
TEST_P(LevelBeams, BoundsOfBeamsMeetNextToAxes) {
  const Case c = cases()[GetParam()];
  const Part part = build_part(c.spec);
  const bool is_prism = std::holds_alternative<RtpElement>(c.spec.element);
  BeamPolicy policy;
  const BeamTracer tracer(part, part.period_mm ? BeamTracer::Elements::instanced : BeamTracer::Elements::individual);
  for (const double azimuth_deg : kAzimuths_deg) {
    double lower = 0.0, upper = 1.0;
    // Cube corners and infinite parts split light into many more beams, especially at azimuths that are not along an
    // axis. The limit of the truncated power is therefore higher for these parts.
    policy.truncated_goal = is_prism && !part.period_mm                ? 0.5 * kContinuous
                            : std::remainder(azimuth_deg, 90.0) == 0.0 ? test::sample_size(5e-4, 1e-4)
                                                                       : 1e-3;
    for (const double by_deg : kNear_deg) {
      const Illumination light = from(c.incidence_deg, azimuth_deg + by_deg);
      const Ledger ledger = tracer.trace(optics_of(c), light, {0.5}, policy).ledgers[0];
      ASSERT_LE(ledger[Account::truncated], 1.001 * policy.truncated_goal) << c.name << " at " << azimuth_deg;
      lower = std::max(lower, ledger[Account::retroreflected]);
      upper = std::min(upper, ledger[Account::retroreflected] + ledger[Account::truncated]);
    }
    EXPECT_LE(lower, upper + 0.5 * kContinuous) << c.name << " at " << azimuth_deg;
  }
}

// With the same random numbers, a ray in a slightly different direction takes another path only if it grazes an edge.
TEST_P(LevelBeams, RaysAreContinuousNextToAxes) {
  const Case c = cases()[GetParam()];
  const Part part = build_part(c.spec);
  std::vector<MonteCarlo::Engine> engines = {MonteCarlo::Engine::embree};
  if (MonteCarlo::cell_supports(part)) engines.push_back(MonteCarlo::Engine::cell);
  for (const MonteCarlo::Engine engine : engines) {
    const MonteCarlo tracer(part, engine);
    for (const double azimuth_deg : kAzimuths_deg) {
      const auto rre = [&](double by_deg) {
        return tracer.trace(optics_of(c), from(c.incidence_deg, azimuth_deg + by_deg), {0.5}, rays(2048), {})
            .cones[0]
            .rre;
      };
      const double there = rre(0.0);
      for (const double by_deg : {-1e-9, -3e-13, 1e-9})
        EXPECT_NEAR(rre(by_deg), there, kContinuous) << c.name << " at " << azimuth_deg << " by " << by_deg;
    }
  }
}

// Fragments of a beam along an axis are rectangles except for rounding errors. The union of two adjacent rectangles is
// convex only if the two sides that touch are equally long.
TEST(LevelBeams, OnlyPiecesWithAConvexUnionAreJoined) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> noise(-4e-16, 4e-16);
  for (int k = 0; k < 2000; ++k) {
    const auto rectangle = [&](double left, double right, double bottom, double top) {
      FlatPolygon polygon;
      for (const Vec2& p : {Vec2(left, bottom), Vec2(right, bottom), Vec2(right, top), Vec2(left, top)})
        polygon.emplace_back(p.x() + noise(random), p.y() + noise(random));
      return polygon;
    };
    FlatPolygons side_by_side = {rectangle(0.0, 1.0, -0.25, 0.0), rectangle(0.0, 1.0, 0.0, 0.3)};
    join_convex(side_by_side, 1e-13);
    ASSERT_EQ(side_by_side.size(), 1U);
    EXPECT_NEAR(area(side_by_side[0]), 0.55, 1e-12);
    FlatPolygons corner = {rectangle(0.0, 1.0, -0.25, 0.0), rectangle(0.5, 1.0, 0.0, 0.3)};
    join_convex(corner, 1e-13);
    ASSERT_EQ(corner.size(), 2U);
  }
}

INSTANTIATE_TEST_SUITE_P(All, LevelBeams, ::testing::Range<std::size_t>(0, cases().size()));

// A direction along a coordinate axis has components of exactly 0 along the two other axes. Rounding errors therefore
// do not break the mirror symmetry of a part.
TEST(LevelBeams, DirectionsAlongAxesHaveNoComponentAcross) {
  for (const double incidence_deg : {0.0, 17.0, 30.0, 89.0}) {
    EXPECT_EQ(direction_to_source(from(incidence_deg, 90.0)).x(), 0.0);
    EXPECT_EQ(direction_to_source(from(incidence_deg, -90.0)).x(), 0.0);
    EXPECT_EQ(direction_to_source(from(incidence_deg, 180.0)).y(), 0.0);
    EXPECT_EQ(direction_to_source(from(incidence_deg, 270.0)), direction_to_source(from(incidence_deg, -90.0)));
    const Vec3 diagonal = direction_to_source(from(incidence_deg, 45.0));
    EXPECT_EQ(diagonal.x(), diagonal.y());
  }
  EXPECT_EQ(rotation_about(Vec3::UnitZ(), Angle::from_deg(90.0)) * Vec3::UnitX(), Vec3::UnitY());
  PhotometricGeometry turned;
  turned.beta1 = Angle::from_deg(-20.0);
  for (const double epsilon_deg : {0.0, 180.0}) {
    turned.epsilon = Angle::from_deg(epsilon_deg);
    EXPECT_EQ(return_frame(turned).to_source.x(), 0.0);
  }
  turned.epsilon = Angle::from_deg(90.0);
  EXPECT_EQ(return_frame(turned).to_source.y(), 0.0);
}

// The RRE from resampled beams differs between neighbouring directions by at most the statistical error of the RRE.
TEST(LevelBeams, StochasticBeamsAgreeNextToAxes) {
  for (const std::size_t k : {0U, 2U, 9U}) {
    const Case c = cases()[k];
    const Part part = build_part(c.spec);
    const BeamTracer tracer(part);
    Sampling sampling;
    sampling.target_error = 1e-6;
    for (const double azimuth_deg : {90.0, 270.0}) {
      const auto traced = [&](double by_deg) {
        StochasticBeams beams(tracer, nullptr, optics_of(c), from(c.incidence_deg, azimuth_deg + by_deg), {0.5},
                              sampling);
        while (!beams.advance()) continue;
        return beams.result().cones[0];
      };
      const ConeResult there = traced(0.0);
      for (const double by_deg : {-3e-13, 1e-9}) {
        const ConeResult near = traced(by_deg);
        EXPECT_NEAR(near.rre, there.rre, 4.0 * std::hypot(near.std_error, there.std_error) + 1e-9)
            << c.name << " at " << azimuth_deg << " by " << by_deg;
      }
    }
  }
}

}  // namespace
}  // namespace retrace::testing::level_beams_test
