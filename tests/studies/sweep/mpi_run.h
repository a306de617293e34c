#pragma once

// Runs the program as ranks of an MPI job, and observes their processes.

#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <fstream>
#include <string>
#include <thread>

#include "tests/app/program.h"

namespace retrace::test {

/// Maximum time that tests wait for an event of an MPI job.
inline constexpr std::chrono::seconds kMpiLimit = patient(60);
/// Time, in s, without messages after which a rank is given up.
inline constexpr int kMpiSilenceS = 3;

/// Returns how many lines of a run by several ranks report why it was refused. mpiexec also writes lines, and
/// interrupts the other ranks as soon as one rank has ended with an error.
inline std::ptrdiff_t refusals_in(const Outcome& outcome) {
  return std::ranges::count_if(lines_of(outcome.err), [](const std::string& line) {
    return line.starts_with("retrace: ") && !line.starts_with("retrace: interrupted");
  });
}

/// Returns the command that runs the program on several ranks. Each rank writes its process number to a file.
/// \param options options of mpirun
inline Arguments on_ranks(int ranks, const std::string& arguments, const std::string& options = "") {
  return {"/bin/sh", "-c",
          "export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_plm=isolated "
          // Leaks of Open MPI itself are not errors of this program.
          "ASAN_OPTIONS=detect_leaks=0 RETRACE_MPI_SILENCE_S=" +
              std::to_string(kMpiSilenceS) + "; exec '" + std::string(RETRACE_MPIRUN) +
              "' --oversubscribe --bind-to none " + options + " -np " + std::to_string(ranks) +
              " sh -c 'echo $$ >pid.$OMPI_COMM_WORLD_RANK; exec \"$0\" \"$@\"' '" + RETRACE_PROGRAM + "' " + arguments};
}

class ByMpi : public ::testing::Test {
 protected:
  /// Kills all ranks that still run, even if a test has failed.
  ~ByMpi() override {
    for (int rank = 0; rank < 3; ++rank)
      if (const pid_t process = process_of(rank); process > 0 && is_running(rank)) ::kill(process, SIGKILL);
  }

  /// Returns the process number of a rank, or 0 if the rank has not started.
  pid_t process_of(int rank) const {
    std::ifstream file(folder_.path() / ("pid." + std::to_string(rank)));
    pid_t process = 0;
    return file >> process ? process : 0;
  }
  /// Returns true if a rank runs. A zombie process, which has ended without having been waited for, does not count.
  bool is_running(int rank) const {
    std::ifstream file("/proc/" + std::to_string(process_of(rank)) + "/stat");
    std::string line;
    if (!std::getline(file, line)) return false;
    const std::size_t name_end = line.rfind(") ");
    return name_end != std::string::npos && line[name_end + 2] != 'Z' && line.find("(retrace)") != std::string::npos;
  }
  /// Waits for a condition that must become true while `child` runs.
  /// \return true if the condition became true in time
  template <class Condition>
  static bool comes_about(const Child& child, Condition condition) {
    const auto deadline = std::chrono::steady_clock::now() + kMpiLimit;
    while (!condition()) {
      if (child.has_ended() || std::chrono::steady_clock::now() > deadline) return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return true;
  }
  /// Returns true if a rank ends in time. The process mpirun may continue to run.
  bool ends(int rank) const {
    const auto deadline = std::chrono::steady_clock::now() + kMpiLimit;
    while (is_running(rank) && std::chrono::steady_clock::now() < deadline)
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    return !is_running(rank);
  }

  TemporaryFolder folder_;
};

}  // namespace retrace::test
