// Tests of the note about a long run. The program writes this note to standard error, which is not a terminal in these
// tests.
#include <gtest/gtest.h>

#include <chrono>
#include <string>
#include <thread>

#include "tests/app/program.h"

namespace retrace::test::long_run_test {
namespace {

using namespace std::chrono_literals;

// Processor time, in s, after which a run is interrupted. The program estimates the remaining time within 2 s.
constexpr double kBefore_s = 2.5;

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

/// Returns the number of lines that begin with "note: ".
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
  EXPECT_NE(outcome.err.find("--samples"), std::string::npos) << outcome.err;
}

TEST(LongRunOfTheProgram, OfAStudyIsReportedBeforeItsFirstPointIsFinished) {
  const TemporaryFolder folder;
  folder.write("study.toml", kStudy);
  const Outcome outcome = interrupted(folder, {"sweep", "study.toml"});
  EXPECT_EQ(outcome.code, 130) << outcome.err;
  EXPECT_EQ(note_count(outcome.err), 1) << outcome.err;
  EXPECT_NE(outcome.err.find("analysis.samples"), std::string::npos) << outcome.err;
}

/// Returns the arguments of a photometry run that traces `rays` rays per direction of incidence.
Arguments photometry_with_rays(std::uint64_t rays) {
  return {"photometry",
          example("reflex_reflector.toml"),
          "--standard=r150",
          "--class=IA",
          "--colour=red",
          "--area-cm2=30",
          "--json=-",
          "--engine=montecarlo",
          "--samples=" + std::to_string(rays)};
}

/// Runs the program with one thread. Interrupts it as soon as it has printed preliminary readings, or after a time
/// limit.
Outcome interrupted_after_preliminary_readings(const TemporaryFolder& folder, const Arguments& arguments) {
  Child child(folder.path(), with(with({RETRACE_PROGRAM}, arguments), {"--threads=1"}));
  const auto limit = std::chrono::steady_clock::now() + patient(60);
  while (!child.has_ended() && std::chrono::steady_clock::now() < limit &&
         child.err_so_far().find("preliminary readings") == std::string::npos)
    std::this_thread::sleep_for(10ms);
  child.interrupt(SIGINT);
  return child.wait(patient(60));
}

// A run of about half a minute is too short for the note on long runs, but it prints preliminary readings.
TEST(LongRunOfTheProgram, PhotometryGivesPreliminaryReadingsAfterSomeSeconds) {
  const TemporaryFolder folder;
  const Outcome outcome = interrupted_after_preliminary_readings(folder, photometry_with_rays(1500000));
  EXPECT_EQ(outcome.code, 130) << outcome.err;
  EXPECT_NE(outcome.err.find("preliminary readings"), std::string::npos) << outcome.err;
}

// The program prints preliminary readings to standard error during a long run, unless --quiet is given. The readings do
// not change the standard output of an interrupted run.
TEST(LongRunOfTheProgram, PhotometryGivesPreliminaryReadings) {
  const TemporaryFolder folder;
  const Arguments arguments = photometry_with_rays(4294967296);
  const Outcome loud = interrupted_after_preliminary_readings(folder, arguments);
  EXPECT_EQ(loud.code, 130) << loud.err;
  EXPECT_EQ(note_count(loud.err), 1) << loud.err;
  EXPECT_LT(loud.err.find("note: "), loud.err.find("\npreliminary readings")) << loud.err;
  EXPECT_NE(loud.err.find("\npreliminary readings"), std::string::npos) << loud.err;
  EXPECT_EQ(loud.err.find("verdict"), std::string::npos) << loud.err;
  const Outcome quiet = interrupted(folder, with(arguments, {"--quiet"}));
  EXPECT_EQ(quiet.code, 130) << quiet.err;
  EXPECT_EQ(quiet.err.find("preliminary"), std::string::npos) << quiet.err;
  EXPECT_EQ(without_elapsed(loud.out), without_elapsed(quiet.out));
}

TEST(LongRunOfTheProgram, IsNotReportedIfItIsQuiet) {
  const TemporaryFolder folder;
  folder.write("study.toml", kStudy);
  EXPECT_EQ(note_count(interrupted(folder, {"sweep", "study.toml", "--quiet"}).err), 0);
}

}  // namespace
}  // namespace retrace::test::long_run_test
