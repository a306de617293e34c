// `mpirun -np 3 retrace sweep`: the same table as alone, whatever becomes of a rank.

#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <string>
#include <thread>

#include "tests/app/program.h"
#include "tests/sweep/stored_points.h"

namespace retrace::test {
namespace {

namespace fs = std::filesystem;

/// Starts the program on three ranks, each of which leaves its number as a process in a file.
Arguments on_three_ranks(const std::string& arguments, const std::string& options = "") {
  return {"/bin/sh", "-c",
          "export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_plm=isolated; exec '" +
              std::string(RETRACE_MPIRUN) + "' --oversubscribe --bind-to none " + options +
              " -np 3 sh -c 'echo $$ >pid.$OMPI_COMM_WORLD_RANK; exec \"$0\" \"$@\"' '" + RETRACE_PROGRAM + "' sweep " +
              arguments};
}

class SweepByMpi : public testing::Test {
 protected:
  void write_study(int points) { folder_.write("study.toml", sweep_study(points)); }
  std::string alone() {
    const Outcome outcome =
        Child(folder_.path(), {RETRACE_PROGRAM, "sweep", "study.toml", "-o", "alone", "--quiet"}).wait();
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return folder_.read("alone/sweep.csv");
  }
  std::size_t stored() const { return stored_points(folder_.path() / "out/sweep.sqlite").size(); }
  /// Kills a rank once some points are stored.
  void kill_rank(int rank) {
    while (stored() < 10) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    ASSERT_EQ(::kill(std::stoi(folder_.read("pid." + std::to_string(rank))), SIGKILL), 0);
  }

  TemporaryFolder folder_;
};

TEST_F(SweepByMpi, ThreeRanksMakeTheSameTable) {
  write_study(90);
  const std::string expected = alone();
  const Outcome outcome = Child(folder_.path(), on_three_ranks("study.toml -o out --quiet")).wait();
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(folder_.read("out/sweep.csv"), expected);
}

TEST_F(SweepByMpi, WhenARankDiesWhatIsFinishedIsStoredAndAResumeCompletesIt) {
  write_study(250);
  {
    Child child(folder_.path(), on_three_ranks("study.toml -o out --quiet"));
    kill_rank(1);
    EXPECT_NE(child.wait().code, 0);
  }
  const auto before = stored_points(folder_.path() / "out/sweep.sqlite");
  EXPECT_GE(before.size(), 10U);
  EXPECT_LT(before.size(), 250U);
  const Outcome outcome = Child(folder_.path(), on_three_ranks("study.toml -o out --quiet --resume")).wait();
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  const auto after = stored_points(folder_.path() / "out/sweep.sqlite");
  for (const auto& [point, elapsed_s] : before) EXPECT_EQ(after.at(point), elapsed_s) << "computed again: " << point;
  EXPECT_EQ(folder_.read("out/sweep.csv"), alone());
}

TEST_F(SweepByMpi, WithRecoveryTheOtherRanksGoOn) {
  write_study(250);
  Child child(folder_.path(), on_three_ranks("study.toml -o out", "--enable-recovery"));
  kill_rank(2);
  const Outcome outcome = child.wait();
  EXPECT_EQ(folder_.read("out/sweep.csv"), alone());
  EXPECT_EQ(folder_.json("out/sweep.json")["complete"], true);
  EXPECT_NE(outcome.err.find("rank 2 was silent"), std::string::npos) << outcome.err;
}

TEST_F(SweepByMpi, WhatIsWrongIsSaidOnce) {
  folder_.write("study.toml", "design = 3\n");
  const Outcome outcome = Child(folder_.path(), on_three_ranks("study.toml -o out")).wait();
  EXPECT_EQ(outcome.code, 2);
  const std::vector<std::string> lines = lines_of(outcome.err);
  const auto count = std::count_if(lines.begin(), lines.end(),
                                   [](const std::string& line) { return line.starts_with("retrace: study.toml: "); });
  EXPECT_EQ(count, 1) << outcome.err;
}

}  // namespace
}  // namespace retrace::test
