// Tests of `retrace rre --derivatives`: its output and the options that it requires.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/app/program.h"
#include "tests/support/refusals.h"

namespace retrace::test::derivatives_test {
namespace {

const std::string kDesign = example("rtp_single_0p45mm.toml");

Arguments with_derivatives(const Arguments& more) {
  Arguments arguments = {
      "rre", kDesign, "--engine=exact", "--derivatives", "--incidence=0,-11", "--set", "body.absorption_per_mm=0.5"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

TEST(Derivatives, AreObjectsByParameterOfEveryPoint) {
  const TemporaryFolder folder;
  const Json json = retrace_json(folder, with_derivatives({"--set", "detector.acceptance_half_angle_deg=[0.5,1]"}));
  ASSERT_EQ(json["points"].size(), 4U);
  for (const Json& point : json["points"]) {
    Arguments names;
    for (const auto& [name, entry] : point["derivatives"].items()) {
      names.push_back(name);
      if (entry.contains("left_out")) continue;
      const double value = entry["value"].get<double>();
      EXPECT_LE(entry["error"].get<double>(), 1e-3 * std::abs(value) + 1e-6) << name;
    }
    EXPECT_EQ(names, (Arguments{"size_mm", "apex_angle_deg", "refractive_index", "thickness_mm", "incidence_deg"}));
  }
  const Json& left_out = json["points"][0]["derivatives"]["incidence_deg"];
  ASSERT_EQ(left_out.size(), 1U);
  record_message(left_out.at("left_out").get<std::string>());
  EXPECT_TRUE(json["points"][2]["derivatives"]["incidence_deg"].contains("value"));
}

TEST(Derivatives, AreLeftOutUnasked) {
  const TemporaryFolder folder;
  const Json json = retrace_json(folder, {"rre", kDesign, "--engine=exact"});
  EXPECT_FALSE(json["points"][0].contains("derivatives"));
}

TEST(Derivatives, CubeCornersHaveADihedralError) {
  const TemporaryFolder folder;
  const Json json = retrace_json(folder, {"rre", example("honeycomb_infinite.toml"), "--engine=exact", "--cutoff=1e-6",
                                          "--derivatives", "--set", "idealisation.facets=mirror", "--set",
                                          "idealisation.entrance=lossless", "--incidence=25", "--azimuth=10"});
  EXPECT_TRUE(json["points"][0]["derivatives"].contains("dihedral_error_deg"));
  EXPECT_FALSE(json["points"][0]["derivatives"].contains("apex_angle_deg"));
}

TEST(Derivatives, AreTheSameAtAnyNumberOfThreads) {
  const TemporaryFolder folder;
  const Outcome one = retrace(folder, with_derivatives({"--json", "-", "--threads=1"}));
  ASSERT_EQ(one.code, 0) << one.err;
  for (const char* threads : {"2", "7"})
    EXPECT_EQ(without_elapsed(retrace(folder, with_derivatives({"--json", "-", "--threads", threads})).out),
              without_elapsed(one.out));
}

TEST(Derivatives, StandInATableToo) {
  const TemporaryFolder folder;
  const Outcome outcome = retrace(folder, with_derivatives({}));
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(lines_of(outcome.out).size(), 16U);
  const Json json = retrace_json(folder, with_derivatives({}));
  const Json& reason = json["points"][0]["derivatives"]["incidence_deg"]["left_out"];
  EXPECT_NE(outcome.out.find(reason.get<std::string>()), std::string::npos);
}

TEST(Derivatives, NeedTheExactEngine) {
  const TemporaryFolder folder;
  for (const char* engine : {"montecarlo", "embree"}) {
    const Outcome outcome = retrace(folder, {"rre", kDesign, "--derivatives", "--engine", engine});
    EXPECT_EQ(refused_at(outcome), "--derivatives");
  }
}

}  // namespace
}  // namespace retrace::test::derivatives_test
