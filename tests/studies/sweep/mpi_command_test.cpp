// Tests of `mpirun -np 3 retrace sweep`. The table is the same as that of a single process, even if a rank is killed or
// interrupted.

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "tests/studies/sweep/mpi_run.h"
#include "tests/studies/sweep/stored_points.h"

namespace retrace::test::mpi_command_test {
namespace {

Arguments on_three_ranks(const std::string& arguments, const std::string& options = "") {
  return on_ranks(3, "sweep " + arguments, options);
}

class SweepByMpi : public ByMpi {
 protected:
  void write_study(int points) { folder_.write("study.toml", sweep_study(points)); }
  std::string alone() {
    const Outcome outcome =
        Child(folder_.path(), {RETRACE_PROGRAM, "sweep", "study.toml", "-o", "alone", "--quiet"}).wait(kMpiLimit);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return folder_.read("alone/sweep.csv");
  }
  std::size_t stored() const { return stored_points(folder_.path() / "out/sweep.sqlite").size(); }
  /// Kills a rank during the computation, after some points have been stored.
  void kill_rank(const Child& child, int rank) {
    ASSERT_TRUE(comes_about(child, [this] { return stored() >= 10; })) << "no points were stored";
    ASSERT_TRUE(is_running(rank)) << "the sweep was over too soon";
    ASSERT_EQ(::kill(process_of(rank), SIGKILL), 0);
  }
};

TEST_F(SweepByMpi, ThreeRanksMakeTheSameTable) {
  write_study(90);
  const std::string expected = alone();
  const Outcome outcome = Child(folder_.path(), on_three_ranks("study.toml -o out --quiet")).wait(kMpiLimit);
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(folder_.read("out/sweep.csv"), expected);
}

TEST_F(SweepByMpi, WhenARankDiesWhatIsFinishedIsStoredAndAResumeCompletesIt) {
  write_study(250);
  {
    Child child(folder_.path(), on_three_ranks("study.toml -o out --quiet"));
    kill_rank(child, 1);
    EXPECT_NE(child.wait(kMpiLimit).code, 0);
  }
  const auto before = stored_points(folder_.path() / "out/sweep.sqlite");
  EXPECT_GE(before.size(), 10U);
  EXPECT_LT(before.size(), 250U);
  const Outcome outcome = Child(folder_.path(), on_three_ranks("study.toml -o out --quiet --resume")).wait(kMpiLimit);
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  const auto after = stored_points(folder_.path() / "out/sweep.sqlite");
  for (const auto& [point, elapsed_s] : before) EXPECT_EQ(after.at(point), elapsed_s) << "computed again: " << point;
  EXPECT_EQ(folder_.read("out/sweep.csv"), alone());
}

TEST_F(SweepByMpi, WithRecoveryTheOtherRanksGoOn) {
  write_study(250);
  Child child(folder_.path(), on_three_ranks("study.toml -o out", "--enable-recovery"));
  kill_rank(child, 2);
  EXPECT_TRUE(ends(0)) << "rank 0 hangs";
  EXPECT_TRUE(ends(1)) << "rank 1 hangs";
  const Outcome outcome = child.wait(kMpiLimit);
  EXPECT_EQ(folder_.read("out/sweep.csv"), alone());
  EXPECT_EQ(folder_.json("out/sweep.json")["complete"], true);
  EXPECT_NE(outcome.err.find("rank 2 "), std::string::npos) << outcome.err;
}

TEST_F(SweepByMpi, WithoutRankZeroTheOthersEnd) {
  write_study(250);
  Child child(folder_.path(), on_three_ranks("study.toml -o out --quiet", "--enable-recovery"));
  kill_rank(child, 0);
  EXPECT_TRUE(ends(1)) << "rank 1 hangs";
  EXPECT_TRUE(ends(2)) << "rank 2 hangs";
  child.wait(kMpiLimit);
  const Outcome outcome =
      Child(folder_.path(), {RETRACE_PROGRAM, "sweep", "study.toml", "-o", "out", "--quiet", "--resume"})
          .wait(kMpiLimit);
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(folder_.read("out/sweep.csv"), alone());
}

TEST_F(SweepByMpi, NoIsTheAnswerIfEveryPointFailed) {
  folder_.write("study.toml", "design = \"" + example("honeycomb_infinite.toml") +
                                  "\"\n[[parameter]]\nkey = \"body.thickness_mm\"\nvalues = [-1, -2, -3, -4]\n"
                                  "[[quantity]]\nkind = \"rre\"\n");
  const Outcome outcome = Child(folder_.path(), on_three_ranks("study.toml -o out --quiet")).wait(kMpiLimit);
  EXPECT_EQ(outcome.code, 1);
  EXPECT_EQ(refusals_in(outcome), 1) << outcome.err;
}

TEST_F(SweepByMpi, WhatIsWrongIsSaidOnce) {
  folder_.write("study.toml", "design = 3\n");
  const Outcome outcome = Child(folder_.path(), on_three_ranks("study.toml -o out")).wait(kMpiLimit);
  EXPECT_EQ(outcome.code, 2);
  const std::vector<std::string> lines = lines_of(outcome.err);
  const auto count = std::count_if(lines.begin(), lines.end(),
                                   [](const std::string& line) { return line.starts_with("retrace: study.toml:"); });
  EXPECT_EQ(count, 1) << outcome.err;
}

}  // namespace
}  // namespace retrace::test::mpi_command_test
