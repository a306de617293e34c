// `mpirun -np 3 retrace sweep`: the same table as alone, whatever becomes of a rank.

#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>

#include "tests/app/program.h"
#include "tests/studies/sweep/stored_points.h"

namespace retrace::test::mpi_command_test {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::seconds kLimit{60};
/// A rank that is silent for so long is given up.
constexpr int kSilenceS = 3;

/// Starts the program on three ranks, each of which leaves its number as a process in a file.
Arguments on_three_ranks(const std::string& arguments, const std::string& options = "") {
  return {"/bin/sh", "-c",
          "export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_plm=isolated "
          "RETRACE_MPI_SILENCE_S=" +
              std::to_string(kSilenceS) + "; exec '" + std::string(RETRACE_MPIRUN) +
              "' --oversubscribe --bind-to none " + options +
              " -np 3 sh -c 'echo $$ >pid.$OMPI_COMM_WORLD_RANK; exec \"$0\" \"$@\"' '" + RETRACE_PROGRAM + "' sweep " +
              arguments};
}

class SweepByMpi : public ::testing::Test {
 protected:
  /// No rank is left behind, whatever becomes of a test.
  ~SweepByMpi() override {
    for (int rank = 0; rank < 3; ++rank)
      if (const pid_t process = process_of(rank); process > 0 && is_running(rank)) ::kill(process, SIGKILL);
  }

  void write_study(int points) { folder_.write("study.toml", sweep_study(points)); }
  std::string alone() {
    const Outcome outcome =
        Child(folder_.path(), {RETRACE_PROGRAM, "sweep", "study.toml", "-o", "alone", "--quiet"}).wait(kLimit);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return folder_.read("alone/sweep.csv");
  }
  std::size_t stored() const { return stored_points(folder_.path() / "out/sweep.sqlite").size(); }

  /// 0 if the rank has not started.
  pid_t process_of(int rank) const {
    std::ifstream file(folder_.path() / ("pid." + std::to_string(rank)));
    pid_t process = 0;
    return file >> process ? process : 0;
  }
  /// Whether the rank runs; a process that has ended and that nobody has asked after does not.
  bool is_running(int rank) const {
    std::ifstream file("/proc/" + std::to_string(process_of(rank)) + "/stat");
    std::string line;
    if (!std::getline(file, line)) return false;
    const std::size_t name_end = line.rfind(") ");
    return name_end != std::string::npos && line[name_end + 2] != 'Z' && line.find("(retrace)") != std::string::npos;
  }
  /// Waits for something that must come about while `child` runs. \return whether it has
  template <class Condition>
  static bool comes_about(const Child& child, Condition condition) {
    const auto deadline = std::chrono::steady_clock::now() + kLimit;
    while (!condition()) {
      if (child.has_ended() || std::chrono::steady_clock::now() > deadline) return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return true;
  }
  /// Kills a rank at work, once some points are stored.
  void kill_rank(const Child& child, int rank) {
    ASSERT_TRUE(comes_about(child, [this] { return stored() >= 10; })) << "no points were stored";
    ASSERT_TRUE(is_running(rank)) << "the sweep was over too soon";
    ASSERT_EQ(::kill(process_of(rank), SIGKILL), 0);
  }
  /// Whether a rank has ended in time; mpirun may go on for reasons of its own.
  bool ends(int rank) const {
    const auto deadline = std::chrono::steady_clock::now() + kLimit;
    while (is_running(rank) && std::chrono::steady_clock::now() < deadline)
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    return !is_running(rank);
  }

  TemporaryFolder folder_;
};

TEST_F(SweepByMpi, ThreeRanksMakeTheSameTable) {
  write_study(90);
  const std::string expected = alone();
  const Outcome outcome = Child(folder_.path(), on_three_ranks("study.toml -o out --quiet")).wait(kLimit);
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(folder_.read("out/sweep.csv"), expected);
}

TEST_F(SweepByMpi, WhenARankDiesWhatIsFinishedIsStoredAndAResumeCompletesIt) {
  write_study(250);
  {
    Child child(folder_.path(), on_three_ranks("study.toml -o out --quiet"));
    kill_rank(child, 1);
    EXPECT_NE(child.wait(kLimit).code, 0);
  }
  const auto before = stored_points(folder_.path() / "out/sweep.sqlite");
  EXPECT_GE(before.size(), 10U);
  EXPECT_LT(before.size(), 250U);
  const Outcome outcome = Child(folder_.path(), on_three_ranks("study.toml -o out --quiet --resume")).wait(kLimit);
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
  const Outcome outcome = child.wait(kLimit);
  EXPECT_EQ(folder_.read("out/sweep.csv"), alone());
  EXPECT_EQ(folder_.json("out/sweep.json")["complete"], true);
  EXPECT_NE(outcome.err.find("rank 2 was silent for 3 s"), std::string::npos) << outcome.err;
}

TEST_F(SweepByMpi, WithoutRankZeroTheOthersEnd) {
  write_study(250);
  Child child(folder_.path(), on_three_ranks("study.toml -o out --quiet", "--enable-recovery"));
  kill_rank(child, 0);
  EXPECT_TRUE(ends(1)) << "rank 1 hangs";
  EXPECT_TRUE(ends(2)) << "rank 2 hangs";
  child.wait(kLimit);
  const Outcome outcome =
      Child(folder_.path(), {RETRACE_PROGRAM, "sweep", "study.toml", "-o", "out", "--quiet", "--resume"}).wait(kLimit);
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(folder_.read("out/sweep.csv"), alone());
}

TEST_F(SweepByMpi, NoIsTheAnswerIfEveryPointFailed) {
  folder_.write("study.toml", "design = \"" + example("honeycomb_infinite.toml") +
                                  "\"\n[[parameter]]\nkey = \"body.thickness_mm\"\nvalues = [-1, -2, -3, -4]\n"
                                  "[[quantity]]\nkind = \"rre\"\n");
  const Outcome outcome = Child(folder_.path(), on_three_ranks("study.toml -o out --quiet")).wait(kLimit);
  EXPECT_EQ(outcome.code, 1) << outcome.err;
  EXPECT_NE(outcome.err.find("retrace: every point failed, the first of 4: "), std::string::npos) << outcome.err;
}

TEST_F(SweepByMpi, WhatIsWrongIsSaidOnce) {
  folder_.write("study.toml", "design = 3\n");
  const Outcome outcome = Child(folder_.path(), on_three_ranks("study.toml -o out")).wait(kLimit);
  EXPECT_EQ(outcome.code, 2);
  const std::vector<std::string> lines = lines_of(outcome.err);
  const auto count = std::count_if(lines.begin(), lines.end(),
                                   [](const std::string& line) { return line.starts_with("retrace: study.toml:"); });
  EXPECT_EQ(count, 1) << outcome.err;
}

}  // namespace
}  // namespace retrace::test::mpi_command_test
