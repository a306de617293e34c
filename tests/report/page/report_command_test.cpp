#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <numbers>

#include "tests/app/program.h"

// Tests of the command `retrace report`. The browser test checks the appearance of the page.

namespace retrace::test::report_command_test {
namespace {

namespace fs = std::filesystem;

void make_results(const TemporaryFolder& folder) {
  ASSERT_EQ(retrace(folder, {"rre", example("rtp_single_0p45mm.toml"), "--engine", "exact", "--incidence=0,20", "-o",
                             "results", "--quiet"})
                .code,
            0);
}

TEST(Report, IsWrittenBesideTheResultsOrWhereOneSays) {
  const TemporaryFolder folder;
  make_results(folder);
  const Outcome outcome = retrace(folder, {"report", "results"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("wrote results/report.html"), std::string::npos);
  EXPECT_EQ(retrace(folder, {"report", "results", "-o", "page.html"}).code, 0);
  EXPECT_EQ(retrace(folder, {"report", "results", "-o", "pages"}).code, 0);
  const std::string html = folder.read("results/report.html");
  EXPECT_EQ(html, folder.read("page.html")) << "the same results give the same page";
  EXPECT_EQ(html, folder.read("pages/report.html"));
  EXPECT_TRUE(html.starts_with("<!DOCTYPE html>"));
  EXPECT_EQ(html.find("src=\"http"), std::string::npos);
  EXPECT_EQ(html.find("href=\"http"), std::string::npos);
  EXPECT_NE(html.find("Permission is hereby granted"), std::string::npos) << "licences of the scripts";
}

/// The folder of results may contain links that somebody else has created. retrace does not write through such a link.
/// It follows a link only if the user names this link as the output.
TEST(Report, FollowsNoLinkInPlaceOfThePage) {
  const TemporaryFolder folder;
  make_results(folder);
  folder.write("victim", "precious");
  fs::create_directory(folder.path() / "pages");
  for (const std::string place : {"results", "pages"}) {
    const fs::path page = folder.path() / place / "report.html";
    for (const std::string target : {"../victim", "../new"}) {
      fs::create_symlink(target, page);
      const std::vector<std::string> names = folder.names();
      const Outcome outcome = retrace(
          folder, place == "results" ? Arguments{"report", "results"} : Arguments{"report", "results", "-o", "pages"});
      EXPECT_EQ(refused_at(outcome, 3), place + "/report.html");
      EXPECT_EQ(folder.read("victim"), "precious");
      EXPECT_EQ(folder.names(), names);
      fs::remove(page);
    }
  }
  fs::create_symlink("victim", folder.path() / "page.html");
  EXPECT_EQ(retrace(folder, {"report", "results", "-o", "page.html"}).code, 0);
  EXPECT_TRUE(folder.read("victim").starts_with("<!DOCTYPE html>"));
}

TEST(Report, SaysWhatIsInIt) {
  const TemporaryFolder folder;
  make_results(folder);
  const Json json = retrace_json(folder, {"report", "results", "--title", "Mine"});
  EXPECT_EQ(json.at("schema"), "retrace.report/1");
  EXPECT_EQ(json.at("title"), "Mine");
  EXPECT_EQ(json.at("documents"), Json::array({"rre.json"}));
  EXPECT_GE(json.at("light_paths"), 2);
  EXPECT_LT(json.at("bytes"), 3'000'000);
}

TEST(Report, TakesResultsInFoldersOfTheFolder) {
  const TemporaryFolder folder;
  make_results(folder);
  fs::create_directory(folder.path() / "study");
  fs::rename(folder.path() / "results", folder.path() / "study/optics");
  EXPECT_EQ(retrace_json(folder, {"report", "study"}).at("documents"), Json::array({"optics/rre.json"}));
}

/// Returns the data of a page: its charts and the scene of its 3D view.
Json data_of(const std::string& html) {
  const std::size_t begin = html.find("id=\"page-data\">") + 15;
  return Json::parse(html.substr(begin, html.find("</script>", begin) - begin));
}

TEST(Report, ShowsDrawingsAndPictures) {
  const TemporaryFolder folder;
  const std::string design = example("rtp_brick_2mm.toml");
  ASSERT_EQ(retrace(folder, {"inspect", design, "-o", "study/design", "--quiet"}).code, 0);
  const Outcome made =
      retrace(folder, {"image", design, "--detector", "--pixels", "40", "-o", "study/maps", "--quiet"});
  ASSERT_EQ(made.code, 0) << made.err;
  ASSERT_EQ(retrace(folder, {"report", "study"}).code, 0);
  const std::string html = folder.read("study/report.html");
  for (const char* text : {"Plan: the part seen from the light", "Section across the elements", "seen from behind",
                           "Irradiance divided by that of the beam", "per steradian"})
    EXPECT_NE(html.find(text), std::string::npos) << text;
  EXPECT_NE(html.find("data:image/svg+xml;base64,"), std::string::npos);
}

/// Views and sections show parts from a mesh and parts from a table of facets.
TEST(Report, TakesMeshesAndTablesOfFacets) {
  const TemporaryFolder folder;
  const std::string shape =
      "[element]\nkind = \"rtp\"\nbase_mm = 1\nwidth_mm = 1\n[array]\nx_length_mm = 2\ny_length_mm = 1\n";
  const std::string body = "[body]\nthickness_mm = 1\nrefractive_index = 1.5\n";
  folder.write("d.toml", shape + body);
  ASSERT_EQ(retrace(folder, {"export", "d.toml", "part.stl"}).code, 0);
  folder.write("mesh.toml", "[part]\nmesh = \"part.stl\"\n[body]\nrefractive_index = 1.5\n");
  // The table describes one of the two prisms, 20 um deeper than nominal.
  folder.write("planes.csv", "x_mm,y_mm,facet,height_mm,x_slope,y_slope\n0.5,0.5,1,-0.52,-1,0\n0.5,0.5,2,-0.52,1,0\n");
  folder.write("facets.toml", shape + "[part]\nfacets = \"planes.csv\"\n" + body);
  for (const std::string name : {"mesh", "facets"}) {
    ASSERT_EQ(retrace(folder, {"inspect", name + ".toml", "-o", name, "--quiet"}).code, 0) << name;
    ASSERT_EQ(retrace(folder, {"report", name, "--read", "part.stl", "--read", "planes.csv"}).code, 0) << name;
    const Json data = data_of(folder.read(name + "/report.html"));
    EXPECT_GT(data["scene"]["triangles"].size(), 8U) << name;
    EXPECT_GE(data["scene"]["paths"].size(), 1U) << name;
  }
  // Expected volume: the plate, a prism of 1 mm x 0.5 mm / 2 x 1 mm, and a step of 20 um below it.
  const Json solid = retrace_json(folder, {"export", "facets.toml", "facets.stl"});
  EXPECT_NEAR(solid["volume_mm3"].get<double>(), 2.0 * 1.0 * 1.0 + 0.25 + 0.02, 1e-9);
  EXPECT_NEAR(retrace_json(folder, {"export", "mesh.toml", "again.stl"})["volume_mm3"].get<double>(), 2.5, 1e-5);
}

/// The view shows elements on their substrate, and it shows scratches.
TEST(Report, ShowsBasesAndScratches) {
  const TemporaryFolder folder;
  const std::string array =
      "[element]\nkind = \"rtp\"\nbase_mm = 1\nwidth_mm = 1\n[array]\nx_length_mm = 4\ny_length_mm = 4\n"
      "[body]\nthickness_mm = 1\nrefractive_index = 1.5\n";
  folder.write("flat.toml", array);
  folder.write("inclined.toml",
               array + "[substrate]\nkind = \"plane\"\nincline_deg = 20\nelement_axes = \"parallel\"\n");
  folder.write("scratched.toml",
               array + "[surface]\nscratches = [{facet = \"-x\", position_um = 0, width_um = 20, depth_um = 5}]\n");
  std::map<std::string, double> lowest;
  std::map<std::string, std::size_t> triangles;
  for (const std::string name : {"flat", "inclined", "scratched"}) {
    ASSERT_EQ(retrace(folder, {"inspect", name + ".toml", "-o", name, "--quiet"}).code, 0) << name;
    ASSERT_EQ(retrace(folder, {"report", name}).code, 0) << name;
    const Json scene = data_of(folder.read(name + "/report.html"))["scene"];
    for (const Json& vertex : scene["vertices"]) lowest[name] = std::min(lowest[name], vertex[2].get<double>());
    triangles[name] = scene["triangles"].size();
  }
  EXPECT_NEAR(lowest["flat"], -0.5, 1e-6);
  // The roof edges run across the slope. The centre of the last roof edge is 3.5 mm from the highest position.
  EXPECT_NEAR(lowest["inclined"], -0.5 - 3.5 * std::tan(20.0 * std::numbers::pi / 180.0), 1e-6);
  EXPECT_GT(triangles["scratched"], triangles["flat"] + 16);
}

TEST(Report, FoldersWithoutResultsAreRefused) {
  const TemporaryFolder folder;
  EXPECT_EQ(refused_at(retrace(folder, {"report", "nothing"})), "nothing");
  folder.write("file.txt", "x");
  EXPECT_EQ(refused_at(retrace(folder, {"report", "file.txt"})), "file.txt");
  fs::create_directory(folder.path() / "empty");
  EXPECT_EQ(refused_at(retrace(folder, {"report", "empty"})), "empty");
  folder.write("empty/other.json", "{\"schema\": \"somebody/1\"}");
  folder.write("empty/list.json", "[1, 2]");
  folder.write("empty/broken.json", "{");
  EXPECT_EQ(refused_at(retrace(folder, {"report", "empty"})), "empty");
  folder.write("empty/rre.json", "{\"schema\": \"retrace.rre/1\", \"points\": [");
  EXPECT_EQ(refused_at(retrace(folder, {"report", "empty"})), "empty/rre.json");
  EXPECT_FALSE(fs::exists(folder.path() / "empty/report.html"));
}

TEST(Report, DesignsThatCannotBeShownAreLeftOutWithAWarning) {
  const TemporaryFolder folder;
  fs::create_directory(folder.path() / "d");
  folder.write("d/rre.json",
               R"({"schema": "retrace.rre/1", "designs": [{"element": {"kind": "cone"}}], "points": []})");
  const Outcome outcome = retrace(folder, {"report", "d"});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_EQ(warnings_of(outcome).size(), 1U) << outcome.err;
  EXPECT_NE(folder.read("d/report.html").find("cannot be shown here"), std::string::npos);
}

/// Returns a result document whose design names `file` in `key` of `table`.
std::string document_naming(const std::string& table, const std::string& key, const std::string& file) {
  Json design = {{"source", "d.toml"},
                 {"element", {{"kind", "rtp"}, {"base_mm", 1}, {"width_mm", 1}}},
                 {"array", {{"x_length_mm", 2}, {"y_length_mm", 1}}},
                 {"body", {{"thickness_mm", 1}, {"refractive_index", 1.5}}}};
  if (key == "mesh" && table == "part") {
    design.erase("element");
    design.erase("array");
    design["body"].erase("thickness_mm");
  }
  if (table == "body") design["body"].erase("refractive_index");
  design[table][key] = file;
  return Json{{"schema", "retrace.rre/1"}, {"designs", {design}}, {"points", Json::array()}}.dump();
}

/// retrace does not open a file outside of the folder of results if only a design names it, for any key and path. The
/// content of such a file appears neither in the page, nor in the document, nor on the terminal.
TEST(Report, ReadsNoFileThatOnlyADocumentNames) {
  const TemporaryFolder folder;
  const std::string secret = "swordfish";
  folder.write("secret", secret + ":x:0:0\n");
  folder.write("secret.yml", secret + ": [\n");
  fs::create_directory(folder.path() / "r");
  fs::create_symlink("../secret", folder.path() / "r/link");
  ASSERT_EQ(::mkfifo((folder.path() / "pipe").c_str(), 0600), 0);
  struct Case {
    std::string table;
    std::string key;
    std::string file;
  };
  const std::vector<Case> cases = {{"part", "mesh", "secret"},
                                   {"part", "mesh", (folder.path() / "secret").string()},
                                   {"part", "mesh", "r/link"},
                                   {"part", "mesh", "r/../secret"},
                                   {"part", "mesh", "pipe"},
                                   {"part", "mesh", "/dev/zero"},
                                   {"part", "facets", "secret"},
                                   {"array", "mask", "secret"},
                                   {"entrance_surface", "mesh", "secret"},
                                   {"entrance_surface", "turned_part", "secret"},
                                   {"body", "catalogue", "secret.yml"},
                                   {"light", "spectrum", "secret.csv"}};
  for (const auto& [table, key, file] : cases) {
    SCOPED_TRACE(testing::Message() << table << '.' << key << " = " << file);
    folder.write("r/rre.json", document_naming(table, key, file));
    const Outcome outcome = retrace(folder, {"report", "r", "--json", "-"});
    EXPECT_EQ(outcome.code, 0);
    EXPECT_EQ(warnings_of(outcome).size(), 1U) << outcome.err;
    EXPECT_NE(outcome.err.find(table + "." + key + ": "), std::string::npos) << outcome.err;
    for (const std::string& text : {outcome.out, outcome.err, folder.read("r/report.html")})
      EXPECT_EQ(text.find(secret), std::string::npos);
  }
}

/// Results and pictures that are links to files outside of the folder are left out, unless the user names these files.
TEST(Report, FollowsNoLinkOutOfTheFolder) {
  const TemporaryFolder folder;
  make_results(folder);
  const std::string secret = "swordfish";
  folder.write("other.json", R"({"schema": "retrace.rre/1", "warnings": ["swordfish"], "points": []})");
  fs::create_directory(folder.path() / "elsewhere");
  folder.write("elsewhere/inner.json", R"({"schema": "retrace.rre/1", "warnings": ["swordfish"], "points": []})");
  fs::create_symlink("../other.json", folder.path() / "results/link.json");
  fs::create_directory_symlink("../elsewhere", folder.path() / "results/sub");
  Outcome outcome = retrace(folder, {"report", "results"});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_EQ(warnings_of(outcome).size(), 2U) << outcome.err;
  EXPECT_NE(outcome.err.find("link.json: "), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("sub/inner.json: "), std::string::npos) << outcome.err;
  EXPECT_EQ(folder.read("results/report.html").find(secret), std::string::npos);
  outcome = retrace(folder, {"report", "results", "--read", "elsewhere", "--read", "other.json"});
  EXPECT_EQ(outcome.err, "");
  EXPECT_NE(folder.read("results/report.html").find(secret), std::string::npos);
  fs::create_symlink("results", folder.path() / "by_link");
  EXPECT_EQ(retrace_json(folder, {"report", "by_link", "--read", "elsewhere"}).at("documents").size(), 2U);
  EXPECT_EQ(refused_at(retrace(folder, {"report", "results", "--read", "none"})), "--read");
}

TEST(Report, SetIsRefusedAndOutputsAreKeptApart) {
  const TemporaryFolder folder;
  make_results(folder);
  EXPECT_EQ(refused_at(retrace(folder, {"report", "results", "--set", "a.b=1"})), "--set");
  EXPECT_EQ(refused_at(retrace(folder, {"report", "results", "--json", "results/report.html"})), "--json");
  EXPECT_EQ(retrace(folder, {"report", "results", "-o", "results/rre.csv/x.html"}).code, 3);
}

}  // namespace
}  // namespace retrace::test::report_command_test
