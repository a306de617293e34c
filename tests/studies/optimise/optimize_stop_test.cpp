// Tests of `retrace optimize`: runs that are interrupted, killed or refused, and output files.

#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <string>
#include <thread>

#include "tests/app/program.h"

namespace retrace::test::optimize_stop_test {
namespace {

namespace fs = std::filesystem;

/// Returns a design of prisms with rounded roots and rough facets, for which the engine `auto` traces rays.
std::string rough_design() {
  return "[element]\nkind = \"rtp\"\nbase_mm = 0.5\nwidth_mm = 0.5\n[array]\narrangement = \"offset\"\nx_length_mm = "
         "30\n"
         "y_length_mm = 20\n[body]\nthickness_mm = 2.0\nrefractive_index = 1.4917\n[surface]\nroot_radius_um = 5\n"
         "roughness_sq_nm = 20\ncorrelation_length_um = 2\n";
}

std::string rough_study(const std::string& keys = "") {
  return "design = \"part.toml\"\n[[parameter]]\nkey = [\"element.base_mm\", \"element.width_mm\"]\nname = "
         "\"base_mm\"\n"
         "from = 0.2\nto = 2\n[[quantity]]\nkind = \"rre\"\n[[quantity]]\nkind = \"machining_time_h\"\n"
         "[[constraint]]\nquantity = \"machining_time_h\"\nmax = 24\n[optimize]\nmaximize = \"rre\"\n" +
         keys + "[machining]\ntool_width_mm = 0.5\n";
}

void expect_valid_best(const TemporaryFolder& folder) {
  if (!fs::exists(folder.path() / "out/best.toml")) return;
  EXPECT_EQ(retrace(folder, {"inspect", "out/best.toml", "--json", "-"}).code, 0);
}

TEST(OptimizeStop, AnInterruptWritesTheBestSoFar) {
  const TemporaryFolder folder;
  folder.write("part.toml", rough_design());
  folder.write("study.toml", rough_study() + "[analysis]\ntarget_error = 3e-4\n");
  Child child(folder.path(), {RETRACE_PROGRAM, "optimize", "study.toml", "-o", "out", "--threads", "2"});
  const auto end = std::chrono::steady_clock::now() + patient(120);
  while (!fs::exists(folder.path() / "out/best.toml") && std::chrono::steady_clock::now() < end)
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  child.interrupt(SIGINT);
  const Outcome outcome = child.wait(patient(60));
  if (outcome.code == 0) return;  // the run ended before the interruption
  EXPECT_EQ(outcome.code, 130);
  ASSERT_TRUE(fs::exists(folder.path() / "out/best.toml"));
  expect_valid_best(folder);
  // On a busy machine, the program may be killed before it writes its results. The store and the best design must exist
  // even then.
  if (!fs::exists(folder.path() / "out/optimum.json")) return;
  const Json json = folder.json("out/optimum.json");
  EXPECT_EQ(json["complete"], false);
  EXPECT_TRUE(json.contains("best"));
  EXPECT_FALSE(json["pareto"].empty());
  EXPECT_EQ(json["designs"].size(), json["evaluations"].get<std::size_t>());
  EXPECT_EQ(lines_of(folder.read("out/designs.csv")).size(), json["designs"].size() + 1);
  EXPECT_GE(lines_of(folder.read("out/front.csv")).size(), 2U);
}

TEST(OptimizeStop, AKilledRunLeavesAValidDesign) {
  const TemporaryFolder folder;
  folder.write("part.toml", rough_design());
  folder.write("study.toml", rough_study());
  for (const int milliseconds : {150, 400, 900, 1700}) {
    fs::remove_all(folder.path() / "out");
    Child child(folder.path(), {RETRACE_PROGRAM, "optimize", "study.toml", "-o", "out", "--threads", "2"});
    std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
    child.interrupt(SIGKILL);
    child.wait();
    expect_valid_best(folder);
  }
}

TEST(OptimizeStop, ARunWithoutAnySuccessDoesNotBlockTheNextRun) {
  const TemporaryFolder folder;
  const auto study = [](const std::string& key) {
    return "design = \"" + example("rtp_brick_1mm.toml") + "\"\n[[parameter]]\nkey = \"" + key +
           "\"\nfrom = 1\nto = 3\n[[quantity]]\nkind = \"lens_thickness_mm\"\n[optimize]\n"
           "minimize = \"lens_thickness_mm\"\nscan = 5\n";
  };
  // A wrong value in [machining] must be refused before any file is written.
  folder.write("study.toml", study("array.overlap_percent") + "[machining]\ntool_width_mm = -1\n");
  EXPECT_EQ(refused_at(retrace(folder, {"optimize", "study.toml", "-o", "out"})),
            "study.toml:12: machining.tool_width_mm");
  EXPECT_FALSE(fs::exists(folder.path() / "out"));
  // All designs of the next study fail.
  std::string failing = study("body.thickness_mm");
  failing.replace(failing.find("from = 1\nto = 3"), 15, "from = -3\nto = -1");
  folder.write("study.toml", failing);
  EXPECT_EQ(retrace(folder, {"optimize", "study.toml", "-o", "out", "--quiet"}).code, 1);
  folder.write("study.toml", study("body.thickness_mm"));
  EXPECT_EQ(retrace(folder, {"optimize", "study.toml", "-o", "out", "--quiet"}).code, 0);
  // A store with results must not be replaced.
  EXPECT_EQ(refused_at(retrace(folder, {"optimize", "study.toml", "-o", "out"})), "out/optimum.sqlite");
}

TEST(OptimizeStop, WritesThePlotsAndAllDesigns) {
  const TemporaryFolder folder;
  folder.write("study.toml", "design = \"" + example("rtp_brick_1mm.toml") +
                                 "\"\n[[parameter]]\nkey = \"body.thickness_mm\"\nfrom = 1\nto = 3\n[[quantity]]\n"
                                 "kind = \"lens_thickness_mm\"\n[[constraint]]\nquantity = \"lens_thickness_mm\"\n"
                                 "max = 3\n[optimize]\nmaximize = \"lens_thickness_mm\"\nscan = 9\n");
  EXPECT_EQ(retrace(folder, {"optimize", "study.toml", "-o", "out", "--quiet"}).code, 0);
  for (const char* const file :
       {"optimum.svg", "optimum.png", "constraints.svg", "constraints.png", "designs.csv", "front.csv", "best.toml"})
    EXPECT_TRUE(fs::exists(folder.path() / "out" / file)) << file;
  const Json json = folder.json("out/optimum.json");
  // Plate and prisms together may be 3 mm thick. The prisms are 0.5 mm deep, so the plate may be 2.5 mm thick.
  EXPECT_NEAR(json["best"]["body.thickness_mm"].get<double>(), 2.5, 1e-6);
  EXPECT_EQ(json["designs"].size(), json["evaluations"].get<std::size_t>());
}

}  // namespace
}  // namespace retrace::test::optimize_stop_test
