// Tests of designs with balls: commands that accept them, and commands that refuse them before anything is written.

#include <gtest/gtest.h>

#include "tests/app/program.h"

namespace retrace::test::balls_test {
namespace {

const std::string kBalls = example("beads_n193.toml");

TEST(Balls, CommandsThatTakeNoneSayWhichDo) {
  for (const Arguments& command : {Arguments{"image", kBalls, "--detector", "-o", "out"},
                                   {"image", kBalls, "--camera", "-o", "out"},
                                   {"image", kBalls, "--road", "-o", "out"},
                                   {"roughness", kBalls, "-o", "out"},
                                   {"export", kBalls, "out.stl"},
                                   {"job", kBalls, "--tool-width-mm=0.4", "-o", "out.toml"}}) {
    const TemporaryFolder folder;
    const Outcome outcome = retrace(folder, command);
    EXPECT_EQ(refused_at(outcome), "examples/beads_n193.toml:7: element.kind") << command[0];
    EXPECT_TRUE(folder.names().empty()) << command[0];
  }
}

TEST(Balls, RreWritesItsFiles) {
  const TemporaryFolder folder;
  const Outcome outcome = retrace(folder, {"rre", kBalls, "--incidence=0,40", "--samples=2048", "-o", "."});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const Json json = folder.json("rre.json");
  EXPECT_EQ(json["engine"], "balls");
  EXPECT_EQ(json["designs"][0]["element"]["kind"], "ball");
  EXPECT_EQ(json["points"].size(), 2U);
}

TEST(Balls, InspectWritesItsFile) {
  const TemporaryFolder folder;
  const Outcome outcome = retrace(folder, {"inspect", kBalls, "-o", "."});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(folder.names(), std::vector<std::string>{"inspect.json"});
  EXPECT_NEAR(folder.json("inspect.json")["packing_fraction"].get<double>(), 0.9069, 1e-4);
}

TEST(Balls, OtherEnginesAreRefused) {
  const TemporaryFolder folder;
  const Outcome outcome = retrace(folder, {"rre", kBalls, "--engine=exact"});
  EXPECT_EQ(refused_at(outcome), "--engine");
}

}  // namespace
}  // namespace retrace::test::balls_test
