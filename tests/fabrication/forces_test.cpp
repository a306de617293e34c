#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "core/atomic_file.h"
#include "core/error.h"
#include "fabrication/forces/forces.h"
#include "fabrication/forces/io/force_table.h"
#include "tests/support/refusals.h"

namespace retrace::fabrication::forces_test {
namespace {

std::vector<MeasuredForce> table() {
  return parse_forces(read_file(std::string(RETRACE_SOURCE_DIR) + "/data/cutting_forces.csv"), "cutting_forces.csv");
}

/// Returns the cut of experiment 1 on a prism of 1 mm. At a depth of 5 um, it is the third last of 142 cuts. At 10 um,
/// it is the second last of 71 cuts. Both cuts are 0.697 mm long.
CutConditions experiment_1(double depth_um) {
  CutConditions cut;
  cut.depth_of_cut_um = depth_um;
  cut.width_mm = 0.982;
  cut.plunge_mm = (5.23 - 1.0) * 10.0 / 60.0;  // duration as recorded, including accelerations and rounding
  cut.plough_mm = 0.25;
  return cut;
}

CutConditions experiment_2() {
  CutConditions cut = experiment_1(5);
  cut.width_mm = 0.818;
  cut.configuration = Configuration::orthogonal;
  return cut;
}

/// Experiment 2 was not used for the calibration. The model predicts the measured force at full chip load. It does not
/// predict the measured peaks, and is not tuned to them.
TEST(Forces, ExperimentTwoIsPredicted) {
  const ForceEvents two = force_events(calibrate(table()), experiment_2());
  EXPECT_NEAR(two.full_chip_fz_n, -1.31, 0.005);
  EXPECT_NEAR(two.full_chip_fz_n, -1.29, 0.02 * 1.29) << "measured";
  EXPECT_EQ(two.before_root_fz_n, two.full_chip_fz_n) << "nothing rubs";
  EXPECT_EQ(two.root_fx_n, 0.0);
  EXPECT_NEAR(two.root_fz_n, -2.62, 0.005) << "measured -4.06";
  EXPECT_NEAR(two.peak_fy_n, -2.77, 0.005) << "measured -1.73";
}

/// Times of the events in Figure 4.8 of the thesis, in s: contact 1.00, full chip 1.07, before the root 5.18, root
/// 5.23, begin of ploughing 5.33, peak of ploughing 5.36.
TEST(Forces, ProfileOverTheEventsOfTheThesis) {
  CutConditions cut = experiment_1(5);
  cut.clearance_mm = 10.0 / 60.0;  // the tool crosses this clearance in one second
  const std::vector<ForceSample> profile = force_profile(calibrate(table()), cut);
  const auto at = [&](double time_s, auto force) {
    for (std::size_t i = 1; i < profile.size(); ++i)
      if (profile[i].time_s >= time_s - 1e-9 && profile[i].time_s > profile[i - 1].time_s) {
        const double t = (time_s - profile[i - 1].time_s) / (profile[i].time_s - profile[i - 1].time_s);
        return force(profile[i - 1]) * (1 - t) + force(profile[i]) * t;
      }
    return 0.0;
  };
  const auto fz = [](const ForceSample& s) { return s.fz_n; };
  const auto fy = [](const ForceSample& s) { return s.fy_n; };
  EXPECT_EQ(at(0.5, fz), 0.0);
  EXPECT_NEAR(at(1.07, fz), -1.57, 1e-6);
  EXPECT_NEAR(at(1.16, fy), -0.66, 1e-6);
  EXPECT_NEAR(at(5.18, fz), -3.76, 1e-6);
  EXPECT_NEAR(at(5.23, fz), -5.34, 1e-6);
  EXPECT_NEAR(at(5.30, fy), -0.66, 1e-6) << "Y stays level until the plough";
  EXPECT_NEAR(at(5.36, fy), -3.33, 1e-6);
  EXPECT_EQ(profile.back().fz_n, 0.0);
  EXPECT_TRUE(std::is_sorted(profile.begin(), profile.end(),
                             [](const ForceSample& a, const ForceSample& b) { return a.time_s < b.time_s; }));
}

TEST(Forces, WarnsWhereTheLinearLawIsNotShown) {
  const ForceModel model = calibrate(table());
  const auto warnings_at = [&](double depth) { return facts_of(force_warnings(model, experiment_1(depth))).size(); };
  EXPECT_EQ(warnings_at(4.9), 2U);
  EXPECT_EQ(warnings_at(5.0), 1U);
  EXPECT_EQ(warnings_at(15.0), 2U);
}

TEST(Forces, BadTablesAreRefused) {
  const auto refusal = [](const std::string& text) -> std::string {
    return refusal_of([&] { parse_forces(text, "f.csv"); }, "accepted");
  };
  const std::string columns = "experiment,strategy,configuration,doc_um,width_mm,event,time_s,fx_n,fy_n,fz_n";
  const std::string header = columns + "\n";
  EXPECT_EQ(refusal(""), "f.csv");
  EXPECT_EQ(refusal(header), "f.csv");
  EXPECT_EQ(refusal(header + "1,a,b,5,1,root,,,\n"), "f.csv:2");
  EXPECT_EQ(refusal(header + "1,a,b,0,1,root,,,,1\n"), "f.csv:2: doc_um");
  EXPECT_EQ(refusal(header + "1,a,b,5,1,root,,,,x\n"), "f.csv:2: fz_n");
  EXPECT_THROW(calibrate(parse_forces(header + "1,a,b,5,1,root,,,,1\n", "f.csv")), InputError);
}

}  // namespace
}  // namespace retrace::fabrication::forces_test
