#include <gtest/gtest.h>

#include <string>

#include "tests/app/program.h"

// Tests of `retrace metrology`: values of the examples, its files, and refused input.

namespace retrace::test::metrology_test {
namespace {

const std::string kFacet = example("facet_height_map.txt");
const std::string kEdge = example("edge_profile.txt");

TEST(Metrology, MeasuresTheFacetOfTheExamples) {
  const TemporaryFolder folder;
  const Outcome outcome = retrace(folder, {"metrology", kFacet, "--feed-mm-per-min", "10", "--json", "-"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const Json json = Json::parse(outcome.out);
  EXPECT_EQ(json["schema"], "retrace.metrology/1");
  EXPECT_EQ(json["complete"], true);
  EXPECT_TRUE(json.contains("version"));
  EXPECT_TRUE(json["warnings"].is_array());
  EXPECT_EQ(json["columns"], 160);
  EXPECT_EQ(json["missing"], 25);
  EXPECT_EQ(json["form"], "plane");
  EXPECT_EQ(json["cutoff_um"], 80);
  for (const char* key : {"sa_nm", "sq_nm", "sz_nm", "ssk", "sku", "roughness_sa_nm", "waviness_sa_nm"})
    EXPECT_TRUE(json[key].is_number()) << key;
  ASSERT_EQ(json["dominant_per_mm"].size(), 2U);
  EXPECT_NEAR(json["dominant_per_mm"][0].get<double>(), 1000.0 / 150.0, 0.1);
  EXPECT_NEAR(json["dominant_per_mm"][1].get<double>(), 42.4, 0.1);
  EXPECT_NEAR(json["dominant"][1]["frequency_hz"].get<double>(), 7.07, 0.02);
  ASSERT_EQ(json["scratches"].size(), 1U);
  EXPECT_EQ(json["scratches"][0]["along"], "x");
  EXPECT_EQ(json["scratches"][0]["position_um"], 250);
  EXPECT_NEAR(json["surface"]["waviness_sq_nm"].get<double>(), 20.0, 0.4);
  EXPECT_NEAR(json["surface"]["waviness_length_um"].get<double>(), 150.0, 3.0);
  EXPECT_TRUE(folder.names().empty());
}

TEST(Metrology, FindsTheRadiusOfAnEdge) {
  const TemporaryFolder folder;
  const Json json = retrace_json(folder, {"metrology", kEdge, "--edge", "--cutoff-um", "20"});
  EXPECT_NEAR(json["edge"]["radius_um"].get<double>(), 12.0, 0.12);
  EXPECT_EQ(json["edge"]["better"], "radius");
  EXPECT_EQ(json["surface"].size(), 1U);
  EXPECT_NEAR(json["surface"]["root_radius_um"].get<double>(), 12.0, 0.12);
  EXPECT_FALSE(json.contains("y_pixel_um")) << "a profile";
}

TEST(Metrology, WritesItsFilesTheSameInEveryRun) {
  const TemporaryFolder folder;
  for (const std::string out : {"a", "b"})
    ASSERT_EQ(retrace(folder, {"metrology", kFacet, "--quiet", "-o", out}).code, 0);
  for (const std::string file : {"metrology.json", "surface.toml", "psd.csv", "metrology.svg", "metrology.png"})
    EXPECT_EQ(folder.read("a/" + file), folder.read("b/" + file)) << file;
  EXPECT_EQ(folder.names().size(), 12U);
  EXPECT_TRUE(
      folder.read("a/surface.toml").starts_with("[surface]  # measured: facet_height_map.txt, cut-off 80 um\n"));
  EXPECT_TRUE(folder.read("a/psd.csv").starts_with("direction,frequency_per_mm,psd,unit\nx,"));
  const Outcome table = retrace(folder, {"metrology", kFacet});
  EXPECT_NE(table.out.find(folder.read("a/surface.toml")), std::string::npos) << table.out;
}

TEST(Metrology, TakesFormAndCutoff) {
  const TemporaryFolder folder;
  folder.write("parabola.txt", [] {
    std::string text = "pixel_um 1\nheight_unit nm\n";
    for (int i = 0; i < 300; ++i) text += std::to_string(i * i) + "\n";
    return text;
  }());
  const Json plane = Json::parse(retrace(folder, {"metrology", "parabola.txt", "--json", "-"}).out);
  const Json second = Json::parse(retrace(folder, {"metrology", "parabola.txt", "--form=poly2", "--json", "-"}).out);
  const Json none = Json::parse(retrace(folder, {"metrology", "parabola.txt", "--form=none", "--json", "-"}).out);
  EXPECT_LT(second["sq_nm"].get<double>(), 1e-6);
  EXPECT_LT(plane["sq_nm"].get<double>(), 0.5 * none["sq_nm"].get<double>());
}

TEST(Metrology, RefusesBadFilesAndOptionsInOneLine) {
  const TemporaryFolder folder;
  const std::string row = "1 2 3 4 5 6 7 8\n";
  folder.write("bare.txt", row + row);
  folder.write("good.txt", "pixel_um 1\nheight_unit nm\n" + row + row);
  folder.write("ragged.txt", "pixel_um 1\nheight_unit nm\n" + row + "1 2\n");
  folder.write("holes.txt", "pixel_um 1\nheight_unit nm\nnan nan nan nan nan nan nan nan\n");
  folder.write("picture.png", std::string("\x89PNG\r\n\x1a\n\0\0", 10));
  folder.write("short.gsf", "Gwyddion Simple Field 1.0\nXRes = 8\nYRes = 90000000\n" + std::string(1, '\0'));
  const std::vector<Refused> cases = {
      {{"missing.txt"}, "missing.txt"},
      {{"bare.txt"}, "bare.txt"},
      {{"bare.txt", "--pixel-um", "1"}, "bare.txt"},
      {{"ragged.txt"}, "ragged.txt:4"},
      {{"holes.txt"}, "holes.txt"},
      {{"picture.png"}, "picture.png"},
      {{"short.gsf"}, "short.gsf:2"},
      {{"good.txt", "--form", "sphere"}, "--form"},
      {{"good.txt", "--cutoff-um", "0"}, "--cutoff-um"},
      {{"good.txt", "--cutoff-um", "1.5"}, "good.txt: --cutoff-um"},
      {{"good.txt", "--cutoff-um", "nan"}, "--cutoff-um"},
      {{"good.txt", "--pixel-um", "0"}, "--pixel-um"},
      {{"good.txt", "--pixel-um", "1,2,3"}, "--pixel-um"},
      {{"good.txt", "--feed-mm-per-min", "-1"}, "--feed-mm-per-min"},
      {{"good.txt", "--height-unit", "inch"}, "--height-unit"},
      {{"good.txt", "--edge", "--cutoff-um", "4"}, "good.txt: --edge"},
      {{"good.txt", "--set", "a=1"}, "--set"},
      {{}, ""},
  };
  expect_refused(folder, cases, {"metrology"});
}

TEST(Metrology, DoesNotReplaceWhatItReads) {
  const TemporaryFolder folder;
  const std::string text = read_text(kEdge);
  folder.write("e.txt", text);
  const Outcome outcome = retrace(folder, {"metrology", "e.txt", "--json", "e.txt"});
  EXPECT_EQ(outcome.code, 2) << outcome.err;
  EXPECT_EQ(folder.read("e.txt"), text);
}

}  // namespace
}  // namespace retrace::test::metrology_test
