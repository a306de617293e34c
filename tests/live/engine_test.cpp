#include "live/engine/engine.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "core/schema/reader.h"
#include "design/azimuth_symmetry.h"
#include "design/io/design_format.h"
#include "design/io/design_reader.h"
#include "design/io/init_templates.h"
#include "raytrace/light/ledger.h"
#include "studies/rre/rre.h"
#include "tests/support/refusals.h"

namespace retrace::live_engine_test {
namespace {

using Json = nlohmann::ordered_json;

const std::string kHoneycomb = R"([element]
kind = "hexagonal_icc"
aperture_mm = 1
[array]
extent = "infinite"
[body]
thickness_mm = 1
)";

Json ask(live::Engine& engine, const Json& request) {
  return Json::parse(engine.call(request.dump()));
}

/// Sends a request and returns the answer, which must be successful.
Json told(live::Engine& engine, const Json& request) {
  const Json answer = ask(engine, request);
  EXPECT_TRUE(answer.value("ok", false)) << request << answer;
  return answer;
}

Json opened(live::Engine& engine, const std::string& toml) {
  return told(engine, {{"ask", "open"}, {"toml", toml}, {"source", "design.toml"}});
}

const Json* key_of(const Json& design, const std::string& path) {
  for (const Json& key : design["keys"])
    if (key["path"] == path) return &key;
  return nullptr;
}

TEST(LiveEngine, AnswersWhateverIsAsked) {
  live::Engine engine;
  for (const char* const request :
       {"", "[", "{}", "[]", "3", "{\"ask\": 3}", "{\"ask\": \"nonsense\"}", "{\"ask\": \"part\"}",
        "{\"ask\": \"part\", \"design\": 7}", "{\"ask\": \"open\"}", "\xff"}) {
    const Json answer = Json::parse(engine.call(request));
    EXPECT_FALSE(answer["ok"]) << request;
    EXPECT_EQ(answer["kind"], "input") << request << answer;
    EXPECT_FALSE(answer["text"].get<std::string>().empty()) << request;
  }
  EXPECT_EQ(ask(engine, {{"ask", "about"}, {"id", 17}})["id"], 17);
}

/// The form is generated from the file format and contains each key of the format.
TEST(LiveEngine, FormHasEveryKeyOfTheFormat) {
  live::Engine engine;
  const Json form = told(engine, {{"ask", "form"}});
  std::set<std::string> paths;
  for (const Json& group : form["groups"]) {
    if (group["list"])
      paths.insert(group["path"].get<std::string>().substr(0, group["path"].get<std::string>().size() - 2));
    for (const Json& row : group["rows"]) {
      paths.insert(row["path"]);
      EXPECT_FALSE(row["meaning"].get<std::string>().empty()) << row;
    }
  }
  for (const std::string& key : schema::keys_of(design::design_format())) EXPECT_TRUE(paths.contains(key)) << key;
}

TEST(LiveEngine, TellsWhatAppliesToTheShape) {
  live::Engine engine;
  const Json design = opened(engine, kHoneycomb);
  ASSERT_NE(key_of(design, "element.aperture_mm"), nullptr);
  EXPECT_EQ((*key_of(design, "element.aperture_mm"))["value"], 1.0);
  EXPECT_TRUE((*key_of(design, "element.aperture_mm"))["given"]);
  EXPECT_EQ(key_of(design, "element.base_mm"), nullptr);
  EXPECT_EQ(key_of(design, "array.x_length_mm"), nullptr) << "the array has no end";
  EXPECT_EQ((*key_of(design, "array.arrangement"))["value"], "honeycomb");
  EXPECT_FALSE((*key_of(design, "array.arrangement"))["given"]);
  EXPECT_NE(key_of(design, "entrance.haze"), nullptr) << "tables that are not there can be begun";
}

TEST(LiveEngine, DesignsAreKeptAsTheyAre) {
  live::Engine engine;
  const std::string text = "# \xc3\xa9 comment\r\n" + kHoneycomb + "\n# end";
  EXPECT_EQ(opened(engine, text)["toml"], text);
}

TEST(LiveEngine, SaysWhatTheProgramSaysOfBadDesigns) {
  live::Engine engine;
  const Json error =
      ask(engine, {{"ask", "open"}, {"toml", "[element]\nkind = \"rtp\"\nbase_mm = -3\n"}, {"source", "design.toml"}});
  EXPECT_FALSE(error["ok"]);
  EXPECT_EQ(error["line"], 3);
  EXPECT_EQ(error["key"], "element.base_mm");
  try {
    design::parse_design("[element]\nkind = \"rtp\"\nbase_mm = -3\n", "design.toml");
    FAIL();
  } catch (const InputError& expected) {
    EXPECT_EQ(error["text"], expected.what());
  }
}

TEST(LiveEngine, ChangesKeys) {
  live::Engine engine;
  const Json before = opened(engine, kHoneycomb);
  const Json after = told(engine, {{"ask", "set"},
                                   {"design", before["design"]},
                                   {"changes", {{"element.aperture_mm", 2.5}, {"body.material", "PC"}}}});
  EXPECT_NE(after["design"], before["design"]);
  const design::Design design = design::parse_design(after["toml"].get<std::string>(), "design.toml");
  EXPECT_EQ(std::get<geometry::HexagonalCube>(design.part().element).aperture_mm, 2.5);
  EXPECT_EQ(design.substance.material, "PC");
  const Json back =
      told(engine, {{"ask", "set"}, {"design", after["design"]}, {"changes", {{"body.material", nullptr}}}});
  EXPECT_EQ(design::parse_design(back["toml"].get<std::string>(), "").substance.material, "PMMA");
  // The warning names a key that has no effect because another key takes precedence.
  EXPECT_TRUE(after["warnings"].empty()) << after["warnings"];
  const Json both =
      told(engine, {{"ask", "set"}, {"design", after["design"]}, {"changes", {{"body.refractive_index", 1.6}}}});
  ASSERT_EQ(both["warnings"].size(), 1U) << both["warnings"];
  const auto warning = both["warnings"][0].get<std::string>();
  EXPECT_EQ(recorded_place_of(warning), "design.toml:12: body.material");
}

TEST(LiveEngine, RefusesChangesThatMakeNoDesign) {
  live::Engine engine;
  const Json design = opened(engine, kHoneycomb);
  const auto refused = [&](const Json& changes) {
    const Json error = ask(engine, {{"ask", "set"}, {"design", design["design"]}, {"changes", changes}});
    EXPECT_FALSE(error["ok"]) << changes;
    return recorded_place_of(error["text"].get<std::string>());
  };
  EXPECT_EQ(refused({{"element.aperture_mm", -1}}), "design.toml: element.aperture_mm");
  EXPECT_EQ(refused({{"element.aperture_mm", "wide"}}), "design.toml: element.aperture_mm");
  EXPECT_EQ(refused({{"element.kind", "rtp"}}), "design.toml: element.base_mm");
  EXPECT_EQ(refused({{"element.apertur_mm", 1}}), "design.toml: element.apertur_mm");
  EXPECT_EQ(refused({{"element.aperture_mm", nullptr}}), "design.toml: element.aperture_mm");
  // A design from which no part can be built is also refused.
  EXPECT_EQ(refused({{"element.cant_deg", 10}, {"body.thickness_mm", 1e-6}}), "design.toml: body.thickness_mm");
}

/// A design can be changed from every kind of element to every other kind. The engine adapts the remaining keys of the
/// design.
TEST(LiveEngine, AdaptsWhatIsLeftOfAnotherKind) {
  live::Engine engine;
  for (const std::string_view from : design::design_kinds())
    for (const std::string_view to : design::design_kinds())
      for (const char* const extent : {"finite", "infinite"}) {
        const Json before =
            opened(engine, told(engine, {{"ask", "template"}, {"kind", from}, {"extent", extent}})["toml"]);
        const Json after =
            told(engine,
                 {{"ask", "set"}, {"design", before["design"]}, {"changes", {{"element.kind", to}}}, {"adapt", true}});
        EXPECT_EQ((*key_of(after, "element.kind"))["value"], to);
        const bool is_single = from == "round_icc" || to == "round_icc";
        EXPECT_EQ((*key_of(after, "array.extent"))["value"], is_single ? "finite" : extent) << from << " " << to;
        EXPECT_EQ(after["adapted"].empty(), from == to) << from << " " << to;
      }
}

TEST(LiveEngine, MakesTablesAndListsOfTables) {
  live::Engine engine;
  const Json design = opened(engine, kHoneycomb);
  const Json after = told(
      engine,
      {{"ask", "set"}, {"design", design["design"]}, {"changes", {{"coating.facets", {{{"material", "aluminium"}}}}}}});
  EXPECT_TRUE(design::parse_design(after["toml"].get<std::string>(), "").surface.coating.has_opaque_facets());
  ASSERT_NE(key_of(after, "coating.facets[0].material"), nullptr);
  EXPECT_EQ((*key_of(after, "coating.facets[0].material"))["value"], "aluminium");
}

studies::RreResult rre_of(const std::string& toml, double incidence_deg, double azimuth_deg, double target_error,
                          bool footprint) {
  studies::RreSettings request;
  request.engine = raytrace::Engine::exact;
  request.target_error = target_error;
  request.incidence_deg = {incidence_deg};
  request.azimuth_deg = {azimuth_deg};
  request.footprint = request.far_field = footprint;
  return studies::RreStudy({design::parse_design(toml, "design.toml")}, request).run();
}

/// The live engine gives the same results for a direction as `retrace rre --engine exact`. Both truncate a small
/// fraction of the light, but not the same beams.
TEST(LiveEngine, TellsWhatTheStudyTells) {
  constexpr double kLeft = 1e-6;
  live::Engine engine;
  const Json design = opened(engine, kHoneycomb);
  for (const auto& [incidence_deg, azimuth_deg] : {std::pair{0.0, 0.0}, {20.0, 15.0}, {-35.0, 70.0}}) {
    const Json told_of = told(engine, {{"ask", "direction"},
                                       {"design", design["design"]},
                                       {"incidence_deg", incidence_deg},
                                       {"azimuth_deg", azimuth_deg},
                                       {"target_error", kLeft},
                                       {"engine", "exact"}});
    const studies::RreResult study = rre_of(kHoneycomb, incidence_deg, azimuth_deg, kLeft, true);
    const studies::RrePoint& expected = study.points[0];
    EXPECT_NEAR(told_of["rre"].get<double>(), expected.rre, kLeft);
    ASSERT_EQ(told_of["ledger"].size(), expected.ledger.power.size());
    for (std::size_t k = 0; k < expected.ledger.power.size(); ++k)
      EXPECT_NEAR(told_of["ledger"][k].get<double>(), expected.ledger.power[k], kLeft) << raytrace::kAccountNames[k];
    const studies::Footprint& footprint = *study.returned[0].footprint;
    EXPECT_NEAR(told_of["footprint"]["active_fraction"].get<double>(), footprint.active_fraction(), kLeft);
    EXPECT_NEAR(told_of["footprint"]["shown"].get<double>(), footprint.rre_contribution(), kLeft);
    const studies::FarFieldSpot& spot = study.returned[0].far_field->spots.front();
    EXPECT_NEAR(told_of["far_field"]["spots"][0]["power"].get<double>(), spot.stokes.i, kLeft);
    EXPECT_EQ(told_of["far_field"]["spots"][0]["depth"], spot.min_depth);
    const Json points = told(engine, {{"ask", "rre"},
                                      {"design", design["design"]},
                                      {"directions", {{incidence_deg, azimuth_deg}}},
                                      {"target_error", 1e-4}});
    EXPECT_NEAR(points["points"][0][0].get<double>(), expected.rre, 4e-4) << "four standard errors";
  }
}

TEST(LiveEngine, EndsInTime) {
  live::Engine engine;
  const Json design = opened(engine, told(engine, {{"ask", "template"}, {"kind", "hexagonal_icc"}})["toml"]);
  const Json error = ask(engine, {{"ask", "direction"},
                                  {"design", design["design"]},
                                  {"incidence_deg", 25},
                                  {"azimuth_deg", 10},
                                  {"target_error", 1e-9},
                                  {"seconds", 0.01}});
  EXPECT_FALSE(error["ok"]);
  EXPECT_EQ(error["kind"], "budget");
  const Json some = told(engine, {{"ask", "rre"},
                                  {"design", design["design"]},
                                  {"directions", {{0, 0}, {25, 10}, {30, 10}}},
                                  {"target_error", 1e-5},
                                  {"seconds", 0.001}});
  EXPECT_GE(some["points"].size(), 1U);
  EXPECT_FALSE(some["complete"]);
}

/// Light that enters a region of the footprint with an efficiency above 0.5 must return.
TEST(LiveEngine, PathsComeBackFromTheFootprintAlone) {
  live::Engine engine;
  const Json design = opened(engine, kHoneycomb);
  int returned = 0;
  int tried = 0;
  for (const double incidence_deg : {0.0, 12.0, 25.0}) {
    const Json light = {{"design", design["design"]}, {"incidence_deg", incidence_deg}, {"azimuth_deg", 30.0}};
    Json request = light;
    request["ask"] = "direction";
    const Json answer = told(engine, request);
    for (const Json& region : answer["footprint"]["regions"]) {
      geometry::Vec2 middle = geometry::Vec2::Zero();
      const auto outline = region["outline"].get<std::vector<double>>();
      for (std::size_t k = 0; k < outline.size(); k += 2)
        middle += geometry::Vec2(outline[k], outline[k + 1]) * 2.0 / static_cast<double>(outline.size());
      Json path = light;
      path["ask"] = "path";
      path["at_mm"] = {middle.x(), middle.y()};
      const Json found = told(engine, path);
      ++tried;
      // The drawn path follows the stronger branch at each interface.
      if (region["efficiency"].get<double>() > 0.5) {
        EXPECT_TRUE(found["returned"]) << incidence_deg << " " << path << found;
        ++returned;
      }
    }
  }
  EXPECT_GT(returned, 10);
  EXPECT_GE(tried, returned);
}

std::string unpacked(const std::string& base64) {
  constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  std::uint32_t bits = 0;
  int held = 0;
  for (const char c : base64.substr(0, base64.find('='))) {
    bits = bits << 6U | static_cast<std::uint32_t>(digits.find(c));
    held += 6;
    if (held < 8) continue;
    held -= 8;
    bytes += static_cast<char>(bits >> static_cast<unsigned>(held) & 0xffU);
  }
  return bytes;
}

/// Returns the volume of a binary STL file, by the divergence theorem.
double volume_mm3(const std::string& stl) {
  constexpr std::size_t kHead = 84;
  constexpr std::size_t kTriangle = 50;
  EXPECT_EQ((stl.size() - kHead) % kTriangle, 0U);
  double volume = 0.0;
  for (std::size_t at = kHead; at < stl.size(); at += kTriangle) {
    Eigen::Matrix<float, 3, 4> normal_and_corners;
    std::memcpy(normal_and_corners.data(), stl.data() + at, sizeof normal_and_corners);
    volume += normal_and_corners.rightCols<3>().cast<double>().determinant() / 6.0;
  }
  return volume;
}

TEST(LiveEngine, GivesTheSolidOfOneElement) {
  live::Engine engine;
  const auto volume_of = [&](const std::string& toml) {
    return volume_mm3(unpacked(told(engine, {{"ask", "stl"}, {"design", opened(engine, toml)["design"]}})["base64"]));
  };
  // The expected volume is that of a plate of 2 mm and of the prism or pyramid below it.
  const std::string endless = "[array]\nextent = \"infinite\"\n[body]\nthickness_mm = 2\n";
  EXPECT_NEAR(volume_of("[element]\nkind = \"rtp\"\nbase_mm = 1\nwidth_mm = 3\n" + endless), 3.0 * (2.0 + 0.25), 1e-5);
  const double side = std::sqrt(0.75);  // side of the triangle in a circle of 1 mm diameter
  EXPECT_NEAR(volume_of("[element]\nkind = \"triangular_icc\"\naperture_mm = 1\n" + endless),
              std::sqrt(3.0) / 4.0 * side * side * (2.0 + side / std::sqrt(6.0) / 3.0), 1e-5);
  for (const std::string_view kind : design::design_kinds())
    for (const char* const extent : {"finite", "infinite"})
      EXPECT_GT(volume_of(told(engine, {{"ask", "template"}, {"kind", kind}, {"extent", extent}})["toml"]), 0.0)
          << kind;
}

TEST(LiveEngine, SaysWhatItCannotDo) {
  live::Engine engine;
  const Json rough = opened(engine, kHoneycomb + "[surface]\nroughness_sq_nm = 20\ncorrelation_length_um = 5\n");
  EXPECT_FALSE(rough["traces"]);
  EXPECT_NE(rough["why_not"].get<std::string>().find("Monte Carlo"), std::string::npos);
  EXPECT_TRUE(rough["command"].get<std::string>().starts_with("retrace rre"));
  const Json error = ask(engine, {{"ask", "direction"}, {"design", rough["design"]}, {"incidence_deg", 0}});
  EXPECT_FALSE(error["ok"]);
  const Json file = ask(
      engine,
      {{"ask", "open"}, {"source", "design.toml"}, {"toml", kHoneycomb + "material = \"A\"\ncatalogue = \"a.agf\"\n"}});
  EXPECT_FALSE(file["ok"]);
  EXPECT_EQ(file["line"], 9);
  EXPECT_EQ(file["key"], "body.catalogue");
  record_message(file["text"].get<std::string>());
}

/// The reported symmetry must agree with the RRE (retroreflective efficiency) of the exact engine.
TEST(AzimuthSymmetry, IsThatOfRre) {
  const std::string prism =
      "[element]\nkind = \"rtp\"\nbase_mm = 1\nwidth_mm = 1\n[body]\nthickness_mm = 1\n[array]\nextent = "
      "\"infinite\"\n";
  const std::string triangle =
      "[element]\nkind = \"triangular_icc\"\naperture_mm = 1\n[body]\nthickness_mm = 1\n[array]\nextent = "
      "\"infinite\"\n";
  for (const auto& [toml, period] : {std::pair{prism, 180.0},
                                     {prism + "arrangement = \"offset\"\noverlap_percent = 20\n", 180.0},
                                     {prism + "arrangement = \"checker\"\n", 90.0},
                                     {kHoneycomb, 120.0},
                                     {triangle, 60.0}}) {
    const auto symmetry = design::azimuth_symmetry(design::parse_design(toml, "design.toml"));
    ASSERT_TRUE(symmetry) << toml;
    EXPECT_EQ(symmetry->period_deg, period) << toml;
    // Fraction of the light that may be truncated. It differs slightly between azimuths.
    constexpr double kLeft = 3e-3;
    // Obliquely illuminated prisms return little light into a narrow cone, so that a wide cone is used.
    const std::string text = toml + "[detector]\nacceptance_half_angle_deg = 25\n";
    const auto rre = [&text](double azimuth_deg) {
      return rre_of(text, 23.0, azimuth_deg, kLeft, false).points[0].rre;
    };
    const double at = rre(17.0);
    EXPECT_NEAR(rre(17.0 + period), at, kLeft) << toml;
    EXPECT_NEAR(rre(2.0 * symmetry->mirror_deg - 17.0), at, kLeft) << toml;
    EXPECT_GT(std::abs(rre(17.0 + 0.2 * period) - at), 10.0 * kLeft) << toml;
  }
  for (const char* const without :
       {"[surface]\nfacet_tilt_arcmin = [1, 0, 0]\n", "[light]\npolarisation = \"linear\"\n"})
    EXPECT_FALSE(design::azimuth_symmetry(design::parse_design(kHoneycomb + without, ""))) << without;
}

}  // namespace
}  // namespace retrace::live_engine_test
