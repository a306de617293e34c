#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/app/program.h"

// Tests of the program with parts that have an outline: the path from a design to an NC program and back, and all
// commands that accept such parts.

namespace retrace::test::outline_command_test {
namespace {

const std::string kRectangle = "polygon_mm = [[1, 2], [4, 2], [4, 4], [1, 4]]\n";
const std::string kNotched =
    "polygon_mm = [[0, 0], [3, 0], [3, 1.2], [1.4, 1.2], [1.4, 2.4], [0, 2.4]]\ncorner_radius_mm = 0.2\n";

std::string prisms(const std::string& outline, const std::string& array = "") {
  return "title = \"P\"\n[element]\nkind = \"rtp\"\nbase_mm = 0.2\nwidth_mm = 0.25\n[array]\n" + array + outline +
         "[body]\nthickness_mm = 1\nrefractive_index = 1.4917\n";
}
std::string cubes(const std::string& kind, const std::string& outline, const std::string& more = "") {
  return "title = \"P\"\n[element]\nkind = \"" + kind +
         "\"\naperture_mm = 0.3\n[array]\npartial_elements = \"omit\"\n" + outline +
         "[body]\nthickness_mm = 1\nrefractive_index = 1.4917\n" + more;
}
std::string table(const std::string& keys) {
  return "[outline]\n" + keys;
}

/// Expects that two documents have the same keys and texts, and the same numbers within 1e-12.
void expect_near(const Json& a, const Json& b, const std::string& path) {
  ASSERT_EQ(a.type(), b.type()) << path;
  if (a.is_number()) {
    EXPECT_NEAR(a.get<double>(), b.get<double>(), 1e-12 * std::max(1.0, std::abs(a.get<double>()))) << path;
  } else if (a.is_structured()) {
    ASSERT_EQ(a.size(), b.size()) << path;
    for (auto one = a.begin(), other = b.begin(); one != a.end(); ++one, ++other)
      expect_near(*one, *other, path + "." + (a.is_object() ? one.key() : std::to_string(one - a.begin())));
  } else {
    EXPECT_EQ(a, b) << path;
  }
}

class OutlineCommand : public ::testing::Test {
 protected:
  /// Makes the job and the NC program of a design.
  void make(const std::string& design, const Arguments& options) {
    folder_.write("design.toml", design);
    Arguments job = {"job", "design.toml", "-o", "job.toml", "--quiet"};
    job.insert(job.end(), options.begin(), options.end());
    const Outcome made = retrace(folder_, job);
    ASSERT_EQ(made.code, 0) << made.err;
    const Outcome cut = retrace(folder_, {"fabricate", "job.toml", "--dialect", "rs274ngc", "-o", "nc", "--quiet"});
    ASSERT_EQ(cut.code, 0) << cut.err;
  }
  Json verified() {
    return retrace_json(folder_, {"verify", "job.toml", "nc/program.ngc", "--as-machined", "part.toml"});
  }
  Json inspected(const std::string& name) { return retrace_json(folder_, {"inspect", name}); }
  double rre_of(const std::string& name) {
    return retrace_json(folder_, {"rre", name, "--engine", "embree", "--samples", "65536", "--incidence", "5", "--set",
                                  "detector.acceptance_half_angle_deg=0.5"})["points"][0]["rre"]
        .get<double>();
  }

  TemporaryFolder folder_;
};

const Arguments kTwoStep = {"--tool-width-mm", "0.2"};
const Arguments kDmc = {"--tool-width-mm", "0.5", "--strategy", "dmc"};

// The machined part has the outline of the design and returns the same light as the design.
TEST_F(OutlineCommand, PrismsComeBackAsTheDesign) {
  make(prisms(table(kNotched + "holes_mm = [[0.7, 0.6, 0.15]]\nmargin_mm = 0.1\n"), "partial_elements = \"omit\"\n"),
       kTwoStep);
  const Json design = inspected("design.toml");
  const Json json = verified();
  EXPECT_EQ(json["verdict"], "pass") << json.dump().substr(0, 1000);
  EXPECT_EQ(json["elements"], design["elements_full"]);
  EXPECT_EQ(json["elements_cut"], design["elements_full"]);
  const std::string part = folder_.read("part.toml");
  EXPECT_NE(part.find("holes_mm = [[0.7, 0.6, 0.15]]"), std::string::npos) << part;
  EXPECT_NE(part.find("corner_radius_mm = 0.2"), std::string::npos) << part;
  EXPECT_EQ(part.find("facets = "), std::string::npos) << "all elements are equal";
  folder_.write("smooth.toml", without_texture(part));
  const Json machined = inspected("smooth.toml");
  EXPECT_EQ(machined["elements_full"], design["elements_full"]);
  EXPECT_NEAR(machined["entrance_area_mm2"].get<double>(), design["entrance_area_mm2"].get<double>(), 1e-9);
  EXPECT_NEAR(rre_of("smooth.toml"), rre_of("design.toml"), 1e-4);
}

// If the design file is missing, the machined part must have the outline that the job contains.
TEST_F(OutlineCommand, TheJobContainsTheOutline) {
  make(prisms(table("circle_mm = [0, 0, 1.2]\nholes_mm = [[0.1, 0.2, 0.3]]\n"), "partial_elements = \"omit\"\n"),
       kTwoStep);
  const Json design = inspected("design.toml");
  ASSERT_NE(folder_.read("job.toml").find("[outline]"), std::string::npos);
  std::filesystem::remove(folder_.path() / "design.toml");
  EXPECT_EQ(verified()["verdict"], "pass");
  const Json machined = inspected("part.toml");
  EXPECT_EQ(machined["elements_full"], design["elements_full"]);
  EXPECT_NEAR(machined["entrance_area_mm2"].get<double>(), design["entrance_area_mm2"].get<double>(), 1e-9);
}

// An NC program for the whole rectangle also cuts outside of the outline. `retrace verify` must find this error.
TEST_F(OutlineCommand, CutsOutsideOfTheOutlineAreFound) {
  make(prisms("", "x_length_mm = 3\ny_length_mm = 2.4\n"), kTwoStep);
  const std::string whole = folder_.read("nc/program.ngc");
  make(prisms(table(kNotched), "partial_elements = \"omit\"\n"), kTwoStep);
  folder_.write("whole.ngc", whole);
  const Outcome run = retrace(folder_, {"verify", "job.toml", "whole.ngc", "--json", "v.json", "--quiet"});
  EXPECT_EQ(run.code, 1);
  const Json json = folder_.json("v.json");
  EXPECT_EQ(json["verdict"], "fail");
  EXPECT_EQ(json["elements_cut"], json["elements"]);
  bool is_found = false;
  for (const Json& finding : json["findings"]) is_found |= finding["kind"] == "gouge" && !finding.contains("element");
  EXPECT_TRUE(is_found) << json["findings"].dump().substr(0, 1000);
}

TEST_F(OutlineCommand, CubeCornersComeBackAsTheDesign) {
  for (const std::string kind : {"triangular_icc", "hexagonal_icc"}) {
    make(cubes(kind, table(kNotched + "margin_mm = 0.1\n")), kDmc);
    const Json design = inspected("design.toml");
    const Json json = verified();
    EXPECT_EQ(json["verdict"], "pass") << json.dump().substr(0, 1000);
    EXPECT_EQ(json["elements_cut"], design["elements_full"]);
    const Json machined = inspected("part.toml");
    EXPECT_EQ(machined["elements_full"], design["elements_full"]);
    EXPECT_EQ(machined["boundary"], "closed, free of self-intersections");
    EXPECT_NEAR(machined["entrance_area_mm2"].get<double>(), design["entrance_area_mm2"].get<double>(), 1e-9);
    folder_.write("smooth.toml", without_texture(folder_.read("part.toml")));
    EXPECT_NEAR(rre_of("smooth.toml"), rre_of("design.toml"), kind == "hexagonal_icc" ? 0.03 : 1e-4);
  }
}

TEST_F(OutlineCommand, PrismsOnASubstrateAreCutInsideTheOutline) {
  make(prisms(table("circle_mm = [0, 0, 1.2]\n"), "partial_elements = \"omit\"\n") +
           "[substrate]\nkind = \"cylinder\"\nradius_mm = 30\n",
       kTwoStep);
  const Json design = inspected("design.toml");
  const Json json = verified();
  EXPECT_EQ(json["verdict"], "pass") << json.dump().substr(0, 1000);
  EXPECT_EQ(json["elements_cut"], design["elements_full"]);
  EXPECT_NE(folder_.read("part.toml").find("circle_mm"), std::string::npos);
  EXPECT_EQ(inspected("part.toml")["elements_full"], design["elements_full"]);
}

TEST_F(OutlineCommand, ZonesAreCutInsideTheOutline) {
  make(cubes("triangular_icc", table(kNotched),
             "[[zone]]\narea_fraction = 0.4\n[[zone]]\narea_fraction = 0.6\nrotation_deg = 20\n"),
       kDmc);
  const Json design = inspected("design.toml");
  const Json json = verified();
  EXPECT_EQ(json["verdict"], "pass") << json.dump().substr(0, 1000);
  EXPECT_EQ(json["elements_cut"], design["elements_full"]);
  folder_.write("smooth.toml", without_texture(folder_.read("part.toml")));
  EXPECT_EQ(inspected("smooth.toml")["elements_full"], design["elements_full"]);
  EXPECT_NEAR(rre_of("smooth.toml"), rre_of("design.toml"), 2e-3);
}

TEST_F(OutlineCommand, ReachableCubeCornersAreInsideTheOutline) {
  folder_.write("design.toml", cubes("hexagonal_icc", table(kNotched)));
  const Outcome made =
      retrace(folder_, {"job", "design.toml", "--tool-width-mm", "0.1", "--reachable", "reach.toml", "--quiet"});
  ASSERT_EQ(made.code, 0) << made.err;
  const Json design = inspected("design.toml");
  const Json reached = inspected("reach.toml");
  EXPECT_EQ(reached["elements_full"], design["elements_full"]);
  EXPECT_NEAR(reached["entrance_area_mm2"].get<double>(), design["entrance_area_mm2"].get<double>(), 1e-9);
}

// A mask selects elements of the bounding box. Of the selected elements, only those inside the outline must remain.
TEST_F(OutlineCommand, MasksSelectElementsInsideTheOutline) {
  std::string picture = "P2\n15 9\n255\n";
  for (int k = 0; k < 15 * 9; ++k) picture += k % 15 < 8 ? "0\n" : "255\n";
  folder_.write("mask.pgm", picture);
  const std::string mask = "partial_elements = \"omit\"\nmask = \"mask.pgm\"\n";
  folder_.write("all.toml", prisms(table(kNotched), "partial_elements = \"omit\"\n"));
  make(prisms(table(kNotched), mask), kTwoStep);
  const Json json = verified();
  const Json design = inspected("design.toml");
  EXPECT_EQ(json["verdict"], "pass") << json.dump().substr(0, 1000);
  EXPECT_EQ(json["elements_cut"], design["elements_full"]);
  EXPECT_GT(design["elements_full"].get<int>(), 20);
  EXPECT_LT(design["elements_full"].get<int>(), inspected("all.toml")["elements_full"].get<int>());
  EXPECT_EQ(inspected("part.toml")["elements_full"], design["elements_full"]);
}

TEST_F(OutlineCommand, FaultyOutlinesOfJobsAreRefused) {
  make(prisms(table("circle_mm = [0, 0, 1.2]\n"), "partial_elements = \"omit\"\n"), kTwoStep);
  const std::string good = folder_.read("job.toml");
  const auto refusal = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from << "\n" << good;
    text.replace(at, from.size(), to);
    folder_.write("job.toml", text);
    const std::string where = refused_at(retrace(folder_, {"fabricate", "job.toml", "-o", "no", "--quiet"}));
    return where.substr(where.rfind(' ') + 1);
  };
  EXPECT_EQ(refusal("x_length_mm = 2.4", "x_length_mm = 2.5"), "array.x_length_mm");
  EXPECT_EQ(refusal("y_offset_mm = 0", "y_offset_mm = 0.2"), "array.y_offset_mm");
  EXPECT_EQ(refusal("corners_mm = [", "corners_mm = [[1, 2, 3], "), "outline.borders");
  EXPECT_EQ(refusal("tolerance_mm = 0.005", "tolerance_mm = 1e-6"), "outline.tolerance_mm");
}

// A rectangular outline must give the same results as a part with x_length_mm and y_length_mm.
TEST_F(OutlineCommand, ARectangleGivesTheNumbersOfTheRectangle) {
  const std::string lengths = "x_length_mm = 3\ny_length_mm = 2\n";
  const std::string zones =
      "[[zone]]\narea_fraction = 0.4\n[[zone]]\narea_fraction = 0.6\nset = [\"element.base_mm=0.25\"]\n";
  folder_.write("a.toml", prisms("", lengths));
  folder_.write("b.toml", prisms(table(kRectangle)));
  folder_.write("a_zones.toml", prisms("", lengths) + zones);
  folder_.write("b_zones.toml", prisms(table(kRectangle)) + zones);
  const auto numbers = [&](const Arguments& arguments) {
    Json json = retrace_json(folder_, arguments);
    for (const char* key : {"design", "elapsed_s", "designs", "title"}) json.erase(key);
    return json;
  };
  const std::vector<Arguments> commands = {
      {"rre", "FILE", "--engine", "exact", "--incidence", "0,10"},
      {"rre", "FILE", "--engine", "embree", "--samples", "4096", "--incidence", "0,10"},
      {"inspect", "FILE"},
  };
  for (Arguments command : commands)
    for (const std::string kind : {"", "_zones"}) {
      command[1] = "a" + kind + ".toml";
      const Json a = numbers(command);
      command[1] = "b" + kind + ".toml";
      const Json b = numbers(command);
      expect_near(a, b, command[0] + kind);
    }
  for (const char* file : {"a", "b"}) {
    const std::string name = file;
    ASSERT_EQ(
        retrace(folder_, {"job", name + ".toml", "--tool-width-mm", "0.2", "-o", name + "_job.toml", "--quiet"}).code,
        0);
  }
  std::string job = folder_.read("b_job.toml");
  job.replace(job.find("b.toml"), 1, "a");
  EXPECT_EQ(job, folder_.read("a_job.toml"));
}

}  // namespace
}  // namespace retrace::test::outline_command_test
