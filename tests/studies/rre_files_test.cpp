#include "studies/rre/io/rre_files.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>

#include "core/version.h"
#include "tests/support/lines.h"

namespace retrace::studies::rre_files_test {
namespace {

using testing::lines_of;

using Json = nlohmann::ordered_json;
using raytrace::kAccountCount;
using raytrace::kAccountNames;

/// Returns a result with some numbers that have a short decimal text and some that need all digits.
RreResult some_result() {
  RreResult result;
  result.designs.resize(2);
  result.designs[0].source = "a.toml";
  result.designs[1].source = "b.toml";
  result.designs[1].title = "B, \"the\" \x1b[1m\nsecond";
  result.engine = "embree";
  result.engine_requested = "auto";
  result.seed = 4294967295;
  result.rays = std::uint64_t{1} << 60;
  result.elapsed_s = 1.5;
  result.warnings = {{"some_id", "b.toml: a \"warning\""}};
  for (std::size_t d = 0; d < 2; ++d) {
    RrePoint point{d,        -10.0, 0.1 + 0.2, 587.56, 0.5, 1.0 / 3.0, std::numeric_limits<double>::denorm_min(),
                   "embree", {},    {}};
    for (std::size_t k = 0; k < kAccountCount; ++k) point.ledger.power[k] = 1e-3 * static_cast<double>(k) + 1e-17;
    result.points.push_back(point);
  }
  return result;
}

/// Returns polar maps of two designs with two acceptance cones each.
RreResult some_maps() {
  RreResult result;
  result.designs.resize(2);
  for (design::Design& design : result.designs) design.title = "Same";
  result.has_map = true;
  result.traced_directions = 7;
  for (std::size_t d = 0; d < 2; ++d)
    for (const double azimuth : {0.0, 120.0, 240.0})
      for (const double incidence : {0.0, 30.0})
        for (const double cone : {0.5, 1.0}) {
          RrePoint point;
          point.design = d;
          point.incidence_deg = incidence;
          point.azimuth_deg = azimuth;
          point.acceptance_half_angle_deg = cone;
          point.rre = 0.5 * cone;
          result.points.push_back(point);
        }
  return result;
}

// Directions are counted one time, although each direction has one point for each acceptance cone. Designs with the
// same title have different names.
TEST(RreFiles, TableOfMapsCountsDirections) {
  const std::vector<std::string> lines = lines_of(rre_map_table(some_maps()));
  ASSERT_GT(lines.size(), 2U);
  EXPECT_TRUE(lines[0].starts_with("RRE of 12 directions; 7 were traced")) << lines[0];
  EXPECT_TRUE(lines[2].starts_with("Same (1), acceptance 0.5")) << lines[2];
  EXPECT_EQ(std::ranges::count_if(lines, [](const std::string& line) { return line.starts_with("Same (2), "); }), 2);
}

TEST(RreFiles, IncompleteMapsAreEmpty) {
  RreResult result = some_maps();
  EXPECT_EQ(Json::parse(rre_json(result))["maps"].size(), 4U);
  result.complete = false;
  result.points.resize(2);
  EXPECT_FALSE(Json::parse(rre_json(result)).contains("maps"));
  EXPECT_TRUE(rre_map_csv(result).empty());
}

TEST(RreFiles, JsonHoldsTheResultExactly) {
  const RreResult result = some_result();
  const Json json = Json::parse(rre_json(result));
  EXPECT_EQ(json["schema"], "retrace.rre/1");
  EXPECT_EQ(json["engine"], "embree");
  EXPECT_EQ(json["engine_requested"], "auto");
  EXPECT_EQ(json["seed"], 4294967295U);
  EXPECT_EQ(json["rays"], std::uint64_t{1} << 60);
  EXPECT_EQ(json["version"], kVersion);
  EXPECT_EQ(json["warnings"], Json(texts_of(result.warnings)));
  EXPECT_EQ(json["complete"], true);
  EXPECT_EQ(json["designs"][1]["source"], "b.toml");
  EXPECT_EQ(json["designs"][1]["title"], result.designs[1].title);
  ASSERT_EQ(json["points"].size(), 2U);
  for (std::size_t d = 0; d < 2; ++d) {
    const Json& point = json["points"][d];
    EXPECT_EQ(point["design"], d);
    EXPECT_EQ(point["incidence_deg"].get<double>(), -10.0);
    EXPECT_EQ(point["azimuth_deg"].get<double>(), 0.1 + 0.2);
    EXPECT_EQ(point["wavelength_nm"].get<double>(), 587.56);
    EXPECT_EQ(point["acceptance_half_angle_deg"].get<double>(), 0.5);
    EXPECT_EQ(point["rre"].get<double>(), 1.0 / 3.0);
    EXPECT_EQ(point["std_error"].get<double>(), std::numeric_limits<double>::denorm_min());
    ASSERT_EQ(point["ledger"].size(), kAccountCount);
    for (std::size_t k = 0; k < kAccountCount; ++k)
      EXPECT_EQ(point["ledger"][std::string(kAccountNames[k])].get<double>(), result.points[d].ledger.power[k]);
  }
}

TEST(RreFiles, InterruptedResultSaysSo) {
  RreResult result = some_result();
  result.complete = false;
  result.points.clear();
  const Json json = Json::parse(rre_json(result));
  EXPECT_EQ(json["complete"], false);
  EXPECT_EQ(json["points"], Json::array());
  EXPECT_EQ(lines_of(rre_csv(result)).size(), 1U) << "the header stays";
  EXPECT_EQ(lines_of(rre_table(result)).back().find("nan"), std::string::npos);
}

TEST(RreFiles, NumbersThatAreNoneAreLeftOut) {
  RreResult result = some_result();
  result.points[0].std_error = std::numeric_limits<double>::quiet_NaN();
  result.points[1].std_error = std::numeric_limits<double>::infinity();
  const Json json = Json::parse(rre_json(result));
  for (const Json& point : json["points"]) {
    EXPECT_FALSE(point.contains("std_error"));
    EXPECT_TRUE(point.contains("rre"));
  }
  const std::string csv = rre_csv(result);
  EXPECT_EQ(csv.find("nan"), std::string::npos) << csv;
  EXPECT_EQ(csv.find("inf,"), std::string::npos) << csv;
}

TEST(RreFiles, CsvHeaderIsTheKeysOfTheJson) {
  const RreResult result = some_result();
  const Json point = Json::parse(rre_json(result))["points"][0];
  std::string header;
  for (const auto& [key, value] : point.items())
    if (key != "ledger" && key != "stokes" && key != "engine") header += (header.empty() ? "" : ",") + key;
  for (const auto& [key, value] : point["ledger"].items()) header += "," + key;
  header += ",engine";
  const std::vector<std::string> lines = lines_of(rre_csv(result));
  ASSERT_EQ(lines.size(), 3U);
  EXPECT_EQ(lines[0], header);
  EXPECT_TRUE(lines[1].starts_with("0,-10,0.30000000000000004,587.56,0.5,0.3333333333333333,5e-324,")) << lines[1];
  EXPECT_TRUE(lines[2].starts_with("1,-10,")) << lines[2];
}

TEST(RreFiles, TableNamesDesignsAndConesOnlyWhereThereAreSeveral) {
  RreResult result = some_result();
  const std::string both = rre_table(result);
  const std::vector<std::string> lines = lines_of(both);
  ASSERT_EQ(lines.size(), 3U) << both;
  EXPECT_TRUE(lines[1].starts_with("a ")) << both;
  EXPECT_TRUE(lines[2].starts_with("b ")) << both;
  EXPECT_NE(both.find("33.3333"), std::string::npos) << both;
  EXPECT_EQ(both.find("acceptance"), std::string::npos) << both;
  result.designs.resize(1);
  result.points.resize(1);
  EXPECT_EQ(rre_table(result).find("design"), std::string::npos);
  result.designs[0].detector.acceptance_half_angle_deg = {0.5, 1.0};
  EXPECT_NE(rre_table(result).find("acceptance_deg"), std::string::npos);
}

TEST(RreFiles, TableShowsTitlesAsPrintableText) {
  RreResult result = some_result();
  for (design::Design& design : result.designs) design.source.clear();
  const std::string table = rre_table(result);
  EXPECT_NE(table.find("B, \"the\" \\x1b[1m\\nsecond"), std::string::npos) << table;
}

/// Returns a result with the curve 0.8 cos^2(2 t) at every degree from -40 to 40.
RreResult smooth_result(std::size_t designs, std::size_t azimuths) {
  constexpr double kRadians = std::numbers::pi / 180.0;
  RreResult result;
  result.designs.resize(designs);
  for (std::size_t d = 0; d < designs; ++d) {
    result.designs[d].source = "d" + std::to_string(d) + ".toml";
    for (std::size_t a = 0; a < azimuths; ++a)
      for (int t = -40; t <= 40; ++t) {
        RrePoint point;
        point.design = d;
        point.incidence_deg = t;
        point.azimuth_deg = 10.0 * static_cast<double>(a);
        point.acceptance_half_angle_deg = 0.5;
        const double c = std::cos(2.0 * kRadians * t);
        point.rre = 0.8 * c * c;
        result.points.push_back(point);
      }
  }
  return result;
}

TEST(RreFiles, SummaryTellsThePointsTheMaximumAndTheHalfAngles) {
  const std::vector<std::string> lines = lines_of(rre_summary(smooth_result(2, 1), 22));
  ASSERT_EQ(lines.size(), 3U);
  std::istringstream line(lines[1]);
  std::string name, azimuth, points, start, start_deg, top, top_deg, low, high;
  line >> name >> azimuth >> points >> start >> start_deg >> top >> top_deg >> low >> high;
  EXPECT_EQ(name, "d0");
  EXPECT_EQ(points, "81");
  EXPECT_EQ(start, "80.0000");
  EXPECT_EQ(start_deg, "0");
  EXPECT_EQ(top, "80.0000");
  EXPECT_EQ(top_deg, "0");
  // cos^2(2 t) is 1/2 at t = 22.5 degrees. Linear interpolation over a degree is accurate to 0.01 degrees here.
  EXPECT_NEAR(std::stod(low), -22.5, 0.01);
  EXPECT_NEAR(std::stod(high), 22.5, 0.01);
}

TEST(RreFiles, SummaryIsShortForAnyNumberOfCurves) {
  for (const std::size_t designs : {1U, 3U, 40U})
    for (const std::size_t azimuths : {1U, 12U, 36U})
      EXPECT_LE(lines_of(rre_summary(smooth_result(designs, azimuths), 22)).size(), 22U) << designs << ' ' << azimuths;
  EXPECT_EQ(lines_of(rre_summary(smooth_result(1, 36), 22)).size(), 2U) << "one line for all azimuths";
  EXPECT_EQ(rre_summary(RreResult{}, 22), "");
}

}  // namespace
}  // namespace retrace::studies::rre_files_test
