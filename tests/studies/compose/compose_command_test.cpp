// Tests of the command `retrace compose`: files that it writes and that other commands read, resumed runs, and refused
// inputs.

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "tests/app/program.h"
#include "tests/studies/sweep/stored_points.h"

namespace retrace::test::compose_command_test {
namespace {

constexpr std::array<int, 4> kAzimuthsDeg = {0, 60, 120, 210};

/// Returns a study that composes a part from zones with canted, rotated cube corners. The goals of the composition are
/// the RRE at an incidence of 35 degrees, for four azimuths.
std::string study(const std::string& keys, const std::string& cutoff = "1e-2") {
  return "design = \"" + example("honeycomb_infinite.toml") +
         "\"\n"
         "[[parameter]]\nkey = \"element.cant_deg\"\nname = \"cant\"\nfrom = 0\nto = 12\n"
         "[[parameter]]\nkey = \"analysis.rotation_deg\"\nname = \"turn\"\nfrom = 0\nto = 360\n"
         "[[quantity]]\nkind = \"rre\"\nname = \"g\"\nover_directions = \"each\"\n"
         "incidence_deg = 35\nazimuth_deg = [0, 60, 120, 210]\n"
         "[analysis]\nengine = \"exact\"\ncutoff = " +
         cutoff + "\n[compose]\nmaximize = \"g\"\nscan = 17\n" + keys;
}

Arguments compose(const Arguments& more = {}) {
  return with({"compose", "study.toml", "-o", "out"}, more);
}

TEST(ComposeCommand, WritesZonesThatMakeThePart) {
  const TemporaryFolder folder;
  folder.write("study.toml", study("max_zones = 3\nrounds = 1\nzone_sigma_arcmin = 1\nparts = 64\n"));
  const Outcome outcome = retrace(folder, compose());
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("minimum with at most 1 zone: "), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("from zone to zone: "), std::string::npos) << outcome.out;
  const Json json = folder.json("out/composition.json");
  const Json& zones = json.at("zones");
  const std::vector<std::string> names = folder.names();
  for (const std::string name : {"composition.csv", "composition.svg", "composition.png", "composition.sqlite"})
    EXPECT_EQ(std::ranges::count(names, "out/" + name), 1) << name;
  // The design of each zone is traced by `retrace rre`, with the light's direction in the frame of the zone. The sum,
  // weighted by the areas of the zones, must equal the goal of the part.
  for (std::size_t goal = 0; goal < kAzimuthsDeg.size(); ++goal) {
    double part = 0.0;
    for (std::size_t z = 0; z < zones.size(); ++z) {
      const double azimuth_deg = kAzimuthsDeg[goal] - zones[z].at("cell").at("turn").get<double>();
      const Json traced =
          retrace_json(folder, {"rre", "out/zone_" + std::to_string(z + 1) + ".toml", "--engine", "exact", "--cutoff",
                                "1e-2", "--incidence", "35", "--azimuth=" + std::to_string(azimuth_deg)});
      part += zones[z].at("area_fraction").get<double>() * traced.at("points").at(0).at("rre").get<double>();
    }
    EXPECT_NEAR(part, json.at("goals").at(goal).at("value").get<double>(), 1e-5);
  }
}

// For a part with an outline, the area fractions of zones refer to the area inside the outline.
TEST(ComposeCommand, ZonesAreDividedInsideTheOutline) {
  const TemporaryFolder folder;
  folder.write("design.toml",
               "[element]\nkind = \"hexagonal_icc\"\naperture_mm = 1\n[outline]\n"
               "polygon_mm = [[0, 0], [6, 0], [7.5, 4.5], [1, 4.5]]\ncorner_radius_mm = 0.75\nmargin_mm = 0.2\n"
               "[body]\nthickness_mm = 2\n");
  std::string text = study("max_zones = 2\nrounds = 0\n", "1e-3");
  text.replace(text.find(example("honeycomb_infinite.toml")), example("honeycomb_infinite.toml").size(), "design.toml");
  text.replace(text.find("scan = 17"), 9, "scan = 6");
  folder.write("study.toml", text);
  for (const std::string layout : {"stripes", "blocks", "rows"}) {
    const Outcome outcome = retrace(
        folder, {"compose", "study.toml", "-o", layout, "--design", "part.toml", "--layout", layout, "--quiet"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const Json zones = folder.json(layout + "/composition.json").at("zones");
    ASSERT_EQ(zones.size(), 2U);
    const Json inspected = retrace_json(folder, {"inspect", "part.toml"});
    for (std::size_t z = 0; z < 2; ++z)
      EXPECT_NEAR(
          inspected.at("zones").at(z).at("area_mm2").get<double>() / inspected.at("entrance_area_mm2").get<double>(),
          zones[z].at("area_fraction").get<double>(), 1e-8)
          << layout;
  }
}

TEST(ComposeCommand, WritesThePartOfZones) {
  const TemporaryFolder folder;
  folder.write("study.toml", study("max_zones = 2\nrounds = 0\n"));
  const Outcome outcome = retrace(folder, compose({"--design", "part.toml", "--layout", "rows", "--x-length-mm", "90",
                                                   "--y-length-mm", "180", "--quiet"}));
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const Json zones = folder.json("out/composition.json").at("zones");
  ASSERT_EQ(zones.size(), 2U);
  const Json inspected = retrace_json(folder, {"inspect", "part.toml"});
  ASSERT_EQ(inspected.at("zones").size(), 2U);
  for (std::size_t z = 0; z < 2; ++z)
    EXPECT_NEAR(inspected.at("zones").at(z).at("area_mm2").get<double>(),
                16200.0 * zones[z].at("area_fraction").get<double>(), 1e-6);
  // Each zone has at least two rows. The narrower rows are eight elements high.
  EXPECT_GE(inspected.at("design").at("zone").at(0).at("rectangles_mm").size(), 2U);
}

/// Returns a study whose parameter is the dihedral error instead of the cant.
std::string study_of_errors() {
  std::string text = study("max_zones = 2\nrounds = 0\n");
  for (const auto& [from, to] :
       {std::pair("element.cant_deg", "surface.dihedral_error_arcmin"), {"to = 12", "to = 20"}})
    text.replace(text.find(from), std::string(from).size(), to);
  return text;
}

TEST(ComposeCommand, WritesTheJobOfThePart) {
  const TemporaryFolder folder;
  folder.write("study.toml", study_of_errors());
  const Outcome outcome =
      retrace(folder, compose({"--design", "part.toml", "--x-length-mm", "30", "--y-length-mm", "24", "--job",
                               "job.toml", "--strategy", "dmc", "--tool-width-mm", "2.5", "--quiet"}));
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  ASSERT_EQ(retrace(folder, {"fabricate", "job.toml", "-o", "nc", "--quiet"}).code, 0);
  const Json verified = retrace_json(folder, {"verify", "job.toml", "nc/program.ngc"});
  EXPECT_EQ(verified.at("verdict"), "pass");
  EXPECT_EQ(verified.at("elements_cut"), retrace_json(folder, {"inspect", "part.toml"}).at("elements_full"));
}

TEST(ComposeCommand, RefusesJobsThatMeanNothing) {
  const TemporaryFolder folder;
  folder.write("study.toml", study_of_errors());
  const auto refused = [&](const Arguments& more) {
    const Outcome outcome = retrace(folder, compose(with({"--x-length-mm", "30", "--y-length-mm", "24"}, more)));
    return refused_at(outcome);
  };
  EXPECT_EQ(refused({"--design", "part.toml", "--job", "job.toml"}), "--tool-width-mm");
  EXPECT_EQ(refused({"--design", "part.toml", "--job", "job.toml", "--tool-width-mm", "2.5", "--strategy", "spiral"}),
            "--strategy");
  EXPECT_EQ(refused({"--design", "part.toml", "--job", "job.toml", "--tool-width-mm", "2"}), "--strategy");
  EXPECT_EQ(refused({"--design", "part.toml", "--job", "part.toml", "--tool-width-mm", "2.5", "--strategy", "dmc"}),
            "--design");
  EXPECT_EQ(folder.names().size(), 1U) << "nothing is written";
}

TEST(ComposeCommand, RefusesPartsOfZonesThatMeanNothing) {
  const TemporaryFolder folder;
  folder.write("study.toml", study("max_zones = 2\nrounds = 0\n"));
  const auto refused = [&](const Arguments& more) {
    const Outcome outcome = retrace(folder, compose(more));
    return refused_at(outcome);
  };
  EXPECT_EQ(refused({"--design", "part.toml"}), "--x-length-mm");
  EXPECT_EQ(refused({"--design", "part.toml", "--x-length-mm", "90"}), "--y-length-mm");
  EXPECT_EQ(refused({"--design", "part.toml", "--layout", "spirals"}), "--layout");
  EXPECT_EQ(refused({"--design", "part.toml", "--x-length-mm", "1", "--y-length-mm", "1"}), "--x-length-mm");
  for (const std::string value : {"nan", "inf", "-1", "0"}) {
    EXPECT_EQ(refused({"--design", "part.toml", "--x-length-mm=" + value, "--y-length-mm", "60"}), "--x-length-mm");
    EXPECT_EQ(refused({"--design", "part.toml", "--x-length-mm", "90", "--y-length-mm=" + value}), "--y-length-mm");
  }
  for (const std::string name : {"out/zone_1.toml", "out/composition.json"})
    EXPECT_EQ(refused({"--design", name, "--x-length-mm", "90", "--y-length-mm", "60"}), "--design");
  folder.write("study.toml", "design = \"" + example("honeycomb_infinite.toml") +
                                 "\"\n[[parameter]]\nkey = \"body.back_index\"\nfrom = 1\nto = 1.1\n"
                                 "[[quantity]]\nkind = \"rre\"\nname = \"g\"\nincidence_deg = 35\n"
                                 "[compose]\nmaximize = \"g\"\n");
  EXPECT_EQ(refused({"--design", "part.toml", "--x-length-mm", "90", "--y-length-mm", "60"}),
            "study.toml:2: parameter[1]");
  EXPECT_TRUE(folder.names().size() == 1) << "nothing is written";
}

TEST(ComposeCommand, GoesOnWithItsStore) {
  const TemporaryFolder folder;
  folder.write("study.toml", study("max_zones = 1\nrounds = 0\n"));
  ASSERT_EQ(retrace(folder, compose()).code, 0);
  const Json first = folder.json("out/composition.json");
  EXPECT_EQ(retrace(folder, compose()).code, 2) << "an existing store needs a word";
  // A study that differs only in the rules for the mixture of zones uses all stored cells.
  folder.write("study.toml", study("max_zones = 2\nrounds = 0\n"));
  ASSERT_EQ(retrace(folder, compose({"--resume"})).code, 0);
  const Json second = folder.json("out/composition.json");
  EXPECT_EQ(second.at("evaluations"), first.at("evaluations"));
  EXPECT_GE(second.at("goal_min").get<double>(), first.at("goal_min").get<double>());
  EXPECT_EQ(second.at("by_number_of_zones").at(0).at("goal_min"), first.at("goal_min"));
}

TEST(ComposeCommand, WritesTheZonesForTheWorst) {
  const TemporaryFolder folder;
  folder.write("study.toml",
               study("max_zones = 2\nrounds = 0\nzone_sigma_arcmin = 1\nparts = 64\nworst_fraction = 0.1\n"));
  ASSERT_EQ(retrace(folder, compose({"--for-worst"})).code, 0);
  const Json zones = folder.json("out/composition.json").at("errors_of_angle").at("best_for_worst").at("zones");
  ASSERT_GE(zones.size(), 1U);
  const double share = zones.at(0).at("area_fraction");
  EXPECT_NE(folder.read("out/zone_1.toml").find(fmt::format(": {} of the area", share)), std::string::npos);
  EXPECT_EQ(std::ranges::count(folder.names(), "out/zone_2.toml"), zones.size() > 1 ? 1 : 0);
  folder.write("study.toml", study("max_zones = 2\nrounds = 0\n"));
  EXPECT_EQ(refused_at(retrace(folder, compose({"--for-worst", "--overwrite"}))), "--for-worst");
}

TEST(ComposeCommand, SaysNoAndWhy) {
  const TemporaryFolder folder;
  folder.write("study.toml", study("min_goal = 0.99\nrounds = 0\n"));
  const Outcome outcome = retrace(folder, compose({"--quiet"}));
  EXPECT_EQ(refused_at(outcome, 1), "");
  EXPECT_TRUE(folder.json("out/composition.json").contains("not_reached"));
}

TEST(ComposeCommand, RefusesWhatMeansNothing) {
  const TemporaryFolder folder;
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"min_area_fraction = 0.7\nmax_area_fraction = 0.6\n", "min_area_fraction"},
      {"max_zones = 0\n", "max_zones"},
      {"max_area_fraction = 2\n", "max_area_fraction"},
      {"worst_fraction = 0.1\n", "worst_fraction"},
      {"price = {hours = 1}\n", "price.hours"}};
  for (const auto& [keys, key] : cases) {
    folder.write("study.toml", study(keys));
    EXPECT_EQ(refused_at(retrace(folder, compose())), "study.toml:24: compose." + key);
    EXPECT_EQ(folder.names(), std::vector<std::string>{"study.toml"});
  }
}

TEST(ComposeCommand, CellsAreOfOneKindOfElement) {
  const TemporaryFolder folder;
  folder.write("study.toml", "design = \"" + example("zoned_reflector.toml") +
                                 "\"\n[[parameter]]\nkey = \"element.cant_deg\"\nfrom = 0\nto = 1\n"
                                 "[[quantity]]\nkind = \"rre\"\nname = \"g\"\n[compose]\nmaximize = \"g\"\n");
  const Outcome outcome = retrace(folder, compose());
  EXPECT_EQ(refused_at(outcome), "examples/zoned_reflector.toml:19: zone");
}

TEST(ComposeCommand, EndsSoonWhenItIsInterrupted) {
  const TemporaryFolder folder;
  folder.write("study.toml", study("rounds = 100\nstarts = 100\nevaluations_per_start = 10000\n", "1e-6"));
  Child child(folder.path(), with({RETRACE_PROGRAM}, compose({"--quiet"})));
  const auto deadline = std::chrono::steady_clock::now() + patient(60);
  while (stored_points(folder.path() / "out/composition.sqlite").size() < 5) {
    ASSERT_FALSE(child.has_ended()) << "it was over too soon";
    ASSERT_LT(std::chrono::steady_clock::now(), deadline) << "no cells were stored";
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  child.interrupt();
  EXPECT_EQ(child.wait(patient(60)).code, 130);
  EXPECT_EQ(folder.json("out/composition.json").at("complete"), false);
}

}  // namespace
}  // namespace retrace::test::compose_command_test
