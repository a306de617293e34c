// Tests of the progress that a Monte Carlo run reports while it traces rays.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "raytrace/exact/beam_tracer.h"
#include "raytrace/paths/monte_carlo.h"
#include "raytrace/sampling/replicates.h"
#include "tests/support/designs.h"

namespace retrace::testing::ray_progress_test {
namespace {

using namespace raytrace;

class Reports : public Progress {
 public:
  void at(double share) override {
    shares.push_back(share);
    if (cancel != nullptr && share >= stop_at) cancel->request();
  }
  void expect_rise() const {
    for (std::size_t k = 1; k < shares.size(); ++k) EXPECT_GT(shares[k], shares[k - 1]);
  }
  std::vector<double> shares;
  Cancellation* cancel = nullptr;
  double stop_at = 0.0;
};

Sampling sampling_of(std::uint64_t rays) {
  Sampling sampling;
  sampling.rays = rays;
  return sampling;
}

TEST(RayProgress, OneLongRunOfABillionRaysIsReportedFromTheFirstThousandthOn) {
  constexpr std::uint64_t kRays = 1'000'000'000;
  Reports reports;
  std::uint32_t traced = 0;
  std::uint32_t longest = 0;
  Rounds rounds(
      sampling_of(kRays), {0.5}, 0,
      [&](std::uint32_t from, std::uint32_t until, std::vector<Tally>&) {
        EXPECT_EQ(from, traced) << "ranges follow each other";
        longest = std::max(longest, until - from);
        traced = until;
        return true;
      },
      &reports);
  while (!rounds.advance()) continue;
  EXPECT_EQ(traced, kRays / Sampling::kReplicates);
  EXPECT_LE(longest, traced / 100) << "between two reports at most 1 % of the rays";
  ASSERT_FALSE(reports.shares.empty());
  EXPECT_LT(reports.shares.front(), 1e-3);
  EXPECT_EQ(reports.shares.back(), 1.0);
  reports.expect_rise();
}

TEST(RayProgress, ReportsTheFractionOfTheRaysAndChangesNoResult) {
  const geometry::Part part =
      geometry::build_part(infinite(geometry::RtpElement{1.0, 1.0}, geometry::Arrangement::aligned, 1.0));
  const MonteCarlo tracer(part);
  const Sampling sampling = sampling_of(Sampling::kReplicates * 2048);
  Reports reports;
  const MonteCarloResult told = tracer.trace(pmma(), from(10.0), {0.5}, sampling, {}, nullptr, nullptr, &reports);
  const MonteCarloResult silent = tracer.trace(pmma(), from(10.0), {0.5}, sampling, {});
  EXPECT_EQ(reports.shares, (std::vector<double>{0.125, 0.25, 0.5, 1.0})) << "rounds double 256 rays of a replicate";
  EXPECT_EQ(told.cones[0].rre, silent.cones[0].rre);
  EXPECT_EQ(told.cones[0].std_error, silent.cones[0].std_error);
  EXPECT_EQ(told.segments, silent.segments);
}

TEST(RayProgress, ARunUntilATargetErrorRisesToOne) {
  const geometry::Part part =
      geometry::build_part(infinite(geometry::RtpElement{1.0, 1.0}, geometry::Arrangement::aligned, 1.0));
  Sampling sampling;
  sampling.target_error = 1e-3;
  Reports reports;
  const MonteCarloResult result =
      MonteCarlo(part).trace(pmma(), from(10.0), {0.5}, sampling, {}, nullptr, nullptr, &reports);
  EXPECT_TRUE(result.reached_target);
  ASSERT_FALSE(reports.shares.empty());
  EXPECT_EQ(reports.shares.back(), 1.0);
  reports.expect_rise();
}

/// Returns a part with many small cube corners. The exact engine traces each of them separately.
geometry::Part many_cubes() {
  return geometry::build_part(finite(geometry::HexagonalCube{0.5}, geometry::Arrangement::honeycomb, 10.0, 10.0, 1.0));
}

TEST(BeamProgress, RisesAndTheResultIsThatOfOneTraceWithoutPauses) {
  const geometry::Part part = many_cubes();
  const BeamTracer tracer(part);
  BeamPolicy policy;
  policy.cutoff = 1e-8;
  Reports reports;
  const BeamResult told = tracer.trace(pmma(), from(25.0, 7.0), {0.5}, policy, nullptr, {}, &reports);
  const Optics optics = pmma();
  const Illumination illumination = from(25.0, 7.0);
  const std::vector<double> cones_deg = {0.5};
  BeamTrace without_pauses(tracer, optics, illumination, cones_deg, policy);
  ASSERT_TRUE(without_pauses.advance(std::numeric_limits<std::uint64_t>::max(), nullptr));
  EXPECT_EQ(told.beams, without_pauses.result().beams);
  EXPECT_EQ(told.ledgers[0].power, without_pauses.result().ledgers[0].power);
  ASSERT_FALSE(reports.shares.empty());
  for (const double share : reports.shares) EXPECT_TRUE(share >= 0.0 && share <= 1.0) << share;
  for (std::size_t k = 1; k < reports.shares.size(); ++k) EXPECT_GE(reports.shares[k], reports.shares[k - 1]);
}

TEST(BeamProgress, WorkThatIsCancelledAtAReportEnds) {
  const geometry::Part part = many_cubes();
  BeamPolicy policy;
  policy.cutoff = 1e-13;  // the complete trace would take much longer than the test
  Cancellation cancel;
  Reports reports;
  reports.cancel = &cancel;
  const BeamResult result = BeamTracer(part).trace(pmma(), from(25.0, 7.0), {0.5}, policy, &cancel, {}, &reports);
  EXPECT_FALSE(result.complete);
  EXPECT_EQ(reports.shares.size(), 1U);
}

}  // namespace
}  // namespace retrace::testing::ray_progress_test
