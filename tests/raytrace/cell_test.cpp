#include <gtest/gtest.h>

#include <cmath>

#include "raytrace/beam_tracer.h"
#include "raytrace/monte_carlo.h"
#include "tests/support/designs.h"
#include "tests/support/statistics.h"

namespace retrace::raytrace {
namespace {

using namespace geometry;
using namespace testing;

PartSpec with(PartSpec spec, const AngleErrors& errors) {
  spec.angle_errors = errors;
  return spec;
}

PartSpec gapped(PartSpec spec, double x_mm, double y_mm) {
  spec.x_gap_mm = x_mm;
  spec.y_gap_mm = y_mm;
  return spec;
}

struct Case {
  std::string name;
  PartSpec spec;
  double incidence_deg;
  double azimuth_deg;
  double index = 1.4917;
  double absorption_per_mm = 0.0;
  double back_index = 1.0;
  bool absorbing_walls = false;
};

std::vector<Case> cases() {
  const PartSpec aligned = infinite(RtpElement{0.5, 0.5, 90.0}, Arrangement::aligned, 0.5);
  PartSpec bricks = infinite(RtpElement{0.5, 0.5, 90.0}, Arrangement::offset, 0.5);
  PartSpec thirds = bricks;
  thirds.overlap_percent = 30.0;
  const PartSpec checker = infinite(RtpElement{0.5, 0.5, 90.0}, Arrangement::checker, 0.7);
  const PartSpec honeycomb = infinite(HexagonalCube{1.0}, Arrangement::honeycomb, 1.0);
  const PartSpec triangles = infinite(TriangularCube{1.0}, Arrangement::triangular, 1.0);
  return {{"aligned", aligned, 0.0, 0.0},
          {"aligned beyond the knee", aligned, 20.0, 0.0},
          {"aligned askew", aligned, 35.0, 50.0, 1.4917, 0.2},
          {"aligned in water", aligned, 10.0, 5.0, 1.4917, 0.0, 1.333},
          {"aligned, wrong apex", with(aligned, {{30.0}, {}}), 5.0, 30.0},
          {"aligned, tilted", with(aligned, {{}, {20.0, -45.0}}), 25.0, 80.0},
          {"bricks", bricks, 20.0, 35.0},
          {"bricks by a third", thirds, 30.0, 70.0, 1.4917, 0.1},
          {"bricks, black walls", bricks, 20.0, 60.0, 1.4917, 0.0, 1.0, true},
          {"checker", checker, 15.0, 20.0},
          {"gaps", gapped(bricks, 0.05, 0.03), 20.0, 35.0},
          {"honeycomb", honeycomb, 0.0, 0.0},
          {"honeycomb askew", honeycomb, 25.0, 40.0, 1.4917, 0.05},
          {"honeycomb, errors", with(honeycomb, {{10.0, -5.0, 20.0}, {3.0, 0.0, 0.0}}), 10.0, 100.0},
          {"triangles", triangles, 0.0, 0.0},
          {"triangles askew", triangles, 20.0, 75.0},
          {"triangles, errors, glue", with(triangles, {{10.0, -5.0, 20.0}, {}}), 30.0, 10.0, 1.6, 0.0, 1.2}};
}

class CellEngine : public ::testing::TestWithParam<std::size_t> {};

TEST_P(CellEngine, AgreesWithTheExactEngineAndWithEmbree) {
  const Case c = cases()[GetParam()];
  const Part part = build_part(c.spec);
  Optics optics;
  optics.index = c.index;
  optics.absorption_per_mm = c.absorption_per_mm;
  optics.back_index = c.back_index;
  optics.absorbing_walls = c.absorbing_walls;
  const Illumination light = from(c.incidence_deg, c.azimuth_deg);
  const std::vector<double> cones = {0.5, 8.0};
  ASSERT_TRUE(MonteCarlo::cell_serves(part, optics)) << c.name;
  const MonteCarloResult cell =
      MonteCarlo(part, MonteCarlo::Engine::cell).trace(optics, light, cones, rays(1U << 18), {});
  const MonteCarloResult embree = MonteCarlo(part).trace(optics, light, cones, rays(1U << 16), {});
  BeamPolicy policy;
  policy.cutoff = 1e-6;
  const BeamResult exact = BeamTracer(part).trace(optics, light, cones, policy);
  const double z = student_bound(2 * cases().size() * cones.size());
  for (std::size_t k = 0; k < cones.size(); ++k) {
    EXPECT_NEAR(cell.cones[k].rre, exact.ledgers[k][Account::retroreflected],
                z * cell.cones[k].std_error + exact.ledgers[k][Account::truncated] + 1e-9)
        << c.name;
    double sum = 0.0;
    for (std::size_t a = 0; a < kAccountCount; ++a) {
      // Both sample the same points of the entrance.
      EXPECT_NEAR(cell.cones[k].ledger.power[a], embree.cones[k].ledger.power[a], 3e-3) << c.name << kAccountNames[a];
      sum += cell.cones[k].ledger.power[a];
    }
    EXPECT_NEAR(sum, 1.0, 1e-9) << c.name;
    EXPECT_EQ(cell.misses, 0U) << c.name;
  }
}

INSTANTIATE_TEST_SUITE_P(Cases, CellEngine, ::testing::Range(std::size_t{0}, cases().size()));

}  // namespace
}  // namespace retrace::raytrace
