#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "core/atomic_file.h"

// Runs the interpreter of LinuxCNC on a program and parses the machine moves that it prints.

namespace retrace::fabrication::test {

/// One move that the interpreter has printed.
struct CanonicalMove {
  bool rapid = false;
  std::array<double, 6> at{};  ///< x, y, z, a, b, c
  double feed = 0.0;
  double dwell_s = 0.0;  ///< dwell after the move
};

/// Output of the interpreter and its exit status, which is 0 for an accepted program.
struct Interpretation {
  int status = 0;
  std::string out;
  std::string err;
};

/// Runs `rs274`, the interpreter of LinuxCNC, on a program. `rs274` writes its parameters into the working folder and a
/// file of tools into the home folder. Each process therefore uses a folder of its own, so that tests can run in
/// parallel.
inline Interpretation interpretation_of(const std::string& text) {
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("retrace_rs274_" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "p.ngc") << text;
  const std::string command = "cd '" + folder.string() + "' && HOME=. rs274 -g p.ngc > out.txt 2> err.txt < /dev/null";
  Interpretation result;
  result.status = std::system(command.c_str());
  result.out = read_file(folder / "out.txt");
  result.err = read_file(folder / "err.txt");
  std::filesystem::remove_all(folder);
  return result;
}

inline std::string interpreted(const std::string& text) {
  const Interpretation result = interpretation_of(text);
  EXPECT_EQ(result.status, 0) << "LinuxCNC's rs274 (Debian package linuxcnc-uspace): " << result.err
                              << result.out.substr(0, 500);
  return result.out;
}

inline std::vector<CanonicalMove> canonical_moves(const std::string& printed) {
  std::vector<CanonicalMove> moves;
  double feed = 0.0;
  std::istringstream lines(printed);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t open = line.find('(');
    const auto number_after = [&] { return std::strtod(line.c_str() + open + 1, nullptr); };
    const bool rapid = line.find("STRAIGHT_TRAVERSE(") != std::string::npos;
    if (line.find("SET_FEED_RATE(") != std::string::npos) feed = number_after();
    if (line.find("DWELL(") != std::string::npos && !moves.empty()) moves.back().dwell_s = number_after();
    if (!rapid && line.find("STRAIGHT_FEED(") == std::string::npos) continue;
    CanonicalMove move;
    move.rapid = rapid;
    move.feed = rapid ? 0.0 : feed;
    std::istringstream numbers(line.substr(open + 1));
    for (double& value : move.at) {
      numbers >> value;
      numbers.ignore(1);
    }
    moves.push_back(move);
  }
  return moves;
}

}  // namespace retrace::fabrication::test
