// Tests of the exact engine with resampled weak beams: unbiased results, correct confidence intervals, conservation of
// power, and far fields.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "core/progress.h"
#include "core/threads.h"
#include "raytrace/exact/beam_tracer.h"
#include "raytrace/observers/far_field.h"
#include "raytrace/sampling/replicates.h"
#include "tests/support/closed_forms.h"
#include "tests/support/designs.h"
#include "tests/support/light_traps.h"
#include "tests/support/return_frames.h"
#include "tests/support/sample_size.h"
#include "tests/support/statistics.h"
#include "tests/support/traced_far_fields.h"

namespace retrace::testing::weak_beams_test {
namespace {

using namespace geometry;
using namespace raytrace;

using Question = PartInLight;

std::vector<Question> questions() {
  return light_traps(3.0);
}

BeamPolicy resampled(double cutoff, double thinning, std::uint32_t seed = 1) {
  BeamPolicy policy;
  policy.cutoff = cutoff;
  policy.population_control = PopulationControl{.seed = seed, .replicates = 16, .survivor_power_ratio = thinning};
  return policy;
}

/// Maximum truncated power of the reference. It is added to the bounds.
const double kTruncated = test::sample_size(4e-5, 1e-5);

/// Returns the ledgers, one per cone, of a trace in which the truncated power is at most kTruncated.
std::vector<Ledger> references(const Question& question, const Optics& optics, const std::vector<double>& cones_deg) {
  BeamPolicy policy;
  policy.truncated_goal = kTruncated;
  return BeamTracer(question.part).trace(optics, question.light, cones_deg, policy).ledgers;
}

TEST(PopulationControl, AgreeWithBeamsAndBookAllPower) {
  Optics optics = pmma();
  optics.absorption_per_mm = 0.01;
  for (const Question& question : questions()) {
    const std::vector<double> cones = {0.5, 60.0};
    const BeamResult result = BeamTracer(question.part).trace(optics, question.light, cones, resampled(1e-4, 4.0));
    ASSERT_TRUE(result.complete) << question.name;
    const std::vector<Ledger> exact_of_cones = references(question, optics, cones);
    for (std::size_t cone = 0; cone < cones.size(); ++cone) {
      const Ledger& own = result.ledgers[cone];
      EXPECT_NEAR(own.total(), 1.0, 1e-13) << question.name;
      EXPECT_NEAR(own[Account::truncated], 0.0, 1e-12) << question.name;
      const Ledger& exact = exact_of_cones[cone];
      EXPECT_GT(result.std_error[cone], 0.0) << question.name;
      EXPECT_NEAR(own[Account::retroreflected], exact[Account::retroreflected],
                  student_bound(8, 16) * result.std_error[cone] + kTruncated)
          << question.name << ", cone " << cones[cone];
      EXPECT_NEAR(result.stokes[cone].i, own[Account::retroreflected], 1e-13) << question.name;
      for (const Account account : {Account::transmitted, Account::absorbed, Account::side_exit})
        EXPECT_NEAR(own[account], exact[account], 1e-3) << question.name << ", " << static_cast<int>(account);
    }
  }
}

/// Expects that the mean is unbiased and that 1.96 standard errors contain the true value in 88 of 100 results. With
/// fewer seeds, the observed fraction has a larger standard error, so that `min_coverage` lowers the required fraction.
TEST(PopulationControl, AreUnbiasedAndIntervalsHoldOverSeeds) {
  const std::uint32_t seeds = test::sample_size(20U, 100U);
  const double cutoff = test::sample_size(3e-4, 1e-4);
  for (const Question& question : questions()) {
    const Ledger exact = references(question, pmma(), {0.5})[0];
    const double error = 0.5 * exact[Account::truncated];
    const double truth = exact[Account::retroreflected] + error;
    const BeamTracer tracer(question.part);
    std::vector<BeamResult> found(seeds);
    for_each_in_parallel(seeds, [&](std::size_t k) {
      found[k] = tracer.trace(pmma(), question.light, {0.5}, resampled(cutoff, 8.0, static_cast<std::uint32_t>(k + 1)));
    });
    double mean = 0.0;
    double squares = 0.0;
    int hits = 0;
    for (const BeamResult& one : found) {
      const double off = one.ledgers[0][Account::retroreflected] - truth;
      mean += off / seeds;
      squares += std::pow(off / seeds, 2.0);
      if (std::abs(off) <= 1.96 * one.std_error[0] + error) ++hits;
    }
    // Both sides of the inequality are computed from deviations from the true value. The ratio of both sides
    // therefore has lighter tails than a normal distribution, and the bound is valid for any number of seeds.
    EXPECT_LE(std::abs(mean), normal_bound(4) * std::hypot(std::sqrt(squares), error)) << question.name;
    EXPECT_GE(hits, test::min_coverage(0.88, 100.0, seeds) * seeds) << question.name;
    ::testing::Test::RecordProperty(question.name + " of " + std::to_string(seeds), hits);
  }
}

/// The beams above the cut-off are the same as in a run that truncates weak beams. The sum of the powers of all
/// returned beams must equal the returned light of the ledger. The beams of the 16 replicates have the weight 1/16 in
/// this sum.
TEST(PopulationControl, LeaveStrongBeamsAsTheyAre) {
  for (const Question& question : questions()) {
    const BeamTracer tracer(question.part);
    std::vector<ReturnedBeam> strong;
    std::vector<ReturnedBeam> all;
    BeamPolicy policy = resampled(1e-4, 32.0);
    const BeamResult result = tracer.trace(pmma(), question.light, {0.5}, policy, nullptr,
                                           [&](const ReturnedBeam& beam) { all.push_back(beam); });
    policy.population_control.reset();
    const BeamResult plain = tracer.trace(pmma(), question.light, {0.5}, policy, nullptr,
                                          [&](const ReturnedBeam& beam) { strong.push_back(beam); });
    EXPECT_EQ(plain.std_error[0], 0.0);
    EXPECT_GT(plain.ledgers[0][Account::truncated], 1e-4) << question.name;
    double power = 0.0;
    std::size_t exact = 0;
    for (const ReturnedBeam& beam : all) {
      power += beam.stokes.i / (beam.replicate ? 16.0 : 1.0);
      if (beam.replicate) {
        EXPECT_LT(*beam.replicate, 16U);
        continue;
      }
      ASSERT_LT(exact, strong.size());
      EXPECT_EQ(beam.stokes.i, strong[exact].stokes.i);
      EXPECT_EQ(beam.phase_mm, strong[exact].phase_mm);
      EXPECT_EQ(beam.exit_polygon_mm, strong[exact].exit_polygon_mm);
      ++exact;
    }
    EXPECT_EQ(exact, strong.size()) << question.name;
    EXPECT_GT(all.size(), exact) << question.name;
    const Ledger& ledger = result.ledgers[0];
    EXPECT_NEAR(power,
                ledger[Account::retroreflected] + ledger[Account::front_specular] + ledger[Account::returned_elsewhere],
                1e-12)
        << question.name;
  }
}

/// If no beam is resampled, the standard error is 0.
TEST(PopulationControl, NothingIsLeftToChanceWhereBeamsEnd) {
  const Part part = build_part(single(RtpElement{0.6, 0.4, 90.0}, 0.7));
  const BeamResult result = BeamTracer(part).trace(ideal(), from(0.0), {0.5}, resampled(1e-3, 32.0));
  EXPECT_NEAR(result.ledgers[0][Account::retroreflected], 1.0, 1e-12);
  EXPECT_EQ(result.std_error[0], 0.0);
}

TEST(PopulationControl, StopWhenCancelled) {
  const Question question = questions()[1];
  Cancellation cancel;
  cancel.request();
  EXPECT_FALSE(BeamTracer(question.part).trace(pmma(), question.light, {0.5}, resampled(1e-4, 32.0), &cancel).complete);
}

using Seen = TracedFarField;

Seen seen(const Question& question, const BeamPolicy& beams, const FarFieldPolicy& policy) {
  BeamPolicy by_cell = beams;
  by_cell.separate_cells = true;
  return traced_far_field(question.part, pmma(), question.light, policy, by_cell);
}

/// Returns directions of receivers around the direction to the light.
std::vector<Vec3> receivers(const Illumination& light) {
  const ReturnFrame frame = frame_at(light);
  std::vector<Vec3> directions;
  for (const double angle_deg : {0.0, 0.2, 0.5})
    for (const double turn_deg : {20.0, 110.0, 250.0})
      directions.push_back(
          frame.direction(angle_deg * kDeg * Vec2(std::cos(turn_deg * kDeg), std::sin(turn_deg * kDeg))));
  return directions;
}

Question wide_cubes() {
  PartSpec spec = infinite(HexagonalCube{1.0}, Arrangement::honeycomb, 1.0);
  spec.angle_errors.dihedral_error_arcmin = {1.0, 2.0, 3.0};
  return {"wide cubes", build_part(spec), from(20, 10)};
}

/// Without interference, intensities are unbiased: their mean over many seeds equals the result of a trace with a lower
/// cut-off. The reported errors agree with the spread over the seeds.
TEST(PopulationControl, FarFieldIsUnbiased) {
  constexpr std::uint32_t kSeeds = 60;
  const Question question = wide_cubes();
  FarFieldPolicy policy;
  policy.diffraction = false;
  BeamPolicy further;
  further.cutoff = 1e-7;
  const Seen truth = seen(question, further, policy);
  const ApertureKernel kernel({Angle::from_deg(0.5), Angle::from_deg(0.5)});
  const std::vector<Vec3> directions = receivers(question.light);
  std::vector<std::vector<FarFieldIntensity>> found(kSeeds);
  for_each_in_parallel(kSeeds, [&](std::size_t k) {
    const Seen own = seen(question, resampled(1e-3, 8.0, static_cast<std::uint32_t>(k + 1)), policy);
    EXPECT_NEAR(own.field.total_power(), own.result.ledgers[0].total() - own.result.ledgers[0][Account::transmitted],
                1e-10);
    for (const Vec3& direction : directions) found[k].push_back(own.field.intensity(direction, kernel));
  });
  for (std::size_t at = 0; at < directions.size(); ++at) {
    const FarFieldIntensity expected = truth.field.intensity(directions[at], kernel);
    EXPECT_EQ(expected.error_per_sr, 0.0);
    double mean = 0.0;
    double squares = 0.0;
    double told = 0.0;
    for (const auto& one : found) {
      const double off = one[at].per_sr - expected.per_sr;
      mean += off / kSeeds;
      squares += off * off / kSeeds;
      told += one[at].error_per_sr * one[at].error_per_sr / kSeeds;
    }
    const double left = kernel.per_sr(0.0) * truth.result.ledgers[0][Account::truncated];
    EXPECT_LE(std::abs(mean), normal_bound(9) * std::sqrt(squares / kSeeds) + left) << at;
    // Reported errors from 16 replicates are 9 % larger than the standard deviation, because of Student's t
    // distribution.
    EXPECT_NEAR(std::sqrt(told), std::sqrt(squares), 0.35 * std::sqrt(squares) + left) << at;
  }
}

/// Resampled light does not interfere with other light. The effect on the diffracted far field is small.
TEST(PopulationControl, DiffractedFarFieldAgreesWithBeams) {
  const ApertureKernel kernel({Angle::from_deg(10.0 / 60.0), Angle::from_deg(10.0 / 60.0)});
  const Question question = wide_cubes();
  BeamPolicy further;
  further.cutoff = 1e-7;
  const Seen truth = seen(question, further, {});
  const Seen own = seen(question, resampled(1e-5, 32.0), {});
  EXPECT_NEAR(own.field.total_power(), truth.field.total_power(), 1e-4 + truth.result.ledgers[0][Account::truncated]);
  std::size_t weak = 0;
  for (const CoherentGroup& group : own.field.groups())
    if (group.replicate) ++weak;
  EXPECT_GT(weak, 0U) << "resampled light is diffracted as well";
  for (const Vec3& direction : receivers(question.light)) {
    const FarFieldIntensity found = own.field.intensity(direction, kernel);
    const double expected = truth.field.intensity(direction, kernel).per_sr;
    EXPECT_GT(found.error_per_sr, 0.0);
    EXPECT_LT(found.error_per_sr, 2e-3 * expected);
    EXPECT_NEAR(found.per_sr, expected, student_bound(9, 16) * found.error_per_sr + 1e-3 * expected);
  }
}

/// All integrals of a far field contain the resampled light. The sum over bins, and the power inside and outside of a
/// cone, must equal the total power.
TEST(PopulationControl, SumsOverDirectionsHoldAllReplicates) {
  const Question question = wide_cubes();
  const BeamPolicy beams = resampled(1e-4, 32.0);
  FarFieldPolicy geometric;
  geometric.diffraction = false;
  const Seen rays = seen(question, beams, geometric);
  const Seen own = seen(question, beams, {});
  const ReturnFrame frame = frame_at(question.light);
  const std::vector<double> bins = rays.field.binned(frame, {DirectionGrid::Layout::square, 0.03, 30, 30});
  double sum = 0.0;
  for (const double bin : bins) sum += bin;
  EXPECT_NEAR(sum, rays.field.total_power(), 1e-12);
  EXPECT_NEAR(own.field.total_power(), rays.field.total_power(), 1e-12);
  const FarField::Split split = own.field.split(frame, 0.035);
  EXPECT_NEAR(split.inside + split.outside, own.field.total_power(), 1e-3);
}

TEST(Replicates, AreFewerThanNormal) {
  for (const std::size_t count : {4U, 8U, 16U, 32U, 1000U})
    EXPECT_NEAR(student_factor(count), student_bound_of(0.05, count) / 1.959964, count < 8 ? 2e-2 : 1e-3) << count;
}

}  // namespace
}  // namespace retrace::testing::weak_beams_test
