#include "report/page/page.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "report/page/sections.h"
#include "report/page/setup_page.h"

namespace retrace::report::page_test {
namespace {

const PageAssets kAssets = {"/* script */", "/* style */", "licence"};

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
  return found;
}

ResultDocument document(const std::string& kind, nlohmann::ordered_json json) {
  json["schema"] = "retrace." + kind + "/1";
  return {kind + ".json", kind, 100, std::move(json)};
}

TEST(Page, TextsAreTextsWhateverTheyHold) {
  const std::string nasty = "</script><script>alert(1)</script>&\"'";
  Page page;
  page.title = nasty;
  PageSection section;
  section.id = "s0";
  section.title = nasty;
  section.paragraphs = {nasty};
  section.facts = {{nasty, nasty}};
  section.tables = {{nasty, {nasty}, {{PageCell(nasty)}}, nasty, 0}};
  section.charts = {{nasty, nasty, nasty, {{nasty, {1.0}, {2.0}, {}}}, {}, {}}};
  section.details = {{nasty, nasty}};
  section.has_scene = true;
  page.sections = {section};
  page.scene = SceneView{{{0, 0, 0}}, {}, {}, {{nasty, {{0, 0, 0}}, {nasty}}}};
  const std::string html = page_html(page, kAssets);
  EXPECT_EQ(count(html, "<script"), 2U);  // the data and the script of the page
  EXPECT_EQ(count(html, "</script"), 2U);
  EXPECT_EQ(count(html, "alert(1)</script"), 0U);
  // The data of the page must contain the texts unchanged.
  const std::size_t begin = html.find("id=\"page-data\">") + 15;
  const auto data = nlohmann::json::parse(html.substr(begin, html.find("</script>", begin) - begin));
  EXPECT_EQ(data["charts"][0]["title"], nasty);
  EXPECT_EQ(data["scene"]["paths"][0]["events"][0], nasty);
}

TEST(Page, HasThePolicyOfTheLivePage) {
  const std::string begin = "<meta http-equiv=\"Content-Security-Policy\" content=\"";
  const auto policy_of = [&](const std::string& html) {
    EXPECT_EQ(count(html, begin), 1U);
    EXPECT_LT(html.find(begin), html.find("<style")) << "it holds for what comes after it";
    const std::size_t at = html.find(begin) + begin.size();
    return html.substr(at, html.find('"', at) - at);
  };
  const std::string policy = policy_of(live_html({}, "T", kAssets));
  EXPECT_TRUE(policy.starts_with("default-src 'none';")) << policy;
  EXPECT_EQ(policy_of(page_html({}, kAssets)), policy);
  EXPECT_EQ(policy_of(setup_html({})), policy);
}

TEST(Page, CellsShowSixDigitsAndKeepAll) {
  EXPECT_EQ(PageCell(1.0 / 3.0).text, "0.333333");
  EXPECT_EQ(PageCell(1.0 / 3.0).full, "0.3333333333333333");
  EXPECT_EQ(PageCell(0.5).full, "");
  EXPECT_EQ(PageCell(-0.0).text, "0");
  EXPECT_EQ(PageCell(NAN).text, "");
}

TEST(Page, PicturesAreHeldInThePage) {
  Page page;
  PageSection section;
  section.id = "s0";
  for (const std::string bytes : {"M", "Ma", "Man"}) section.figures.push_back({"c", "", "image/png", bytes, "alt"});
  page.sections = {section};
  const std::string html = page_html(page, kAssets);
  for (const std::string text : {"base64,TQ==\"", "base64,TWE=\"", "base64,TWFu\""}) EXPECT_EQ(count(html, text), 1U);
}

TEST(StudyPage, CurvesAreSplitByAzimuthAndGoOverIncidence) {
  nlohmann::ordered_json json = {{"designs", {{{"title", "A"}}}}, {"points", nlohmann::ordered_json::array()}};
  for (const double azimuth : {0.0, 90.0})
    for (const double incidence : {0.0, 10.0})
      json["points"].push_back({{"design", 0},
                                {"incidence_deg", incidence},
                                {"azimuth_deg", azimuth},
                                {"acceptance_half_angle_deg", 0.5},
                                {"rre", 0.01 * (incidence + azimuth)},
                                {"std_error", 0},
                                {"ledger", {{"absorbed", 0.25}, {"lost", 0}}}});
  const Page page = study_page({"x", {document("rre", json)}, {}}, "");
  EXPECT_EQ(page.title, "A");
  const auto section = std::find_if(page.sections.begin(), page.sections.end(),
                                    [](const PageSection& s) { return s.title == "Efficiency"; });
  ASSERT_NE(section, page.sections.end());
  ASSERT_EQ(section->charts.size(), 1U);
  ASSERT_EQ(section->charts[0].series.size(), 2U);
  EXPECT_EQ(section->charts[0].series[1].label, "azimuth 90°");
  EXPECT_EQ(section->charts[0].series[1].x, (std::vector<double>{0.0, 10.0}));
  EXPECT_NEAR(section->charts[0].series[1].y[1], 100.0, 1e-9);
  ASSERT_EQ(section->tables.size(), 1U);
  EXPECT_EQ(section->tables[0].rows.size(), 4U);
  EXPECT_EQ(section->tables[0].columns[6], "absorbed (%)");
  EXPECT_EQ(section->tables[0].rows[0][6].text, "25");
  // The summary shows 0 % at normal incidence and 100 % at an incidence of 10 degrees and an azimuth of 90 degrees.
  EXPECT_EQ(page.sections[0].facts[0].value, "0.00 %");
  EXPECT_EQ(page.sections[0].facts[1].value, "100.00 %");
}

const PageSection* section_called(const Page& page, const std::string& title) {
  for (const PageSection& section : page.sections)
    if (section.title == title) return &section;
  return nullptr;
}

TEST(StudyPage, PicturesStandBesideTheirFigures) {
  ResultFolder folder{"x", {}, {}};
  const auto add = [&](const std::string& place, const nlohmann::ordered_json& json,
                       const std::vector<std::string>& pictures) {
    folder.documents.push_back(document("image", json));
    folder.documents.back().name = place + "/image.json";
    for (const std::string& name : pictures) folder.pictures.push_back({place + "/" + name, "image/png", "bytes"});
  };
  add("camera",
      {{"kind", "camera"},
       {"part_luminance_cd_per_m2", 12.5},
       {"part_std_error_cd_per_m2", 0.25},
       {"observation_deg", 0.33}},
      {"camera.png", "false_colour.png", "other.png"});
  add("maps", {{"kind", "detector"}, {"rre", 0.889}}, {"irradiance.png", "angular.png"});
  add("night",
      {{"kind", "road"},
       {"views",
        {{{"distance_m", 10},
          {"reflectors",
           {{{"luminance_cd_per_m2", 3.5}, {"observation_deg", {1, 2}}, {"r_a_cd_per_lx_m2", {4, 5}}},
            {{"luminance_cd_per_m2", 7.5}}}}}}}},
      {"road.png"});
  const Page page = study_page(folder, "T");
  const PageSection* const camera = section_called(page, "Camera");
  ASSERT_NE(camera, nullptr);
  ASSERT_EQ(camera->figures.size(), 2U) << "its own pictures, and no others";
  EXPECT_EQ(camera->figures[1].caption, "Luminance in cd/m2, by decades");
  EXPECT_EQ(camera->facts[0].value, "12.5 cd/m2");
  EXPECT_EQ(camera->facts[1].value, "0.25 cd/m2");
  EXPECT_EQ(camera->facts.size(), 3U) << "what is not there is left out";
  const PageSection* const maps = section_called(page, "Detector");
  ASSERT_NE(maps, nullptr);
  EXPECT_EQ(maps->figures.size(), 2U);
  EXPECT_EQ(maps->facts[0].value, "88.90 %");
  const PageSection* const road = section_called(page, "Night road");
  ASSERT_NE(road, nullptr);
  EXPECT_EQ(road->figures.size(), 1U);
  ASSERT_EQ(road->tables[0].rows.size(), 2U);
  EXPECT_EQ(road->tables[0].rows[0][2].text, "3.5");
  EXPECT_EQ(road->tables[0].rows[0][6].text, "2") << "observation angle of the right lamp";
  EXPECT_EQ(road->tables[0].rows[1][7].text, "") << "what is not there is empty";
}

TEST(StudyPage, DocumentsThatLackEverythingGiveASectionEach) {
  ResultFolder folder{"x", {}, {}};
  for (const char* kind : {"inspect", "rre", "footprint", "far_field", "photometry", "roughness", "sweep", "optimum",
                           "fabrication", "verification", "forces", "metrology", "image", "anything"}) {
    folder.documents.push_back(document(kind, nlohmann::ordered_json::object()));
    // Add a document whose values have wrong types.
    folder.documents.push_back(document(kind, {{"points", "no"},
                                               {"designs", {1, "a"}},
                                               {"features", {nullptr, 3}},
                                               {"regions", {{{"rre", "x"}}}},
                                               {"directions", {{{"spots", {5}}}}},
                                               {"design", {{"element", 3}}},
                                               {"findings", {7}},
                                               {"best", {{"a", {1}}}}}));
  }
  const Page page = study_page(folder, "T");
  EXPECT_GE(page.sections.size(), 2 * 14U + 2U);
  const std::string html = page_html(page, kAssets);
  EXPECT_GT(html.size(), 1000U);
  for (const char* no_number : {">nan", "nan ", ":nan", ">inf"}) EXPECT_EQ(html.find(no_number), std::string::npos);
}

TEST(StudyPage, VerdictsAndFindingsAreShown) {
  const Page page = study_page(
      {"x",
       {document("verification",
                 {{"verdict", "fail"},
                  {"findings", {{{"kind", "gouge"}, {"program", "p.ngc"}, {"line", 12}, {"message", "too deep"}}}}})},
       {}},
      "");
  EXPECT_EQ(page.sections[0].facts[0].value, "fail");
  EXPECT_EQ(page.sections[0].facts[0].rating, Rating::bad);
  EXPECT_EQ(page.sections[1].title, "Verification");
  EXPECT_EQ(page.sections[1].tables[0].rows[0][2].text, "12");
}

nlohmann::ordered_json design(const std::string& title, double base_mm, const std::string& source = "d.toml") {
  return {{"source", source},
          {"title", title},
          {"element", {{"kind", "rtp"}, {"base_mm", base_mm}, {"width_mm", 1}}},
          {"array", {{"arrangement", "single"}}}};
}

nlohmann::ordered_json efficiencies(const std::vector<nlohmann::ordered_json>& designs) {
  nlohmann::ordered_json points = nlohmann::ordered_json::array();
  for (std::size_t d = 0; d < designs.size(); ++d)
    for (const double incidence : {0.0, 10.0})
      points.push_back({{"design", d},
                        {"incidence_deg", incidence},
                        {"azimuth_deg", 0},
                        {"rre", 0.1 * (1.0 + static_cast<double>(d)) + 0.01 * incidence}});
  return {{"designs", designs}, {"points", points}};
}

std::vector<std::string> card_names(const Page& page) {
  std::vector<std::string> names;
  for (const PageFact& fact : page.sections[0].facts)
    if (fact.name != "Documents") names.push_back(fact.subject.empty() ? fact.name : fact.name + ": " + fact.subject);
  return names;
}

/// Names of the designs 1 and 2: the key whose value differs.
const std::string kA = "element.base_mm = 1";
const std::string kB = "element.base_mm = 2";

TEST(StudyPage, CardsNameTheirDesign) {
  using Json = nlohmann::ordered_json;
  const Json a = design("A", 1);
  const Json b = design("B", 2);
  ResultFolder folder{"x", {document("rre", efficiencies({a, b}))}, {}};
  folder.documents.push_back(document("inspect", {{"design", a}, {"elements_full", 1}}));
  folder.documents.push_back(document("photometry", {{"design", b}, {"verdict", "pass"}}));
  folder.documents.push_back(document("fabrication", {{"job", "jobs/cut.toml"}, {"time_s", 3600}}));
  const Page page = study_page(folder, "");
  EXPECT_EQ(page.title, "Study of 2 designs");
  const std::vector<PageFact>& facts = page.sections[0].facts;
  const auto value_of = [&](const std::string& name, const std::string& subject) {
    const auto found =
        std::ranges::find_if(facts, [&](const PageFact& fact) { return fact.name == name && fact.subject == subject; });
    return found == facts.end() ? std::string("none") : found->value;
  };
  EXPECT_EQ(value_of("RRE at normal incidence", kA), "10.00 %");
  EXPECT_EQ(value_of("RRE at normal incidence", kB), "20.00 %");
  EXPECT_EQ(value_of("Maximum RRE, at 10 deg", kA), "20.00 %");
  EXPECT_EQ(value_of("Maximum RRE, at 10 deg", kB), "30.00 %");
  EXPECT_EQ(value_of("Whole elements", kA), "1");
  EXPECT_EQ(value_of("Photometry", kB), "pass");
  EXPECT_EQ(value_of("Machining time", "cut.toml"), "1.00 h");
  for (const PageSection& section : page.sections) {
    const bool has_one = section.title == "Photometry" || section.title == "Tool path" || section.title == "Design";
    if (section.title == "Efficiency") {
      EXPECT_EQ(section.subject, kA + "; " + kB);
    }
    if (!has_one) continue;
    for (const PageFact& fact : section.facts) EXPECT_EQ(fact.subject, section.title == "Tool path" ? "cut.toml" : kB);
    EXPECT_FALSE(section.subject.empty()) << section.title;
  }
  const std::string html = page_html(page, kAssets);
  EXPECT_NE(html.find("<dd class=\"subject\">cut.toml</dd>"), std::string::npos);
}

TEST(StudyPage, SectionsOfTheSameKindAreNamedByTheirDesigns) {
  const auto a = design("A", 1);
  const auto b = design("B", 2);
  const Page page = study_page({"x",
                                {document("inspect", {{"design", a}}), document("inspect", {{"design", b}}),
                                 document("photometry", {{"design", a}, {"verdict", "pass"}}),
                                 document("photometry", {{"design", a}, {"verdict", "fail"}})},
                                {}},
                               "");
  std::set<std::string> titles;
  for (const PageSection& section : page.sections) titles.insert(section.title);
  EXPECT_TRUE(titles.contains("Design: " + kA));
  EXPECT_TRUE(titles.contains("Design: " + kB));
  EXPECT_FALSE(titles.contains("Photometry: " + kA)) << "two sections would have the same title";
}

TEST(StudyPage, FailuresComeFirstAndAreMarked) {
  using Json = nlohmann::ordered_json;
  Json rows = Json::array();
  for (int k = 0; k < 900; ++k) rows.push_back({{"number", k}, {"holds", k != 850}});
  const Page page = study_page({"x",
                                {document("inspect", {{"elements_full", 1}}), document("validation", {{"rows", rows}}),
                                 document("photometry", {{"verdict", "fail"}})},
                                {}},
                               "");
  EXPECT_EQ(page.sections[0].facts[0].rating, Rating::bad);
  const auto validation = std::ranges::find(page.sections, "Validation", &PageSection::title);
  ASSERT_NE(validation, page.sections.end());
  const PageTable& table = validation->tables.back();
  EXPECT_EQ(table.rows[0][0].text, "850") << "the failure is shown, although the table is cut";
  EXPECT_EQ(table.rows[0][1].rating, Rating::bad);
  EXPECT_EQ(table.rows[1][1].rating, Rating::good);
  EXPECT_TRUE(has_failure(*validation));
  const std::string html = page_html(page, kAssets);
  EXPECT_EQ(count(html, "<tr class=\"bad\">"), 1U);
  EXPECT_NE(html.find(validation->id + "\" class=\"bad\">"), std::string::npos) << "the contents mark the section";
}

TEST(StudyPage, ADesignThatIsAloneIsNotNamedAgain) {
  const auto a = design("A", 1);
  const Page page =
      study_page({"x", {document("rre", efficiencies({a})), document("inspect", {{"design", a}})}, {}}, "");
  EXPECT_EQ(page.title, "A");
  EXPECT_EQ(card_names(page), (std::vector<std::string>{"RRE at normal incidence", "Maximum RRE, at 10 deg"}));
}

/// On a page with several designs, all names of cards, curves and captions are different, even if designs have the same
/// title.
TEST(StudyPage, DifferentDesignsHaveDifferentNames) {
  using Json = nlohmann::ordered_json;
  const std::vector<Json> designs = {design("A", 1),          design("A", 2), design("A", 3, "other.toml"),
                                     design("A (d.toml)", 4), design("", 5),  design("", 5.0000001)};
  ResultFolder folder{"x", {document("rre", efficiencies(designs))}, {}};
  Json regions = Json::array();
  Json directions = Json::array();
  for (std::size_t d = 0; d < designs.size(); ++d) {
    regions.push_back({{"design", d}, {"incidence_deg", 0}, {"azimuth_deg", 0}});
    directions.push_back({{"design", d}, {"incidence_deg", 0}, {"azimuth_deg", 0}, {"spots", Json::array()}});
  }
  folder.documents.push_back(document("footprint", {{"regions", regions}}));
  folder.documents.push_back(document("far_field", {{"directions", directions}}));
  const Page page = study_page(folder, "");
  const auto all_differ = [](std::vector<std::string> names, std::size_t number) {
    std::sort(names.begin(), names.end());
    EXPECT_EQ(std::adjacent_find(names.begin(), names.end()), names.end());
    EXPECT_EQ(names.size(), number);
  };
  all_differ(card_names(page), 2 * designs.size());
  for (const PageSection& section : page.sections) {
    std::vector<std::string> captions;
    for (const PageFigure& figure : section.figures) captions.push_back(figure.caption);
    if (section.title == "Footprint" || section.title == "Far field") all_differ(captions, designs.size());
    if (section.title != "Efficiency") continue;
    std::vector<std::string> labels;
    for (const Series& series : section.charts.at(0).series) labels.push_back(series.label);
    all_differ(labels, designs.size());
  }
}

TEST(StudyPage, TestPointsThatFailComeFirst) {
  nlohmann::ordered_json points = nlohmann::ordered_json::array();
  for (const char* verdict : {"pass", "unconfirmed", "fail", "pass", "fail", "undetermined"})
    points.push_back({{"value_mcd_per_lx", points.size()}, {"verdict", verdict}});
  const Page page = study_page({"x", {document("photometry", {{"verdict", "fail"}, {"points", points}})}, {}}, "");
  std::vector<std::string> order;
  for (const auto& row : page.sections[1].tables[0].rows) order.push_back(row[1].text);
  EXPECT_EQ(order, (std::vector<std::string>{"2", "4", "1", "5", "0", "3"}));
}

TEST(StudyPage, LongResultsAreCutAndSaySo) {
  nlohmann::ordered_json points = nlohmann::ordered_json::array();
  for (int k = 0; k < 5000; ++k) points.push_back({{"point", k}, {"a", k}, {"rre", 0.5}});
  const Page page = study_page(
      {"x", {document("sweep", {{"parameters", {"a"}}, {"quantities", {"rre"}}, {"points", points}})}, {}}, "");
  const PageTable& table = page.sections[1].tables[0];
  EXPECT_EQ(table.rows.size() + table.omitted_rows, 5000U);
  EXPECT_GT(table.omitted_rows, 0U);
  EXPECT_EQ(page.sections[1].charts[0].series[0].x.size(), 5000U);
}

TEST(StudyPage, ExtremeDirectionsComeFromTheCurve) {
  const auto point = [](double incidence) {
    return nlohmann::ordered_json{{"incidence_deg", incidence}, {"azimuth_deg", 30}, {"rre", 0.1}};
  };
  ResultFolder folder{"x", {document("rre", {{"points", {point(-20), point(5), point(10)}}})}, {}};
  const auto directions = extreme_directions_deg(folder);
  ASSERT_EQ(directions.size(), 2U);
  EXPECT_EQ(directions[0][0], 5.0);
  EXPECT_EQ(directions[1][0], -20.0);
  EXPECT_EQ(extreme_directions_deg({"x", {}, {}}).size(), 1U);
}

}  // namespace
}  // namespace retrace::report::page_test
