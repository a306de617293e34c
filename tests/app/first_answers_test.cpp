// Tests of the first answers that long commands print to standard error before their results.
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <string>
#include <thread>
#include <vector>

#include "tests/app/program.h"

namespace retrace::test::first_answers_test {
namespace {

using namespace std::chrono_literals;

/// A command that takes minutes, and a text of its first answer.
struct SlowCommand {
  std::string name;
  Arguments arguments;
  std::string answer;
};

void PrintTo(const SlowCommand& command, std::ostream* stream) {
  *stream << command.name;
}

class FirstAnswers : public testing::TestWithParam<SlowCommand> {};

TEST_P(FirstAnswers, ArePrintedWhileTheCommandRuns) {
  const TemporaryFolder folder;
  folder.write("study.toml",
               "design = \"" + example("tail_lamp_100cm2.toml") +
                   "\"\n[[parameter]]\nkey = \"body.thickness_mm\"\nvalues = [1, 2]\n[[quantity]]\nkind = "
                   "\"rre\"\n[analysis]\nsamples = 1e9\n");
  Arguments arguments = GetParam().arguments;
  arguments.insert(arguments.begin(), RETRACE_PROGRAM);
  arguments.emplace_back("--threads=2");
  Child child(folder.path(), arguments);
  const auto limit = std::chrono::steady_clock::now() + patient(60);
  while (!child.has_ended() && std::chrono::steady_clock::now() < limit &&
         child.err_so_far().find(GetParam().answer) == std::string::npos)
    std::this_thread::sleep_for(10ms);
  EXPECT_FALSE(child.has_ended()) << "the command has ended before its first answer";
  child.interrupt(SIGINT);
  const Outcome outcome = child.wait(patient(60));
  EXPECT_EQ(outcome.code, 130) << outcome.err;
  EXPECT_NE(outcome.err.find(GetParam().answer), std::string::npos) << outcome.err;
}

INSTANTIATE_TEST_SUITE_P(
    App, FirstAnswers,
    testing::Values(
        SlowCommand{"rre", {"rre", example("tail_lamp_100cm2.toml"), "--samples=4294967296"}, "preliminary"},
        SlowCommand{"sweep", {"sweep", "study.toml"}, "preliminary values of the first point"},
        SlowCommand{
            "camera", {"image", example("tail_lamp_100cm2.toml"), "--camera"}, "preliminary, without diffraction"}),
    [](const auto& command) { return command.param.name; });

}  // namespace
}  // namespace retrace::test::first_answers_test
