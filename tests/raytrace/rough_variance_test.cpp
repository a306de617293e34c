// Tests of textured facets with reduced variance: specular and scattered light are traced separately.
#include <gtest/gtest.h>

#include <cmath>

#include "raytrace/paths/monte_carlo.h"
#include "tests/support/designs.h"
#include "tests/support/sample_size.h"
#include "tests/support/statistics.h"

namespace retrace::testing::rough_variance_test {
namespace {

using namespace geometry;
using namespace raytrace;

const PartSpec kCubes = infinite(HexagonalCube{1.0}, Arrangement::honeycomb, 1.0);
const std::vector<double> kCones = {0.5, 8.0};

Optics rough_pmma() {
  Optics optics = pmma();
  optics.facet_scatter = surface_models::HarveyShack({10.0, 5.0, 0.0, 0.0});
  return optics;
}

MonteCarloResult trace(const Part& part, std::uint64_t count, std::uint32_t seed, const PathPolicy& policy) {
  return MonteCarlo(part, MonteCarlo::Engine::cell)
      .trace(rough_pmma(), from(12.0, 30.0), kCones, rays(count, seed), policy);
}

// 95 % intervals of many short runs must contain the result of one long run with other points.
TEST(RoughVariance, ErrorsAreTrue) {
  constexpr std::uint32_t kSeeds = 60;
  const Part part = build_part(kCubes);
  // The fraction of intervals that contain the true value does not depend on the number of points. The true value is
  // estimated with 32 times as many points.
  const auto points = test::sample_size(1U << 11, 1U << 13);
  const ConeResult truth = trace(part, 32 * points, 1000, {}).cones[0];
  const double t95 = student_bound_of(0.05, Sampling::kReplicates);
  int within = 0;
  for (std::uint32_t seed = 1; seed <= kSeeds; ++seed) {
    const ConeResult run = trace(part, points, seed, {}).cones[0];
    within += std::abs(run.rre - truth.rre) <= t95 * std::hypot(run.std_error, truth.std_error) ? 1 : 0;
  }
  // The expected number is 57 of 60 runs. Fewer than 50 occur by chance in one of a thousand runs of the tests.
  EXPECT_GE(within, 50);
}

// Tracing specular and scattered light separately gives the same mean as a random choice between them, and needs fewer
// rays for the same error.
TEST(RoughVariance, SharesAreFollowedApart) {
  const Part part = build_part(kCubes);
  PathPolicy one_by_chance;
  one_by_chance.split_power = 1.0;
  const MonteCarloResult chance = trace(part, 1U << 18, 1, one_by_chance);
  const MonteCarloResult apart = trace(part, 1U << 16, 2, {});
  const double z = student_bound(kCones.size());
  for (std::size_t k = 0; k < kCones.size(); ++k) {
    const ConeResult& a = apart.cones[k];
    const ConeResult& b = chance.cones[k];
    EXPECT_NEAR(a.rre, b.rre, z * std::hypot(a.std_error, b.std_error)) << k;
    for (std::size_t n = 0; n < kAccountCount; ++n)
      EXPECT_NEAR(a.ledger.power[n], b.ledger.power[n], 4.0 * 0.5 / 256.0) << kAccountNames[n];
  }
  // In the narrow cone without scattered light, the error is smaller with a quarter of the rays.
  EXPECT_LT(apart.cones[0].std_error, chance.cones[0].std_error);
}

}  // namespace
}  // namespace retrace::testing::rough_variance_test
