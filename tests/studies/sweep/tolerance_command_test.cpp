// Tests of the commands `retrace tolerance` and `retrace optimize --job`, and of the progress bar.

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "tests/app/program.h"
#include "tests/studies/sweep/stored_points.h"

namespace retrace::test::tolerance_command_test {
namespace {

namespace fs = std::filesystem;

std::string tolerance_study(const std::string& keys) {
  return "design = \"" + example("rtp_brick_1mm.toml") +
         "\"\n[[parameter]]\nkey = \"body.refractive_index\"\ndistribution = \"normal\"\nmean = 1.49\nsigma = 0.01\n"
         "[[parameter]]\nkey = \"body.thickness_mm\"\ndistribution = \"uniform\"\nfrom = 1\nto = 3\n"
         "[[quantity]]\nkind = \"rre\"\n[[quantity]]\nkind = \"lens_thickness_mm\"\n" +
         keys;
}

const std::string kLimit = "[[constraint]]\nquantity = \"lens_thickness_mm\"\nmax = 3\n";

TEST(ToleranceCommand, WritesSpreadYieldAndContributors) {
  const TemporaryFolder folder;
  folder.write("study.toml", tolerance_study(kLimit + "[tolerance]\nsamples = 32\n"));
  const Json json = retrace_json(folder, {"tolerance", "study.toml", "-o", "out", "--quiet"});
  EXPECT_EQ(json["schema"], "retrace.tolerance/2");
  EXPECT_EQ(json["points_in_all"], 1 + 32 * 4);
  EXPECT_EQ(json["parts"], 64);
  EXPECT_EQ(json["failed"], 0);
  EXPECT_EQ(json["complete"], true);
  // The plates are 1 to 3 mm thick, and the prisms are 0.5 mm deep. Three quarters of the parts are thin enough.
  EXPECT_NEAR(json["yield"]["value"].get<double>(), 0.75, 0.06);
  EXPECT_LT(json["yield"]["low"].get<double>(), 0.75);
  EXPECT_GT(json["yield"]["high"].get<double>(), 0.75);
  ASSERT_EQ(json["quantities"].size(), 2U);
  const Json& thickness = json["quantities"][1];
  EXPECT_NEAR(thickness["nominal"].get<double>(), 2.5, 1e-12);
  EXPECT_EQ(thickness["indices"][0]["total"]["value"], 0.0);
  EXPECT_NEAR(thickness["indices"][1]["total"]["value"].get<double>(), 1.0, 0.2);
  for (const char* file : {"tolerance.json", "parts.csv", "tolerance.svg", "tolerance.png", "tolerance.sqlite"})
    EXPECT_TRUE(fs::exists(folder.path() / "out" / file)) << file;
  EXPECT_EQ(lines_of(folder.read("out/parts.csv")).size(), 1U + 1U + 32U * 4U);
}

TEST(ToleranceCommand, NoIsTheAnswerIfEveryPartFailed) {
  const TemporaryFolder folder;
  std::string study = tolerance_study("[tolerance]\nsamples = 8\n");
  study.replace(study.find("from = 1\nto = 3"), 15, "from = -3\nto = -1");
  folder.write("study.toml", study);
  const Outcome outcome = retrace(folder, {"tolerance", "study.toml", "-o", "out", "--quiet"});
  EXPECT_EQ(refused_at(outcome, 1), "");
}

TEST(ToleranceCommand, ResumesWithoutComputingAnythingAgain) {
  const TemporaryFolder folder;
  const std::string study = tolerance_study("[tolerance]\nsamples = 8\n");
  folder.write("study.toml", study);
  const Arguments arguments = {"tolerance", "study.toml", "-o", "out", "--quiet"};
  EXPECT_EQ(retrace(folder, arguments).code, 0);
  const std::string first = without_elapsed(folder.read("out/tolerance.json"));
  const auto before = stored_points(folder.path() / "out/tolerance.sqlite");
  const Outcome again = retrace(folder, arguments);
  EXPECT_EQ(refused_at(again), "out/tolerance.sqlite");
  Arguments resume = arguments;
  resume.push_back("--resume");
  EXPECT_EQ(retrace(folder, resume).code, 0);
  EXPECT_EQ(stored_points(folder.path() / "out/tolerance.sqlite"), before);
  EXPECT_EQ(without_elapsed(folder.read("out/tolerance.json")), first);
  folder.write("study.toml", tolerance_study("[tolerance]\nsamples = 16\n"));
  const Outcome changed = retrace(folder, resume);
  EXPECT_EQ(refused_at(changed), "study.toml");
  // The command `sweep` must not resume in the output folder of a tolerance study.
  folder.write("study.toml", study);
  EXPECT_EQ(retrace(folder, {"sweep", "study.toml", "-o", "out", "--quiet", "--resume"}).code, 2);
}

TEST(ToleranceCommand, SaysNoIfTheYieldIsTooLow) {
  const TemporaryFolder folder;
  const auto code = [&](const std::string& percent) {
    folder.write("study.toml", tolerance_study(kLimit +
                                               "[tolerance]\nsamples = 32\nindices = \"none\"\n"
                                               "min_yield_percent = " +
                                               percent + "\n"));
    const Outcome outcome = retrace(folder, {"tolerance", "study.toml"});
    EXPECT_NE(outcome.out.find("yield:  "), std::string::npos) << outcome.out;
    return outcome.code;
  };
  EXPECT_EQ(code("60"), 0);
  EXPECT_EQ(code("90"), 1);
}

TEST(ToleranceCommand, BadInputLeavesNothing) {
  const TemporaryFolder folder;
  folder.write("study.toml", tolerance_study("[tolerance]\nsamples = 0\n"));
  const Outcome outcome = retrace(folder, {"tolerance", "study.toml", "-o", "out"});
  EXPECT_EQ(refused_at(outcome), "study.toml:17: tolerance.samples");
  EXPECT_EQ(folder.names(), std::vector<std::string>{"study.toml"});
}

TEST(ToleranceCommand, TheSameBytesAtAnyNumberOfThreads) {
  const TemporaryFolder folder;
  folder.write("study.toml", tolerance_study("[tolerance]\nsamples = 8\n"));
  const auto document = [&](const std::string& threads) {
    return without_elapsed(retrace(folder, {"tolerance", "study.toml", "--json", "-", "--threads", threads}).out);
  };
  EXPECT_EQ(document("1"), document("3"));
}

std::string optimize_study(const std::string& keys = "") {
  return "design = \"" + example("rtp_brick_1mm.toml") +
         "\"\n[[parameter]]\nkey = [\"element.base_mm\", \"element.width_mm\"]\nname = \"size_mm\"\n"
         "values = [0.5, 1, 2]\n[[quantity]]\nkind = \"rre\"\n[[quantity]]\nkind = \"tool_fit_mm\"\n"
         "[[constraint]]\nquantity = \"tool_fit_mm\"\nmin = 0\n[optimize]\nmaximize = \"rre\"\n" +
         keys;
}

/// The job of the chosen design is the same as the job that `retrace job` makes from the written design.
TEST(OptimizeJob, IsThatOfTheChosenDesign) {
  const TemporaryFolder folder;
  folder.write("study.toml", optimize_study("[machining]\ntool_width_mm = 0.9\n"));
  const Outcome outcome =
      retrace(folder, {"optimize", "study.toml", "-o", "out", "--quiet", "--job", "best.toml", "--machine", "thesis"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(folder.json("out/optimum.json")["best"]["size_mm"], 1.0);
  const Outcome by_hand =
      retrace(folder, {"job", example("rtp_brick_1mm.toml"), "--set", "element.base_mm=1", "--set",
                       "element.width_mm=1", "--machine", "thesis", "--tool-width-mm", "0.9", "-o", "by_hand.toml"});
  EXPECT_EQ(by_hand.code, 0) << by_hand.err;
  EXPECT_EQ(folder.read("best.toml"), folder.read("by_hand.toml"));
  EXPECT_EQ(retrace(folder, {"fabricate", "best.toml", "-o", "program", "--quiet"}).code, 0);
}

TEST(OptimizeJob, BadInputIsSaidInOneLine) {
  const TemporaryFolder folder;
  folder.write("study.toml", optimize_study("[machining]\ntool_width_mm = 0.5\n"));
  const auto error = [&](const Arguments& more) {
    Arguments arguments = {"optimize", "study.toml", "-o", "out", "--quiet"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = retrace(folder, arguments);
    EXPECT_EQ(folder.names(), std::vector<std::string>{"study.toml"}) << "nothing is written";
    return refused_at(outcome);
  };
  EXPECT_EQ(error({"--machine", "thesis"}), "--machine");
  EXPECT_EQ(error({"--job", "j.toml", "--machine", "lathe"}), "--machine");
  EXPECT_EQ(error({"--job", "j.toml", "--strategy", "drill"}), "--strategy");
  EXPECT_EQ(error({"--job", "j.toml", "--strategy", "dmc"}), "--strategy");
  EXPECT_EQ(error({"--job", "j.toml", "--tool-width-mm", "3"}), "--tool-width-mm");
  EXPECT_EQ(error({"--job", "study.toml"}), "--job");
}

TEST(OptimizeJob, NeedsATool) {
  const TemporaryFolder folder;
  folder.write("study.toml", optimize_study());
  const Outcome outcome = retrace(folder, {"optimize", "study.toml", "--job", "j.toml", "--quiet"});
  EXPECT_EQ(refused_at(outcome), "--tool-width-mm");
  EXPECT_FALSE(fs::exists(folder.path() / "j.toml"));
}

/// Returns the output of a command on a terminal, which the program `script` simulates.
std::string on_a_terminal(const TemporaryFolder& folder, const std::string& arguments) {
  const Outcome outcome = Child(folder.path(), {"/usr/bin/script", "-qec",
                                                "'" + std::string(RETRACE_PROGRAM) + "' " + arguments, "/dev/null"})
                              .wait(patient(60));
  EXPECT_EQ(outcome.code, 0) << outcome.out;
  return outcome.out;
}

TEST(ProgressBar, TellsRateTimeLeftAndFailures) {
  const TemporaryFolder folder;
  folder.write("study.toml", "design = \"" + example("honeycomb_infinite.toml") +
                                 "\"\n[[parameter]]\nkey = \"body.thickness_mm\"\nvalues = [-1, 1, 1.5, 2, 2.5, 3]\n"
                                 "[[quantity]]\nkind = \"rre\"\n[analysis]\nengine = \"cell\"\nsamples = 200000\n");
  const std::string drawn = on_a_terminal(folder, "sweep study.toml -o out --threads 1");
  EXPECT_NE(drawn.find("sweeping [="), std::string::npos) << drawn;
  EXPECT_NE(drawn.find("6/6 points, "), std::string::npos) << drawn;
  EXPECT_NE(drawn.find("/s, 1 failed"), std::string::npos) << drawn;
  EXPECT_NE(drawn.find(" s left"), std::string::npos) << drawn;
  EXPECT_NE(drawn.find("\r\033[K"), std::string::npos) << "and goes away";
  EXPECT_EQ(on_a_terminal(folder, "sweep study.toml -o out --overwrite --quiet").find("points"), std::string::npos);
}

}  // namespace
}  // namespace retrace::test::tolerance_command_test
