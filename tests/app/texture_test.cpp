#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>

#include "tests/app/program.h"

// Tests of facet textures on the command line: measured maps that are refused, and warnings of models outside of their
// range.

namespace retrace::test::texture_test {
namespace {

namespace fs = std::filesystem;

const std::string kDesign =
    "[element]\nkind = \"rtp\"\nbase_mm = 0.5\nwidth_mm = 0.5\n[array]\narrangement = \"single\"\n[body]\n"
    "thickness_mm = 0.5\n[surface]\n";  // nine lines

std::string repeated(const std::string& line, int count) {
  std::string text;
  for (int k = 0; k < count; ++k) text += line;
  return text;
}

/// Returns a height map with points at a distance of 0.2 um. The heights alternate between 0 and `step_nm` every eight
/// points.
std::string stairs(int points, const std::string& step_nm) {
  std::string row;
  for (int k = 0; k < points; ++k) row += (k % 16 < 8 ? "0 " : step_nm + " ");
  return "pixel_um 0.2\nheight_unit nm\n" + repeated(row + "\n", points);
}

TEST(HeightMapOfADesign, BadFilesAreRefusedInOneLineThatNamesBoth) {
  const std::string row = "1 2 3 4 5 6 7 8 9\n";
  const std::string head = "pixel_um 0.2\nheight_unit nm\n";
  const std::vector<std::string> cases = {
      repeated(row, 9),
      "pixel_um 0.2\n" + repeated(row, 9),
      head + repeated("nan nan nan nan nan nan nan nan nan\n", 9),
      head + repeated(row, 8) + "1 2 3\n",
      "Gwyddion Simple Field 1.0\nXRes = 64\nYRes = 64\nXReal = 1e-5\nYReal = 1e-5\nZUnits = m\n" +
          std::string(2, '\0'),
      "",
      std::string("\x89PNG\r\n\x1a\n\0\0", 10),
      head + repeated(row, 7),
      head + repeated("5\n", 40),
      stairs(64, "90000"),
  };
  for (const std::string& content : cases)
    for (const std::string command : {"rre", "inspect"}) {
      SCOPED_TRACE(command + content.substr(0, 100));
      const TemporaryFolder folder;
      fs::create_directory(folder.path() / "parts");
      folder.write("parts/d.toml", kDesign + "height_map = \"m.txt\"\n");
      folder.write("parts/m.txt", content);
      const Arguments before = folder.names();
      const Outcome outcome = retrace(folder, {command, "parts/d.toml", "-o", "out", "--json", "r.json"});
      EXPECT_EQ(refused_at(outcome), "parts/d.toml:10: surface.height_map");
      EXPECT_EQ(folder.names(), before);
    }
}

TEST(HeightMapOfADesign, MissingFilesAreRefused) {
  const TemporaryFolder folder;
  folder.write("d.toml", kDesign + "height_map = \"none.gwy\"\n");
  const Outcome outcome = retrace(folder, {"rre", "d.toml", "-o", "out"});
  EXPECT_EQ(refused_at(outcome), "d.toml:10: surface.height_map");
  const Outcome given = retrace(folder, {"inspect", "d.toml", "--set", "surface.height_map=other.gwy", "-o", "out"});
  EXPECT_EQ(refused_at(given), "--set surface.height_map=other.gwy: surface.height_map");
  EXPECT_EQ(folder.names(), Arguments{"d.toml"});
}

TEST(HeightMapOfADesign, IsNotReplacedByAResult) {
  const TemporaryFolder folder;
  folder.write("d.toml", kDesign + "height_map = \"m.txt\"\n");
  const std::string map = stairs(16, "5");
  folder.write("m.txt", map);
  for (const std::string command : {"rre", "inspect"}) {
    const Outcome outcome = retrace(folder, {command, "d.toml", "--json", "m.txt"});
    EXPECT_EQ(outcome.code, 2) << outcome.err;
    EXPECT_EQ(folder.read("m.txt"), map);
  }
}

TEST(HeightMapOfADesign, IsQuotedInTheResult) {
  const TemporaryFolder folder;
  folder.write("d.toml",
               kDesign + "height_map = \"m.txt\"\nheight_map_horizontal_axis = \"y\"\nheight_map_form = \"poly2\"\n");
  folder.write("m.txt", stairs(32, "20"));
  const Json surface =
      Json::parse(retrace(folder, {"rre", "d.toml", "--samples=64", "--json", "-"}).out)["designs"][0]["surface"];
  EXPECT_EQ(surface["model"], "height_map");
  EXPECT_EQ(surface["height_map"], "m.txt");
  EXPECT_EQ(surface["height_map_horizontal_axis"], "y");
  EXPECT_EQ(surface["height_map_form"], "poly2");
}

TEST(HeightMapOfADesign, ExactEngineRefusesIt) {
  const TemporaryFolder folder;
  folder.write("d.toml", kDesign + "height_map = \"m.txt\"\n");
  folder.write("m.txt", stairs(16, "5"));
  const Outcome outcome = retrace(folder, {"rre", "d.toml", "--engine", "exact"});
  EXPECT_EQ(refused_at(outcome), "d.toml:10: surface.height_map");
}

// Each model warns if it is used outside of its range, on standard error and in the JSON documents of both commands.
// Tests of the models check which warnings these are.
TEST(TextureOfADesign, WarnsOutsideTheRangeOfEveryModel) {
  const TemporaryFolder folder;
  folder.write("steep.txt", stairs(64, "700"));
  folder.write("coarse.txt", "pixel_um 5\nheight_unit nm\n" + repeated("0 0 nan 0 0 1 0 0\n", 8));
  for (const std::string surface :
       {"roughness_sq_nm = 10\ncorrelation_length_um = 0.2\n", "roughness_sq_nm = 400\ncorrelation_length_um = 2\n",
        "roughness_sq_nm = 250\ncorrelation_length_um = 9\n", "waviness_sq_nm = 300\nwaviness_length_um = 5\n",
        "model = \"abg\"\nabg_a = 0.01\nabg_b = 1e-4\nabg_g = 2\n",
        "model = \"microfacet\"\nwaviness_sq_nm = 30\nwaviness_length_um = 80\n",
        "model = \"microfacet\"\nwaviness_sq_nm = 900\nwaviness_length_um = 10\n", "height_map = \"steep.txt\"\n",
        "height_map = \"coarse.txt\"\n"})
    for (const std::string command : {"rre", "inspect"}) {
      SCOPED_TRACE(command + ": " + surface);
      folder.write("d.toml", kDesign + surface);
      Arguments arguments = {command, "d.toml", "--json", "r.json"};
      if (command == "rre") arguments.emplace_back("--samples=64");
      const Outcome outcome = retrace(folder, arguments);
      ASSERT_EQ(outcome.code, 0) << outcome.err;
      const std::vector<std::string> warnings = warnings_of(outcome);
      EXPECT_EQ(folder.json("r.json")["warnings"], Json(warnings));
      EXPECT_TRUE(std::ranges::any_of(warnings, [](const std::string& text) { return text.starts_with("d.toml: "); }))
          << outcome.err;
    }
}

TEST(TextureOfADesign, InRangeIsSilent) {
  const TemporaryFolder folder;
  for (const std::string surface :
       {"roughness_sq_nm = 10\ncorrelation_length_um = 2\n", "waviness_sq_nm = 300\nwaviness_length_um = 80\n",
        "model = \"abg\"\nabg_a = 0.001\nabg_b = 1e-4\nabg_g = 2\n",
        "model = \"microfacet\"\nwaviness_sq_nm = 300\nwaviness_length_um = 80\n"}) {
    folder.write("d.toml", kDesign + surface);
    EXPECT_TRUE(retrace_json(folder, {"rre", "d.toml", "--samples=64"})["warnings"].empty()) << surface;
  }
}

TEST(TextureOfADesign, OutsideOfEveryModelIsRefused) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"roughness_sq_nm = 5000\ncorrelation_length_um = 2\n", "surface.roughness_sq_nm"},
      {"waviness_sq_nm = 5000\nwaviness_length_um = 2\n", "surface.waviness_sq_nm"},
      {"model = \"microfacet\"\nwaviness_sq_nm = 5000\nwaviness_length_um = 2\n", "surface.model"},
      {"model = \"abg\"\nabg_a = 9\nabg_b = 1e-4\nabg_g = 2\n", "surface.model"}};
  for (const auto& [surface, key] : cases)
    for (const std::string command : {"rre", "inspect"}) {
      const TemporaryFolder folder;
      folder.write("d.toml", kDesign + surface);
      const Outcome outcome = retrace(folder, {command, "d.toml", "-o", "out"});
      EXPECT_EQ(refused_at(outcome), "d.toml:10: " + key);
      EXPECT_EQ(folder.names(), Arguments{"d.toml"});
    }
}

}  // namespace
}  // namespace retrace::test::texture_test
