#include <gtest/gtest.h>

#include "tests/app/program.h"

// Tests of the command `retrace explore`. The browser test checks the behaviour of the page, and tests/live/ checks its
// engine.

namespace retrace::test::explore_command_test {
namespace {

constexpr std::size_t kMaxBytes = 3'000'000;

const std::string kDesign =
    "# </script><script>\xc3\xa9\r\n[element]\nkind = \"rtp\"\nbase_mm = 1\nwidth_mm = 1\n[array]\nextent = "
    "\"infinite\"\n[body]\nthickness_mm = 1 # end";

/// Returns the initial state of a page as JSON.
Json start_of(const std::string& html) {
  const std::string head = "id=\"start\">";
  const std::size_t begin = html.find(head) + head.size();
  return Json::parse(html.substr(begin, html.find("</script>", begin) - begin));
}

void expect_to_stand_alone(const std::string& html) {
  EXPECT_TRUE(html.starts_with("<!DOCTYPE html>"));
  EXPECT_LT(html.size(), kMaxBytes);
  EXPECT_NE(html.find("default-src 'none'"), std::string::npos) << "it may ask the network for nothing";
  for (const char* const loads : {"src=\"", "href=\"http", "@import", "url(http"})
    EXPECT_EQ(html.find(loads), std::string::npos) << loads;
  for (const char* const part : {"id=\"engine-wasm\"", "id=\"engine-js\"", "Permission is hereby granted", "musl"})
    EXPECT_NE(html.find(part), std::string::npos) << part;
}

TEST(Explore, WritesOnePageThatStandsAlone) {
  const TemporaryFolder folder;
  const Outcome outcome = retrace(folder, {"explore", "-o", "page.html"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  expect_to_stand_alone(folder.read("page.html"));
  EXPECT_FALSE(start_of(folder.read("page.html")).contains("toml")) << "templates";
  EXPECT_EQ(folder.names(), Arguments{"page.html"});
  EXPECT_EQ(retrace(folder, {"explore"}).out, folder.read("page.html"));
}

TEST(Explore, BeginsWithTheDesignByteForByte) {
  const TemporaryFolder folder;
  folder.write("my design.toml", kDesign);
  const Outcome outcome = retrace(folder, {"explore", "my design.toml", "-o", "page.html"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  const std::string html = folder.read("page.html");
  expect_to_stand_alone(html);
  EXPECT_EQ(start_of(html)["toml"], kDesign);
  EXPECT_EQ(start_of(html)["source"], "my design.toml");
  EXPECT_FALSE(start_of(html)["embedded"]);
  // The design comes from standard input, and one key is changed.
  const Outcome changed = retrace(folder, {"explore", "-", "--set", "element.base_mm=2"}, kDesign);
  EXPECT_EQ(changed.code, 0) << changed.err;
  EXPECT_NE(start_of(changed.out)["toml"].get<std::string>().find("base_mm = 2"), std::string::npos);
}

TEST(Explore, SaysWhatItWrote) {
  const TemporaryFolder folder;
  const Json json = retrace_json(folder, {"explore", example("rtp_single_0p45mm.toml"), "-o", "page.html"});
  EXPECT_EQ(json.at("schema"), "retrace.explore/1");
  EXPECT_EQ(json.at("file"), "page.html");
  EXPECT_EQ(json.at("bytes"), folder.read("page.html").size());
}

TEST(Explore, RefusesWhatAPageCannotHave) {
  const TemporaryFolder folder;
  folder.write("bad.toml", "[element]\nkind = \"rtp\"\nbase_mm = -3\n");
  const std::string mesh = "[part]\nmesh = \"part.stl\"\n[body]\nthickness_mm = 1\n";
  folder.write("mesh.toml", mesh);
  const auto refused = [&](const Arguments& arguments, const std::string& place) {
    EXPECT_EQ(refused_at(retrace(folder, arguments)), place);
    EXPECT_EQ(folder.names(), (Arguments{"bad.toml", "mesh.toml"}));
  };
  refused({"explore", "bad.toml", "-o", "page.html"}, "bad.toml:3: element.base_mm");
  refused({"explore", "mesh.toml", "-o", "page.html"}, "mesh.toml:2: part.mesh");
  refused({"explore", "--set", "element.base_mm=1", "-o", "page.html"}, "--set");
  EXPECT_EQ(retrace(folder, {"explore", "mesh.toml", "-o", "mesh.toml"}).code, 2);
  EXPECT_EQ(folder.read("mesh.toml"), mesh);
}

/// A page of `retrace report` contains the page of `retrace explore` as a section, unless the design refers to files.
TEST(Explore, IsASectionOfReports) {
  const TemporaryFolder folder;
  ASSERT_EQ(
      retrace(folder, {"rre", example("rtp_single_0p45mm.toml"), "--engine", "exact", "-o", "results", "--quiet"}).code,
      0);
  ASSERT_EQ(retrace(folder, {"report", "results"}).code, 0);
  const std::string html = folder.read("results/report.html");
  EXPECT_LT(html.size(), kMaxBytes);
  EXPECT_NE(html.find("<div id=\"live\"></div>"), std::string::npos);
  const Json start = start_of(html);
  EXPECT_TRUE(start["embedded"]);
  folder.write("again.toml", start["toml"]);
  EXPECT_EQ(retrace_json(folder, {"rre", "again.toml", "--engine", "exact"})["points"][0]["rre"],
            folder.json("results/rre.json")["points"][0]["rre"]);
}

}  // namespace
}  // namespace retrace::test::explore_command_test
