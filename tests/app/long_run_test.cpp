// The line about long work that the program writes to standard error, without a terminal.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <string>
#include <thread>

#include "tests/app/program.h"

namespace retrace::test::long_run_test {
namespace {

using namespace std::chrono_literals;

constexpr double kBefore_s = 4.0;  // processor time after which the run is interrupted; the estimate comes within 2 s

const std::string kStudy =
    "design = \"" + example("tail_lamp_100cm2.toml") +
    "\"\n[[parameter]]\nkey = \"body.thickness_mm\"\nvalues = [1, 2]\n[[quantity]]\nkind = \"rre\"\n[analysis]\n"
    "samples = 1e9\n";

/// Runs the program until it is interrupted, and returns what it has written.
Outcome interrupted(const TemporaryFolder& folder, Arguments arguments) {
  arguments.insert(arguments.begin(), RETRACE_PROGRAM);
  arguments.emplace_back("--threads=1");
  Child child(folder.path(), arguments);
  while (!child.has_ended() && child.processor_time_s() < kBefore_s) std::this_thread::sleep_for(10ms);
  child.interrupt(SIGINT);
  return child.wait(patient(60));
}

/// Notes among the lines of a text.
std::ptrdiff_t note_count(const std::string& text) {
  std::ptrdiff_t count = text.starts_with("note: ") ? 1 : 0;
  for (std::size_t at = text.find("\nnote: "); at != std::string::npos; at = text.find("\nnote: ", at + 1)) ++count;
  return count;
}

TEST(LongRunOfTheProgram, NamesTheOptionThatShortensIt) {
  const TemporaryFolder folder;
  const Outcome outcome = interrupted(folder, {"rre", example("tail_lamp_100cm2.toml"), "--samples=68719476736"});
  EXPECT_EQ(outcome.code, 130) << outcome.err;
  EXPECT_EQ(note_count(outcome.err), 1) << outcome.err;
  EXPECT_NE(outcome.err.find("--samples (now 68719476736)"), std::string::npos) << outcome.err;
}

TEST(LongRunOfTheProgram, OfAStudyIsReportedBeforeItsFirstPointIsFinished) {
  const TemporaryFolder folder;
  folder.write("study.toml", kStudy);
  const Outcome outcome = interrupted(folder, {"sweep", "study.toml"});
  EXPECT_EQ(outcome.code, 130) << outcome.err;
  EXPECT_EQ(note_count(outcome.err), 1) << outcome.err;
  EXPECT_NE(outcome.err.find("analysis.samples (now 1000000000)"), std::string::npos) << outcome.err;
}

TEST(LongRunOfTheProgram, IsNotReportedIfItIsQuiet) {
  const TemporaryFolder folder;
  folder.write("study.toml", kStudy);
  EXPECT_EQ(note_count(interrupted(folder, {"sweep", "study.toml", "--quiet"}).err), 0);
}

}  // namespace
}  // namespace retrace::test::long_run_test
