#include <gtest/gtest.h>

#include <string>

#include "tests/app/program.h"

// Tests of `retrace roughness`: its files, the shipped facets, and refused input.

namespace retrace::test::roughness_test {
namespace {

const std::string kDesign =
    "title = \"Brick\"\n[element]\nkind = \"rtp\"\nbase_mm = 0.45\nwidth_mm = 0.45\n[array]\narrangement = \"offset\"\n"
    "extent = \"infinite\"\n[body]\nthickness_mm = 2\n";

/// Fixture with a folder that contains the design d.toml.
class Roughness : public ::testing::Test {
 protected:
  Roughness() { folder.write("d.toml", kDesign); }

  const TemporaryFolder folder;
};

TEST_F(Roughness, PutsTheShippedFacetsBesideTheCurves) {
  const Outcome outcome = retrace(folder, {"roughness", "d.toml", "--sa", "0,10,20", "--correlation-length-um", "5,50",
                                           "--samples", "16384", "--json", "-"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const Json json = Json::parse(outcome.out);
  EXPECT_EQ(json["schema"], "retrace.roughness/1");
  EXPECT_EQ(json["complete"], true);
  EXPECT_TRUE(json.contains("version"));
  EXPECT_EQ(json["correlation_length_um"], (Json{5, 50}));
  EXPECT_EQ(json["waviness_length_um"], 200);
  ASSERT_EQ(json["points"].size(), 6U);
  EXPECT_EQ(json["points"][0]["rre"], json["smooth"]["rre"]);
  ASSERT_EQ(json["measured"].size(), 14U);
  EXPECT_EQ(json["measured"][0]["name"], "pin");
  EXPECT_EQ(json["measured"][0]["facets"], 12);
  EXPECT_EQ(json["measured"][13]["name"], "F10");
  EXPECT_GT(json["measured"][0]["rre"].get<double>(), 0.95) << "the smoothest process";
  EXPECT_LT(json["measured"][3]["rre"].get<double>(), 0.7) << "the roughest";
  EXPECT_LT(json["measured"][2]["rre"].get<double>(), json["measured"][1]["rre"].get<double>())
      << "as rough as the die, but with twice its waviness";
}

TEST_F(Roughness, WritesItsFilesTheSameInEveryRun) {
  folder.write("facets.csv", "process,roughness_sa_nm,waviness_sa_nm\nmine,8,30\nmine,10,50\n");
  for (const std::string out : {"a", "b"})
    ASSERT_EQ(
        retrace(folder, {"roughness", "d.toml", "--sa=0,10", "--correlation-length-um=5", "--facets", "facets.csv",
                         "--samples=4096", "--quiet", "-o", out, "--threads", out == "a" ? "1" : "3"})
            .code,
        0);
  for (const std::string file : {"roughness.csv", "roughness.svg", "roughness.png"})
    EXPECT_EQ(folder.read("a/" + file), folder.read("b/" + file)) << file;
  EXPECT_EQ(without_elapsed(folder.read("a/roughness.json")), without_elapsed(folder.read("b/roughness.json")));
  const std::vector<std::string> lines = lines_of(folder.read("a/roughness.csv"));
  ASSERT_EQ(lines.size(), 4U);
  EXPECT_EQ(lines[0], "name,facets,correlation_length_um,roughness_sa_nm,waviness_sa_nm,rre,std_error");
  EXPECT_TRUE(lines[1].starts_with(",,5,0,0,")) << lines[1];
  EXPECT_TRUE(lines[3].starts_with("mine,2,5,9,40,")) << lines[3];
}

TEST_F(Roughness, RefusesBadInputInOneLine) {
  folder.write("bad.csv", "facet,sa_nm\nF1,smooth\n");
  const std::vector<Refused> cases = {
      {{"d.toml", "--facets", "bad.csv"}, "bad.csv:2: sa_nm"},
      {{"d.toml", "--facets", "none.csv"}, "none.csv"},
      {{"d.toml", "--sa", "-3"}, "--sa"},
      {{"d.toml", "--sa", "x"}, "--sa"},
      {{"d.toml", "--correlation-length-um", "0"}, "--correlation-length-um"},
      {{"d.toml", "--waviness-length-um", "nan"}, "--waviness-length-um"},
      {{"d.toml", "--incidence", "90"}, "--incidence"},
      {{"d.toml", "--azimuth", "inf"}, "--azimuth"},
      {{"d.toml", "--target-error", "0"}, "--target-error"},
      {{"d.toml", "--set", "surface.roughness_sq_nm=3", "--set", "surface.correlation_length_um=3"},
       "--set surface.roughness_sq_nm=3: surface.roughness_sq_nm"},
      {{"none.toml"}, "none.toml"},
      {{}, ""},
  };
  expect_refused(folder, cases, {"roughness"});
}

TEST_F(Roughness, DoesNotReplaceWhatItReads) {
  folder.write("f.csv", "sa_nm\n3\n");
  EXPECT_EQ(retrace(folder, {"roughness", "d.toml", "--facets", "f.csv", "--json", "f.csv"}).code, 2);
  EXPECT_EQ(folder.read("f.csv"), "sa_nm\n3\n");
}

}  // namespace
}  // namespace retrace::test::roughness_test
