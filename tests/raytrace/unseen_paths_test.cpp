// Tests that standard errors allow for paths of light that only a few rays, or none, have taken
// (docs/theory/monte_carlo.md).
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "raytrace/exact/beam_tracer.h"
#include "raytrace/paths/ray_tracer.h"
#include "raytrace/sampling/replicates.h"
#include "raytrace/sampling/sobol.h"
#include "tests/support/designs.h"
#include "tests/support/sample_size.h"

namespace retrace::testing::unseen_paths_test {
namespace {

using namespace geometry;
using namespace raytrace;

/// Minimum fraction of runs in which 1.96 standard errors contain the true value: 0.95 less the statistical error of
/// 300 runs.
constexpr double kRequired = 0.93;

/// Random rectangle in the unit square of entry points. Light that enters in the rectangle returns; all other light
/// is transmitted.
struct ReturningRegion {
  double x = 0.0, y = 0.0, width = 0.0, height = 0.0;

  ReturningRegion(std::mt19937& random, double area) {
    const auto between = [&](double low, double high) {
      return std::uniform_real_distribution<double>(low, high)(random);
    };
    width = std::min(1.0, std::sqrt(area) * std::exp(between(-2.0, 2.0)));
    height = area / width;
    x = between(0.0, 1.0 - width);
    y = between(0.0, 1.0 - height);
  }
  bool contains(const std::array<double, 2>& p) const {
    return p[0] >= x && p[0] < x + width && p[1] >= y && p[1] < y + height;
  }
};

MonteCarloResult sampled(const ReturningRegion& region, double target_error, std::uint32_t seed) {
  Sampling sampling;
  sampling.seed = seed;
  sampling.target_error = target_error;
  Rounds rounds(sampling, {0.5}, 0, [&](std::uint32_t from, std::uint32_t until, std::vector<Tally>& replicates) {
    for (std::uint32_t k = 0; k < Sampling::kReplicates; ++k) {
      const auto keys = scramble_keys(seed, k);
      const SobolSquare square(keys[0], keys[1]);
      for (std::uint32_t ray = from; ray < until; ++ray) {
        Tally& tally = replicates[k];
        if (region.contains(square(ray)))
          tally.returned[0].i += 1.0;
        else
          tally.other[Account::transmitted] += 1.0;
      }
    }
    return true;
  });
  while (!rounds.advance()) continue;
  return rounds.result();
}

// Light returns only from one region, whose area is the true RRE. Areas range from 0.14 to 20 times the target error.
TEST(UnseenPaths, SmallRegionsLieWithinTheError) {
  constexpr int kRegions = 300;
  for (const double target : {1e-3, 1e-4}) {
    std::mt19937 random(3);
    int within = 0;
    for (std::uint32_t k = 0; k < kRegions; ++k) {
      const double area = target * std::exp(std::uniform_real_distribution<double>(-2.0, 3.0)(random));
      const MonteCarloResult result = sampled(ReturningRegion(random, area), target, k + 1);
      const ConeResult& cone = result.cones[0];
      EXPECT_LE(cone.std_error, target);
      within += std::abs(cone.rre - area) <= 1.96 * cone.std_error ? 1 : 0;
    }
    EXPECT_GE(within, kRequired * kRegions) << target;
  }
}

// If none of n rays meets a region, its fraction of the light is below 3 / n with 95 % confidence. This bound
// determines the number of rays, which is rounded up to a power of two.
TEST(UnseenPaths, ATargetOf1e5StaysAffordable) {
  std::mt19937 random(1);
  const MonteCarloResult result = sampled(ReturningRegion(random, 1e-9), 1e-5, 1);
  EXPECT_TRUE(result.reached_target);
  EXPECT_GE(static_cast<double>(result.rays), 3.0 / 1.96 / 1e-5 * 0.99);
  EXPECT_LE(result.rays, 1U << 18);
}

struct Question {
  PartSpec spec;
  Optics optics;
  Illumination illumination;
};

/// Returns a random prism or cube corner that the exact engine traces quickly. Half of the parts have rounded roots,
/// which are modelled by narrow planes that few rays meet.
Question random_question(std::mt19937& random) {
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  const auto one_in = [&](int count) { return std::uniform_int_distribution<int>(1, count)(random) == 1; };
  const double size = between(0.5, 2.0);
  Question question;
  const bool is_infinite = one_in(3);
  if (is_infinite)
    question.spec = infinite(RtpElement{size, between(0.5, 2.0), 90.0}, Arrangement::aligned, between(0.5, 2.0));
  else
    question.spec = single(one_in(2) ? Element(HexagonalCube{size}) : Element(RtpElement{size, size, 90.0}), 1.0);
  if (one_in(2)) question.spec.edges.root_radius_mm = between(0.001, 0.05) * size;
  question.optics.index = between(1.4, 1.7);
  question.illumination = from(between(0.0, 30.0), is_infinite ? 0.0 : between(0.0, 360.0));
  return question;
}

// The benchmark benchmarks/error_coverage.cpp tests more designs and other target errors.
TEST(UnseenPaths, RandomDesignsContainTheExactAnswer) {
  const std::uint32_t designs = test::sample_size(10U, 25U);
  std::mt19937 random(58);
  int count = 0, within = 0;
  for (const double target : {1e-3, 1e-4})
    for (std::uint32_t k = 0; k < designs; ++k) {
      const Question question = random_question(random);
      const Part part = build_part(question.spec);
      BeamPolicy policy;
      policy.truncated_goal = 0.2 * target;
      const Ledger exact = BeamTracer(part, BeamTracer::Elements::instanced)
                               .trace(question.optics, question.illumination, {0.5}, policy)
                               .ledgers[0];
      Sampling sampling;
      sampling.seed = k + 1;
      sampling.target_error = target;
      const ConeResult cone =
          MonteCarlo(part).trace(question.optics, question.illumination, {0.5}, sampling, {}).cones[0];
      const double off = std::abs(cone.rre - exact[Account::retroreflected] - 0.5 * exact[Account::truncated]);
      within += off <= 1.96 * cone.std_error + 0.5 * exact[Account::truncated] ? 1 : 0;
      ++count;
    }
  // If each design succeeds with a probability of 95 %, the probability of fewer successes than this bound is 1 %. The
  // standard error of a binomial count makes the bound right for any number of designs.
  EXPECT_GE(within, 0.95 * count - 2.33 * std::sqrt(0.95 * 0.05 * count));
}

// If all rays of a file end in the same account of the ledger, the standard error follows from the number of rays by
// the rule of three. The standard error for a single ray is limited to 0.5.
TEST(UnseenPaths, RayLedgersShowTheRuleOfThree) {
  RayLedger ledger;
  ledger.incident = 1000.0;
  ledger.squares = 1000.0;
  EXPECT_NEAR(std::exp(-1.959964 * ledger.std_error() * 1000.0), 0.05, 3e-4);
  RayLedger one;
  one.incident = one.squares = 1.0;
  EXPECT_EQ(one.std_error(), 0.5);
  EXPECT_EQ(RayLedger{}.std_error(), 0.0);
}

}  // namespace
}  // namespace retrace::testing::unseen_paths_test
