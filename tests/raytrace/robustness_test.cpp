// Tests of leaks, coordinates far from the origin, large arrays, threads and interruption.
#include <gtest/gtest.h>

#include <cstring>

#include "core/threads.h"
#include "tests/support/designs.h"
#include "tests/support/sample_size.h"
#include "tests/support/statistics.h"

namespace retrace::testing::robustness_test {
namespace {

using namespace geometry;
using namespace raytrace;

struct Kind {
  const char* name;
  PartSpec finite_spec;
  PartSpec infinite_spec;
};

std::vector<Kind> kinds() {
  const RtpElement prism{0.5, 0.5, 90.0};
  const HexagonalCube hexagon{0.8};
  const TriangularCube triangle{0.8};
  return {{"rtp", finite(prism, Arrangement::offset, 8.0, 8.0, 1.0), infinite(prism, Arrangement::offset, 1.0)},
          {"hexagonal", finite(hexagon, Arrangement::honeycomb, 8.0, 8.0, 1.0),
           infinite(hexagon, Arrangement::honeycomb, 1.0)},
          {"triangular", finite(triangle, Arrangement::triangular, 8.0, 8.0, 1.0),
           infinite(triangle, Arrangement::triangular, 1.0)}};
}

class Leaks : public ::testing::TestWithParam<std::size_t> {};

/// No ray leaks through an edge or a corner. The test traces 10^7 path segments (10^8 in a long run), divided among the
/// three kinds of elements. The expected number of leaks is 0 for any number of segments. The smallest detectable rate
/// of leaks is inversely proportional to the number of segments.
TEST_P(Leaks, NoSegmentLeaks) {
  const Kind kind = kinds()[GetParam()];
  const std::uint64_t max_segments = test::sample_size<std::uint64_t>(10'000'000, 100'000'000) / kinds().size();
  std::uint64_t segments = 0;
  std::uint64_t misses = 0;
  const Part finite_part = build_part(kind.finite_spec);
  const Part infinite_part = build_part(kind.infinite_spec);
  const MonteCarlo finite_tracer(finite_part);
  const MonteCarlo infinite_tracer(infinite_part);
  std::uint32_t seed = 0;
  // Rounds are short, so that the last round exceeds the maximum number of segments only slightly.
  while (segments < max_segments) {
    // Some directions hit edges exactly (azimuths of 0, 30 and 90 degrees), and some avoid them.
    for (const auto& [t, p] : {std::pair{0.0, 0.0}, {35.0, 30.0}, {12.0, 90.0}, {61.0, 47.3}, {5.0, 211.7}}) {
      for (const MonteCarlo* tracer : {&finite_tracer, &infinite_tracer}) {
        const MonteCarloResult result = tracer->trace(pmma(), from(t, p), {0.5}, rays(1U << 13, ++seed), {});
        segments += result.segments;
        misses += result.misses;
        EXPECT_NEAR(result.cones[0].ledger.total(), 1.0, 1e-9);
      }
    }
  }
  EXPECT_EQ(misses, 0U) << kind.name;
  RecordProperty("segments", std::to_string(segments));
}

INSTANTIATE_TEST_SUITE_P(Kinds, Leaks, ::testing::Values(0U, 1U, 2U));

// An element returns the same light at the origin and at a distance of 100 mm from the origin. The bound is a multiple
// of the spread of the result, and thus valid for any number of rays.
TEST(Robustness, FarFromTheOrigin) {
  for (const Kind& kind : kinds()) {
    const Part near = build_part(kind.finite_spec);
    const Part far = build_part(kind.finite_spec, Vec2(100.0, -100.0));
    const Sampling sampling = rays(test::sample_size(1U << 16, 1U << 18));
    const ConeResult at_origin = MonteCarlo(near).trace(pmma(), from(10.0, 20.0), {0.5}, sampling, {}).cones[0];
    const ConeResult away = MonteCarlo(far).trace(pmma(), from(10.0, 20.0), {0.5}, sampling, {}).cones[0];
    EXPECT_NEAR(at_origin.rre, away.rre, student_bound(3) * at_origin.spread + 1e-9) << kind.name;
  }
}

TEST(Robustness, ElementsFarFromTheMiddleOfALargeArray) {
  // An infinite array is compared with an array of 200 mm. The effect of the border is smaller than the allowed
  // difference.
  for (const auto& [element, arrangement] :
       {std::pair<Element, Arrangement>{HexagonalCube{0.8}, Arrangement::honeycomb},
        {TriangularCube{0.8}, Arrangement::triangular},
        {RtpElement{0.5, 0.5, 90.0}, Arrangement::aligned}}) {
    const Part large = build_part(finite(element, arrangement, 200.0, 200.0, 0.5));
    const Part endless = build_part(infinite(element, arrangement, 0.5));
    // More rays would not improve the test, because the border determines most of the allowed difference.
    const ConeResult a = MonteCarlo(large).trace(ideal(), from(10.0, 20.0), {0.5}, rays(1U << 17), {}).cones[0];
    const ConeResult b = MonteCarlo(endless).trace(ideal(), from(10.0, 20.0), {0.5}, rays(1U << 17), {}).cones[0];
    const double border = 4.0 * 2.0 / 200.0 * 0.8;
    EXPECT_NEAR(a.rre, b.rre, border + 5.0 * a.spread);
    EXPECT_EQ(a.ledger[Account::lost], 0.0);
  }
}

bool same_bytes(const MonteCarloResult& a, const MonteCarloResult& b) {
  return a.segments == b.segments && a.rays == b.rays &&
         std::memcmp(a.cones[0].ledger.power.data(), b.cones[0].ledger.power.data(), sizeof(a.cones[0].ledger.power)) ==
             0 &&
         std::memcmp(&a.cones[0].std_error, &b.cones[0].std_error, sizeof(double)) == 0;
}

TEST(Robustness, SameBytesAtAnyThreadCount) {
  for (const Kind& kind : kinds()) {
    const Part part = build_part(kind.finite_spec);
    const MonteCarlo tracer(part);
    const auto run = [&](unsigned threads, std::uint32_t seed) {
      MonteCarloResult result;
      run_with_threads(threads,
                       [&] { result = tracer.trace(pmma(), from(25.0, 40.0), {0.5}, rays(1U << 14, seed), {}); });
      return result;
    };
    const MonteCarloResult one = run(1, 1);
    EXPECT_TRUE(same_bytes(one, run(2, 1))) << kind.name;
    EXPECT_TRUE(same_bytes(one, run(7, 1))) << kind.name;
    EXPECT_FALSE(same_bytes(one, run(1, 2))) << kind.name;
  }
}

TEST(Robustness, StopsAtTheTargetError) {
  const Part part = build_part(single(HexagonalCube{1.0}, 0.5));
  Sampling sampling;
  sampling.target_error = 2e-4;
  const MonteCarloResult result = MonteCarlo(part).trace(pmma(), from(20.0, 10.0), {0.5}, sampling, {});
  EXPECT_TRUE(result.reached_target);
  EXPECT_LE(result.cones[0].std_error, 2e-4);
  sampling.target_error = 1e-9;
  sampling.max_rays = 1U << 16;
  const MonteCarloResult limited = MonteCarlo(part).trace(pmma(), from(20.0, 10.0), {0.5}, sampling, {});
  EXPECT_FALSE(limited.reached_target);
  EXPECT_GE(limited.rays, 1U << 16);
}

TEST(Robustness, CancellationEndsTheRun) {
  const Part part = build_part(single(HexagonalCube{1.0}, 0.5));
  Cancellation cancel;
  cancel.request();
  const MonteCarloResult result = MonteCarlo(part).trace(pmma(), from(20.0), {0.5}, rays(1U << 20), {}, &cancel);
  EXPECT_FALSE(result.complete);
}

}  // namespace
}  // namespace retrace::testing::robustness_test
