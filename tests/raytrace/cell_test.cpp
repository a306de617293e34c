#include <gtest/gtest.h>

#include <cmath>

#include "core/threads.h"
#include "raytrace/cells/cell_lanes.h"
#include "raytrace/exact/beam_tracer.h"
#include "raytrace/paths/monte_carlo.h"
#include "raytrace/sampling/sobol.h"
#include "tests/support/designs.h"
#include "tests/support/statistics.h"

namespace retrace::testing::cell_test {
namespace {

using namespace geometry;
using namespace raytrace;

constexpr std::uint64_t kCellRays = 1U << 17;
constexpr std::uint64_t kEmbreeRays = 1U << 14;

/// Returns four standard deviations of a fraction of the power. The fraction is estimated from `count` independent
/// random rays.
double max_error(std::uint64_t count) {
  return 4.0 * 0.5 / std::sqrt(static_cast<double>(count));
}

PartSpec with(PartSpec spec, const AngleErrors& errors) {
  spec.angle_errors = errors;
  return spec;
}

PartSpec gapped(PartSpec spec, double x_mm, double y_mm) {
  spec.array.x_gap_mm = x_mm;
  spec.array.y_gap_mm = y_mm;
  return spec;
}

PartSpec rounded(PartSpec spec, double root_radius_mm, double rim_radius_mm = 0.0) {
  spec.edges.root_radius_mm = root_radius_mm;
  spec.edges.rim_radius_mm = rim_radius_mm;
  return spec;
}

PartSpec omitting(PartSpec spec) {
  spec.array.partial_elements = PartialElements::omit;
  return spec;
}

using Case = TraceCase;

template <class Change>
Optics optics_with(const Change& change) {
  Optics optics = pmma();
  change(optics);
  return optics;
}

std::vector<Case> cases() {
  const PartSpec aligned = infinite(RtpElement{0.5, 0.5, 90.0}, Arrangement::aligned, 0.5);
  const PartSpec bricks = infinite(RtpElement{0.5, 0.5, 90.0}, Arrangement::offset, 0.5);
  PartSpec thirds = bricks;
  thirds.array.overlap_percent = 30.0;
  const PartSpec checker = infinite(RtpElement{0.5, 0.5, 90.0}, Arrangement::checker, 0.7);
  const PartSpec honeycomb = infinite(HexagonalCube{1.0}, Arrangement::honeycomb, 1.0);
  const PartSpec triangles = infinite(TriangularCube{1.0}, Arrangement::triangular, 1.0);
  const PartSpec few_bricks = finite(RtpElement{0.5, 0.5, 90.0}, Arrangement::offset, 3.7, 3.6, 0.8);
  const PartSpec few_cubes = finite(HexagonalCube{0.5}, Arrangement::honeycomb, 3.5, 3.0, 0.8);
  const PartSpec few_triangles = finite(TriangularCube{0.5}, Arrangement::triangular, 3.0, 3.5, 0.8);
  const auto absorbing = [](double per_mm) { return optics_with([&](Optics& o) { o.absorption_per_mm = per_mm; }); };
  const Optics water = optics_with([](Optics& o) { o.back_index = 1.333; });
  const Optics glue = optics_with([](Optics& o) {
    o.index = 1.6;
    o.back_index = 1.2;
  });
  const Optics black_walls = optics_with([](Optics& o) { o.absorbing_walls = true; });
  const Optics metal = optics_with([](Optics& o) { o.facet_layers = opaque({1.1, 6.9}); });
  const Optics layers = optics_with([](Optics& o) {
    o.absorption_per_mm = 0.1;
    o.facet_layers = thin_aluminium();
    o.entrance_layers = anti_reflection();
  });
  const Optics behind_metal = optics_with([](Optics& o) {
    o.facet_layers = anti_reflection();
    o.entrance_layers = thin_aluminium();
  });
  const Optics lossless = optics_with([](Optics& o) { o.lossless_entrance = true; });
  return {{"aligned", aligned, 0.0, 0.0},
          {"aligned beyond the knee", aligned, 20.0, 0.0},
          {"aligned askew", aligned, 35.0, 50.0, absorbing(0.2)},
          {"aligned in water", aligned, 10.0, 5.0, water},
          {"aligned, linear light", aligned, 25.0, 30.0, pmma(), {1.0, 0.6, 0.0, 0.8}},
          {"aligned, wrong apex", with(aligned, {{30.0}, {}}), 5.0, 30.0},
          {"aligned, tilted", with(aligned, {{}, {20.0, -45.0}}), 25.0, 80.0},
          {"aligned, round roots", rounded(aligned, 0.02), 15.0, 20.0},
          {"bricks", bricks, 20.0, 35.0},
          {"checker", checker, 15.0, 20.0},
          {"bricks by a third", thirds, 30.0, 70.0, absorbing(0.1)},
          {"bricks, black walls", bricks, 20.0, 60.0, black_walls},
          {"bricks, aluminised", bricks, 20.0, 60.0, metal},
          {"bricks, lossless entrance", bricks, 40.0, 60.0, lossless},
          {"gaps", gapped(bricks, 0.05, 0.03), 20.0, 35.0},
          {"honeycomb", honeycomb, 0.0, 0.0},
          {"honeycomb askew", honeycomb, 25.0, 40.0, absorbing(0.05)},
          {"honeycomb of mirrors", honeycomb, 25.0, 40.0, ideal()},
          {"honeycomb, errors", with(honeycomb, {{10.0, -5.0, 20.0}, {3.0, 0.0, 0.0}}), 10.0, 100.0},
          {"honeycomb, circular light", honeycomb, 10.0, 15.0, pmma(), {1.0, 0.0, 0.0, 1.0}},
          {"honeycomb, round roots", rounded(honeycomb, 0.02), 12.0, 50.0},
          {"triangles", triangles, 0.0, 0.0},
          {"triangles askew", triangles, 20.0, 75.0},
          {"triangles, errors, glue", with(triangles, {{10.0, -5.0, 20.0}, {}}), 30.0, 10.0, glue},
          {"aligned, round edges", rounded(aligned, 0.01, 0.03), 10.0, 20.0},
          {"gaps, round edges, aluminised", rounded(gapped(bricks, 0.05, 0.03), 0.01, 0.02), 12.0, 30.0, metal},
          {"few bricks", few_bricks, 15.0, 25.0, absorbing(0.1)},
          {"few bricks, partial ones omitted, black walls", omitting(few_bricks), 20.0, 70.0, black_walls},
          {"bricks, layers", bricks, 20.0, 60.0, layers},
          {"checker, layers, linear light", checker, 25.0, 30.0, layers, {1.0, 0.6, 0.0, 0.8}},
          {"honeycomb behind metal", honeycomb, 25.0, 40.0, behind_metal, {1.0, 0.0, 0.0, 1.0}},
          {"few cubes, layers", few_cubes, 15.0, 25.0, layers},
          {"few bricks in water", few_bricks, 5.0, 70.0, water},
          {"few cubes", few_cubes, 10.0, 35.0},
          {"few triangles", few_triangles, 10.0, 35.0}};
}

class CellEngine : public ::testing::TestWithParam<std::size_t> {};

TEST_P(CellEngine, AgreesWithTheExactEngineAndWithEmbree) {
  const Case c = cases()[GetParam()];
  const Part part = build_part(c.spec);
  Illumination light = from(c.incidence_deg, c.azimuth_deg);
  light.stokes = c.stokes;
  const std::vector<double> cones = {0.5, 8.0};
  ASSERT_TRUE(MonteCarlo::cell_supports(part)) << c.name;
  const MonteCarloResult cell =
      MonteCarlo(part, MonteCarlo::Engine::cell).trace(c.optics, light, cones, rays(kCellRays), {});
  const MonteCarloResult embree = MonteCarlo(part).trace(c.optics, light, cones, rays(kEmbreeRays), {});
  BeamPolicy policy;
  policy.cutoff = 1e-6;
  const BeamResult exact = BeamTracer(part).trace(c.optics, light, cones, policy);
  EXPECT_EQ(cell.misses, 0U) << c.name;
  const double z = student_bound(2 * cases().size() * cones.size());
  for (std::size_t k = 0; k < cones.size(); ++k) {
    const double left_behind = exact.ledgers[k][Account::truncated] + 1e-9;
    EXPECT_NEAR(cell.cones[k].rre, exact.ledgers[k][Account::retroreflected], z * cell.cones[k].spread + left_behind)
        << c.name;
    EXPECT_NEAR(cell.cones[k].ledger.total(), 1.0, 1e-9) << c.name;
    for (std::size_t a = 0; a < kAccountCount; ++a) {
      EXPECT_NEAR(cell.cones[k].ledger.power[a], exact.ledgers[k].power[a], max_error(kCellRays) + left_behind)
          << c.name << ", " << kAccountNames[a];
      EXPECT_NEAR(cell.cones[k].ledger.power[a], embree.cones[k].ledger.power[a], max_error(kEmbreeRays))
          << c.name << ", " << kAccountNames[a];
    }
    const auto exact_stokes = exact.stokes[k].values();
    const auto cell_stokes = cell.cones[k].stokes.values();
    for (std::size_t n = 0; n < exact_stokes.size(); ++n)
      EXPECT_NEAR(cell_stokes[n], exact_stokes[n], 2.0 * max_error(kCellRays) + left_behind) << c.name << ' ' << n;
  }
}

INSTANTIATE_TEST_SUITE_P(Cases, CellEngine, ::testing::Range(std::size_t{0}, cases().size()));

// If all branches are followed, there are no random choices. Both engines then trace the same rays: one engine traces
// them one by one, the other in SIMD lanes.
TEST(CellKernel, SameRaysAsEmbreeWithoutChance) {
  PathPolicy all_branches;
  all_branches.split_power = 0.0;
  all_branches.cutoff = 1e-5;
  for (const Case& c : cases()) {
    const Part part = build_part(c.spec);
    const Illumination light = from(c.incidence_deg, c.azimuth_deg);
    const auto ledger = [&](MonteCarlo::Engine engine) {
      return MonteCarlo(part, engine).trace(c.optics, light, {0.5}, rays(1U << 10), all_branches).cones[0].ledger;
    };
    const Ledger cell = ledger(MonteCarlo::Engine::cell);
    const Ledger embree = ledger(MonteCarlo::Engine::embree);
    // Two effects cause small differences. Rays that hit an edge within rounding errors may take either side of the
    // edge. With absorption, the lanes compare the power of a ray with the cut-off more often.
    const double slack = c.optics.absorption_per_mm > 0.0 ? 0.1 * embree[Account::truncated] : 0.0;
    for (std::size_t a = 0; a < kAccountCount; ++a)
      EXPECT_NEAR(cell.power[a], embree.power[a], 1e-7 + slack) << c.name << ", " << kAccountNames[a];
  }
}

struct RoughCase {
  std::string name;
  PartSpec spec;
  surface_models::ScatterModel texture;
  Optics optics = pmma();
};

std::vector<RoughCase> rough_cases() {
  const PartSpec prisms = infinite(RtpElement{0.5, 0.5, 90.0}, Arrangement::aligned, 0.5);
  const PartSpec cubes = infinite(HexagonalCube{1.0}, Arrangement::honeycomb, 1.0);
  const PartSpec triangles = infinite(TriangularCube{1.0}, Arrangement::triangular, 1.0);
  const PartSpec few = finite(RtpElement{0.5, 0.5, 90.0}, Arrangement::offset, 3.7, 3.6, 0.8);
  Optics metal = pmma();
  metal.facet_layers = opaque({1.1, 6.9});
  Optics layers = pmma();
  layers.facet_layers = thin_aluminium();
  layers.entrance_layers = anti_reflection();
  return {{"Harvey-Shack, prisms", prisms, surface_models::HarveyShack({20.0, 5.0, 0.0, 0.0})},
          {"waviness, cubes", cubes, surface_models::HarveyShack({10.0, 5.0, 400.0, 100.0})},
          {"ABg, triangles", triangles, surface_models::Abg(1e-3, 1e-4, 1.5)},
          {"aluminised, cubes", cubes, surface_models::HarveyShack({20.0, 5.0, 0.0, 0.0}), metal},
          {"layers, cubes", cubes, surface_models::HarveyShack({40.0, 5.0, 0.0, 0.0}), layers},
          {"Harvey-Shack, few prisms", few, surface_models::HarveyShack({20.0, 5.0, 0.0, 0.0})}};
}

class CellEngineOfRough : public ::testing::TestWithParam<std::size_t> {};

// The exact engine does not support all surface textures. Instead, the cell engine and Embree, which find facets in
// different ways, must give the same ledgers.
TEST_P(CellEngineOfRough, AgreesWithEmbree) {
  const RoughCase c = rough_cases()[GetParam()];
  const Part part = build_part(c.spec);
  Optics optics = c.optics;
  optics.facet_scatter = c.texture;
  const std::vector<double> cones = {0.5, 8.0};
  const auto trace = [&](MonteCarlo::Engine engine, std::uint64_t count, std::uint32_t seed) {
    return MonteCarlo(part, engine).trace(optics, from(8.0, 35.0), cones, rays(count, seed), {});
  };
  ASSERT_TRUE(MonteCarlo::cell_supports(part)) << c.name;
  const MonteCarloResult cell = trace(MonteCarlo::Engine::cell, 1U << 16, 1);
  const MonteCarloResult embree = trace(MonteCarlo::Engine::embree, 1U << 16, 2);
  EXPECT_EQ(cell.misses, 0U) << c.name;
  EXPECT_GT(cell.cones[1].ledger[Account::scattered_out], 0.01) << c.name;
  const double z = student_bound(rough_cases().size() * cones.size());
  for (std::size_t k = 0; k < cones.size(); ++k) {
    EXPECT_NEAR(cell.cones[k].rre, embree.cones[k].rre, z * std::hypot(cell.cones[k].spread, embree.cones[k].spread))
        << c.name;
    EXPECT_NEAR(cell.cones[k].ledger.total(), 1.0, 1e-9) << c.name;
    for (std::size_t a = 0; a < kAccountCount; ++a)
      EXPECT_NEAR(cell.cones[k].ledger.power[a], embree.cones[k].ledger.power[a], max_error(1U << 16))
          << c.name << ", " << kAccountNames[a];
  }
}

INSTANTIATE_TEST_SUITE_P(Cases, CellEngineOfRough, ::testing::Range(std::size_t{0}, rough_cases().size()));

TEST(CellKernel, SameBytesAtAnyThreadCount) {
  const Case c = cases()[9];
  const Part part = build_part(c.spec);
  const MonteCarlo tracer(part, MonteCarlo::Engine::cell);
  const auto run = [&](unsigned threads, std::uint32_t seed) {
    MonteCarloResult result;
    run_with_threads(threads,
                     [&] { result = tracer.trace(pmma(), from(25.0, 40.0), {0.5}, rays(1U << 18, seed), {}); });
    return result;
  };
  const MonteCarloResult one = run(1, 1);
  for (const unsigned threads : {2U, 7U}) {
    const MonteCarloResult other = run(threads, 1);
    EXPECT_EQ(one.cones[0].rre, other.cones[0].rre) << threads;
    EXPECT_EQ(one.cones[0].std_error, other.cones[0].std_error) << threads;
    EXPECT_EQ(one.cones[0].ledger.power, other.cones[0].ledger.power) << threads;
    EXPECT_EQ(one.segments, other.segments) << threads;
  }
  EXPECT_NE(one.cones[0].rre, run(1, 2).cones[0].rre);
}

TEST(CellKernel, EntryPointsAreTheSobolPoints) {
  constexpr std::size_t kCount = 37;
  const geometry::Vec2 size(0.7, 1.3);
  for (const std::uint32_t first : {0U, 4096U, 4294967000U}) {
    std::vector<double> x(kCount + raytrace::lanes::kPadding);
    std::vector<double> y(kCount + raytrace::lanes::kPadding);
    raytrace::lanes::sobol(123456789012345U, 987654321U, first, kCount, size, x.data(), y.data());
    const raytrace::SobolSquare square(123456789012345U, 987654321U);
    for (std::size_t k = 0; k < kCount; ++k) {
      const auto expected = square(first + static_cast<std::uint32_t>(k));
      EXPECT_EQ(x[k], expected[0] * size.x()) << first << ' ' << k;
      EXPECT_EQ(y[k], expected[1] * size.y()) << first << ' ' << k;
    }
  }
}

TEST(CellKernel, ServesEqualElementsFarFromBorders) {
  const RtpElement prism{0.5, 0.5, 90.0};
  EXPECT_TRUE(MonteCarlo::cell_supports(build_part(infinite(prism, Arrangement::aligned, 0.5))));
  EXPECT_FALSE(MonteCarlo::cell_supports(build_part(single(prism, 0.5))));
  PartSpec few = finite(prism, Arrangement::aligned, 2.5, 2.5, 0.5);
  EXPECT_TRUE(MonteCarlo::cell_supports(build_part(few)));
  few.random_tilts.sigma_arcmin = 1.0;
  EXPECT_FALSE(MonteCarlo::cell_supports(build_part(few)));
  EXPECT_FALSE(MonteCarlo::cell_supports(build_part(finite(prism, Arrangement::aligned, 2.0, 2.5, 0.5))));
  EXPECT_FALSE(MonteCarlo::cell_supports(
      build_part(rounded(infinite(HexagonalCube{1.0}, Arrangement::honeycomb, 1.0), 0.0, 0.02))));
}

}  // namespace
}  // namespace retrace::testing::cell_test
