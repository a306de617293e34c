#pragma once

// Runs of the program as ranks of a job under MPI, and what becomes of their processes.

#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <fstream>
#include <string>
#include <thread>

#include "tests/app/program.h"

namespace retrace::test {

/// For anything under MPI to come about.
inline constexpr std::chrono::seconds kMpiLimit = patient(60);
/// A rank that is silent for so long is given up.
inline constexpr int kMpiSilenceS = 3;

/// Starts the program on ranks, each of which leaves its number as a process in a file. \param options of mpirun
inline Arguments on_ranks(int ranks, const std::string& arguments, const std::string& options = "") {
  return {"/bin/sh", "-c",
          "export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_plm=isolated "
          // What Open MPI itself leaves behind is no leak of ours.
          "ASAN_OPTIONS=detect_leaks=0 RETRACE_MPI_SILENCE_S=" +
              std::to_string(kMpiSilenceS) + "; exec '" + std::string(RETRACE_MPIRUN) +
              "' --oversubscribe --bind-to none " + options + " -np " + std::to_string(ranks) +
              " sh -c 'echo $$ >pid.$OMPI_COMM_WORLD_RANK; exec \"$0\" \"$@\"' '" + RETRACE_PROGRAM + "' " + arguments};
}

class ByMpi : public ::testing::Test {
 protected:
  /// No rank is left behind, whatever becomes of a test.
  ~ByMpi() override {
    for (int rank = 0; rank < 3; ++rank)
      if (const pid_t process = process_of(rank); process > 0 && is_running(rank)) ::kill(process, SIGKILL);
  }

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
    const auto deadline = std::chrono::steady_clock::now() + kMpiLimit;
    while (!condition()) {
      if (child.has_ended() || std::chrono::steady_clock::now() > deadline) return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return true;
  }
  /// Whether a rank has ended in time; mpirun may go on for reasons of its own.
  bool ends(int rank) const {
    const auto deadline = std::chrono::steady_clock::now() + kMpiLimit;
    while (is_running(rank) && std::chrono::steady_clock::now() < deadline)
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    return !is_running(rank);
  }

  TemporaryFolder folder_;
};

}  // namespace retrace::test
