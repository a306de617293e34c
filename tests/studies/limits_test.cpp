// Tests of limits files: shipped files, refused files, and the test plans that are selected from them.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/error.h"
#include "studies/photometry/io/limits_reader.h"
#include "studies/photometry/photometry.h"
#include "studies/photometry/standards.h"
#include "tests/studies/photometric_requests.h"
#include "tests/support/refusals.h"

namespace retrace::studies::limits_test {
namespace {

using namespace testing;
using namespace photometric_requests;

constexpr const char* kHeader = "standard,class,colour,observation_deg,v_deg,h_deg,minimum,unit,status\n";

std::string message_of(const std::string& table) {
  return refusal_of([&] { parse_limits(table, "l.csv"); }, "accepted");
}

// The source of J594 is a disc of 50 mm, and its receiver a rectangle of 13 x 25 mm, both at 30.5 m. A disc of the same
// area replaces the rectangle.
TEST(Limits, AperturesOfJ594AreThoseOfItsFixture) {
  const ShippedStandard* const j594 = find_standard("j594");
  ASSERT_NE(j594, nullptr);
  const auto arcmin = [](double diameter_mm) { return 60.0 * Angle::from_rad(diameter_mm / 30500.0).deg(); };
  EXPECT_NEAR(60.0 * j594->apertures.source.deg(), arcmin(50.0), 0.05);
  EXPECT_NEAR(60.0 * j594->apertures.receiver.deg(), arcmin(2.0 * std::sqrt(13.0 * 25.0 / std::numbers::pi)), 0.05);
}

TEST(Limits, ShippedProgrammesHoldTheirPoints) {
  const TestPlan ia = r150("IA", "red");
  ASSERT_EQ(ia.points.size(), 14U);
  EXPECT_TRUE(ia.is_complete);
  EXPECT_EQ(ia.points[0].minimum, 300.0);
  EXPECT_NEAR(ia.points[0].observation_deg, 1.0 / 3.0, 1e-6);
  EXPECT_EQ(ia.points[0].status, LimitStatus::read);
  EXPECT_EQ(ia.points[0].substitute_v_deg, (std::vector<double>{5.0, -5.0})) << "UN R3: where the face mirrors";
  EXPECT_TRUE(ia.points[1].substitute_v_deg.empty());
  // Test points are made for both signs of V, and for the four combinations of signs of V and H.
  EXPECT_EQ(ia.points[1].v_deg, 10.0);
  EXPECT_EQ(ia.points[2].v_deg, -10.0);
  EXPECT_EQ(ia.points[6].v_deg, -5.0);
  EXPECT_EQ(ia.points[6].h_deg, -20.0);
  EXPECT_EQ(test_plan_of(shipped(), "SAE J594 / FMVSS 108 XVI-a", {}, "amber").points.size(), 10U);
  const TestPlan bicycle = test_plan_of(shipped(), "16 CFR 1512", {}, "white");
  EXPECT_EQ(bicycle.part_class, "bicycle");
  EXPECT_TRUE(bicycle.is_complete);
  EXPECT_EQ(bicycle.points.size(), 22U) << "0, 10 and 20 degrees at both observation angles";
  for (const ShippedStandard& standard : shipped_standards())
    EXPECT_THROW(test_plan_of(shipped(), std::string(standard.table_name), {}, "no such"), InputError) << standard.name;
}

/// Expects that the limits of a colour (`other`) are `factor` times the limits of another colour (`of`), at the same
/// points.
void expect_multiple(const TestPlan& other, double factor, const TestPlan& of) {
  ASSERT_EQ(other.points.size(), of.points.size());
  for (std::size_t k = 0; k < of.points.size(); ++k) {
    EXPECT_DOUBLE_EQ(other.points[k].minimum, factor * of.points[k].minimum);
    EXPECT_EQ(other.points[k].status, of.points[k].status) << "the factors were read";
  }
}

TEST(Limits, FactorsAreThoseOfTheStandards) {
  for (const std::string part_class : {"IA", "IB"}) {
    expect_multiple(r150(part_class, "amber"), 2.5, r150(part_class, "red"));
    expect_multiple(r150(part_class, "white"), 4.0, r150(part_class, "red"));
  }
  const auto bicycle = [](const std::string& colour) { return test_plan_of(shipped(), "16 CFR 1512", {}, colour); };
  expect_multiple(bicycle("amber"), 0.625, bicycle("clear"));
  expect_multiple(bicycle("red"), 0.25, bicycle("clear"));
}

TEST(Limits, TrianglesAreRedOnly) {
  for (const std::string part_class : {"IIIA", "IIIB"}) {
    EXPECT_EQ(r150(part_class, "red").points.size(), 14U);
    for (const std::string colour : {"amber", "white"})
      EXPECT_THROW(r150(part_class, colour), InputError) << part_class << " " << colour;
  }
}

TEST(Limits, ClassIvaHasItsOwnLimitsByColour) {
  const TestPlan amber = r150("IVA", "amber");
  ASSERT_EQ(amber.points.size(), 22U);
  EXPECT_EQ(amber.points.front().minimum, 1125.0);
  EXPECT_EQ(amber.points.back().minimum, 10.0);
  EXPECT_EQ(amber.points.back().h_deg, -50.0);
  EXPECT_TRUE(amber.is_complete);
  for (const TestPoint& point : amber.points) EXPECT_EQ(point.status, LimitStatus::recalled);
  EXPECT_FALSE(r150("IVA", "red").is_complete) << "one point of it is known";
  EXPECT_TRUE(r150("IVA", "white").is_complete);
}

TEST(Limits, FactorsAreNoBetterConfirmedThanTheirLine) {
  const std::string good = "S,A,red,0.2,0,0,10,mcd/lx,read\n";
  const LimitTable table = parse_limits(kHeader + good + "S,A,amber,,,,2 x red,factor,recalled\n", "l.csv");
  EXPECT_EQ(test_plan_of(table, {}, {}, "amber").points[0].status, LimitStatus::recalled);
}

// The limits of R_A, in cd/(lx m2), are for beta1 = -4 and 30 degrees, which are V = 4 and V = -30.
TEST(Limits, SheetingIsMeasuredInTheCoplanarGeometry) {
  const TestPlan two = test_plan_of(shipped(), "ASTM D4956", "II", "white");
  ASSERT_EQ(two.points.size(), 4U);
  EXPECT_EQ(two.points[0].v_deg, 4.0);
  EXPECT_EQ(two.points[1].v_deg, -30.0);
  EXPECT_EQ(two.points[0].unit, PhotometricUnit::cd_per_lx_per_m2);
  const std::vector<double> minima = {140.0, 60.0, 50.0, 28.0};
  for (std::size_t k = 0; k < minima.size(); ++k) EXPECT_EQ(two.points[k].minimum, minima[k]);
  EXPECT_TRUE(two.is_complete);
  EXPECT_FALSE(test_plan_of(shipped(), "ASTM D4956", "III", "white").is_complete)
      << "the copy ends before its last row";
  const TestPlan clothing = test_plan_of(shipped(), "ISO 20471", "separate", "white");
  ASSERT_EQ(clothing.points.size(), 16U);
  EXPECT_EQ(clothing.points.front().minimum, 330.0);
  EXPECT_EQ(clothing.points.back().minimum, 4.0);
  EXPECT_EQ(clothing.points.back().v_deg, -40.0);
  const TestPlan sign = test_plan_of(shipped(), "StVZVO 1998", "2", "yellow");
  ASSERT_EQ(sign.points.size(), 9U);
  EXPECT_EQ(sign.points[5].minimum, 60.0);
}

/// Returns the minimum distance of a colour from its boundaries. It is negative outside of the boundaries.
double min_margin(const TestPlan& programme, double x, double y) {
  double least = 1.0;
  for (const ColourBoundary& b : programme.boundaries)
    least = std::min(least, b.limit - b.x_coefficient * x - b.y_coefficient * y);
  return least;
}

TEST(Limits, ColoursLieWithinTheirBoundaries) {
  const TestPlan red = r150("IA", "red");
  ASSERT_EQ(red.boundaries.size(), 2U);
  EXPECT_EQ(red.boundaries[0].substitute_v_deg, (std::vector<double>{5.0, -5.0}));
  EXPECT_NEAR(min_margin(red, 0.69, 0.305), 0.003, 1e-12) << "z = 0.005";
  EXPECT_NEAR(min_margin(red, 0.66, 0.34), -0.005, 1e-12) << "towards yellow";
  EXPECT_NEAR(min_margin(red, 0.68, 0.30), -0.012, 1e-12) << "towards purple";
  const TestPlan amber = r150("IVA", "amber");
  EXPECT_GT(min_margin(amber, 0.585, 0.41), 0.0);
  EXPECT_LT(min_margin(amber, 0.60, 0.395), 0.0) << "towards red";
  EXPECT_LT(min_margin(amber, 0.565, 0.43), 0.0) << "towards yellow";
  EXPECT_LT(min_margin(amber, 0.57, 0.42), 0.0) << "towards white";
  const TestPlan white = r150("IB", "white");
  ASSERT_EQ(white.boundaries.size(), 4U);
  EXPECT_GT(min_margin(white, 0.44757, 0.40745), 0.0) << "CIE A";
  for (const auto& [x, y] : {std::pair{0.31271, 0.32902}, {0.54, 0.44}, {0.45, 0.35}, {0.40, 0.46}})
    EXPECT_LT(min_margin(white, x, y), 0.0) << x << " " << y;
}

TEST(Limits, BoundariesAreLinesInThePlaneOfColours) {
  const auto boundary = [](const std::string& text) {
    const std::string line = "S,,red,0.3,0 or +-5,0," + text + ",chromaticity,read\n";
    return parse_limits(kHeader + std::string("S,,red,0.2,0,0,10,mcd/lx,read\n") + line, "l.csv").boundaries.at(0);
  };
  const auto margin = [&](const std::string& text, double x, double y) {
    const ColourBoundary b = boundary(text);
    return b.limit - b.x_coefficient * x - b.y_coefficient * y;
  };
  EXPECT_NEAR(margin("x <= 0.3", 0.2, 0.5), 0.1, 1e-15);
  EXPECT_NEAR(margin("y >= 0.3", 0.2, 0.5), 0.2, 1e-15);
  EXPECT_NEAR(margin("z <= 0.3", 0.2, 0.55), 0.05, 1e-15);
  EXPECT_NEAR(margin("y <= 0.1 + 2 x", 0.2, 0.4), 0.1, 1e-15);
  EXPECT_NEAR(margin("y >= 0.9 - 2 x", 0.2, 0.4), -0.1, 1e-15);
  EXPECT_EQ(boundary("y >= 0.9 - 2 x").text, "y >= 0.9 - 2 x");
  const std::string good = "S,,red,0.2,0,0,10,mcd/lx,read\n";
  for (const std::string text : {"y < 0.3", "w <= 0.3", "y <= a", "y <= 0.3 x", "y <= 0.3 + x", "y <= 0.3 * 2 x",
                                 "y <= 11", "y <=", "", "y >= 0.3 - 11 x"}) {
    const std::string message = message_of(kHeader + good + "S,,red,0.3,0,0," + text + ",chromaticity,read\n");
    EXPECT_EQ(message, "l.csv:3: minimum");
  }
  EXPECT_EQ(message_of(kHeader + good + "S,,red,0.3,0,0,x <= 0.3 + 1 x,chromaticity,read\n"), "l.csv:3: minimum");
  EXPECT_EQ(message_of(kHeader + good + "S,,red,0.3,+-5,0,y <= 0.3,chromaticity,read\n"), "l.csv:3: v_deg");
  EXPECT_EQ(message_of(kHeader + good + "S,,,0.3,0,0,y <= 0.3,chromaticity,read\n"), "l.csv:3: colour");
  const LimitTable two = parse_limits(
      kHeader + good + "S,,red,0.3,0,0,y <= 0.3,chromaticity,read\n" + "S,,red,0.4,0,0,z <= 0.3,chromaticity,read\n",
      "l.csv");
  EXPECT_EQ(refusal_of([&] { test_plan_of(two, {}, {}, {}); }), "l.csv:4");
}

// Every limit whose status is not `recalled` names its source.
TEST(Limits, EveryShippedLineNamesItsSource) {
  const LimitTable table = shipped();
  const auto check = [](const auto& lines) {
    for (const LimitLine& line : lines) {
      EXPECT_FALSE(line.source.empty()) << line.line;
      EXPECT_EQ(line.status == LimitStatus::recalled, line.source == "from memory") << line.line;
    }
  };
  check(table.rows);
  check(table.factors);
  check(table.areas);
  check(table.boundaries);
  const TestPoint amber = r150("IA", "amber").points[0];
  EXPECT_NE(amber.source.find("lexaris"), std::string::npos) << amber.source;
  EXPECT_NE(amber.source.find("German technical requirements"), std::string::npos) << amber.source;
}

TEST(Limits, AreasAreBoundedByTheStandards) {
  const auto holds = [](const TestPlan& programme, double area_cm2) {
    return area_verdict(programme, area_cm2) == Verdict::pass;
  };
  for (const std::string part_class : {"IA", "IB"}) {
    EXPECT_TRUE(holds(r150(part_class, "red"), 100.0));
    EXPECT_FALSE(holds(r150(part_class, "amber"), 100.1));
  }
  EXPECT_TRUE(holds(r150("IIIA", "red"), 170.0)) << "triangles have sides, not areas";
  EXPECT_TRUE(holds(r150("IVA", "white"), 25.0));
  EXPECT_FALSE(holds(r150("IVA", "white"), 24.9));
  const TestPlan j594 = test_plan_of(shipped(), "SAE J594 / FMVSS 108 XVI-a", {}, "red");
  EXPECT_TRUE(holds(j594, 77.4));
  EXPECT_FALSE(holds(j594, 77.5));
  TestPlan recalled = j594;
  recalled.areas[0].status = LimitStatus::recalled;
  EXPECT_EQ(area_verdict(recalled, 30.0), Verdict::unconfirmed);
}

TEST(Limits, UnitsAreThoseOfTheStandards) {
  EXPECT_NEAR(in_mcd_per_lx(1.0, PhotometricUnit::cd_per_fc, 1.0), 92.903, 5e-4);
  EXPECT_EQ(in_mcd_per_lx(2.0, PhotometricUnit::cd_per_lx, 1.0), 2000.0);
  EXPECT_EQ(in_mcd_per_lx(2.0, PhotometricUnit::mcd_per_lx, 5.0), 2.0);
  // A limit of 100 cd/(lx m^2) for an area of 30 cm^2 is 300 mcd/lx.
  EXPECT_NEAR(in_mcd_per_lx(100.0, PhotometricUnit::cd_per_lx_per_m2, 30.0), 300.0, 1e-12);
}

TEST(Limits, MalformedLinesAreRefusedByTheirLine) {
  const std::string good = "S,A,red,0.2,0,0,10,mcd/lx,read\n";
  EXPECT_EQ(message_of(kHeader + good), "accepted");
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"S,A,red,0.2,0,0,10,lm,read", "l.csv:3: unit"},
      {"S,A,red,0.2,0,0,10,mcd/lx,rumoured", "l.csv:3: status"},
      {"S,A,red,0.2,0,0,10,mcd/lx", "l.csv:3"},
      {"S,A,red,x,0,0,10,mcd/lx,read", "l.csv:3: observation_deg"},
      {"S,A,red,-0.2,0,0,10,mcd/lx,read", "l.csv:3: observation_deg"},
      {"S,A,red,21,0,0,10,mcd/lx,read", "l.csv:3: observation_deg"},
      {"S,A,red,0.2,90,0,10,mcd/lx,read", "l.csv:3: v_deg"},
      {"S,A,red,0.2,0,+-0,10,mcd/lx,read", "l.csv:3: h_deg"},
      {"S,A,red,0.2,0,nan,10,mcd/lx,read", "l.csv:3: h_deg"},
      {"S,A,red,0.2,0,0,0,mcd/lx,read", "l.csv:3: minimum"},
      {"S,A,red,0.2,0,0,inf,mcd/lx,read", "l.csv:3: minimum"},
      {",A,red,0.2,0,0,10,mcd/lx,read", "l.csv:3: standard"},
      {"S,A,,0.2,0,0,10,mcd/lx,read", "l.csv:3: colour"},
      {"S,A,amber,,,,2.5 times red,factor,read", "l.csv:3: minimum"},
      {"S,A,amber,0.2,,,2.5 x red,factor,read", "l.csv:3: observation_deg"},
      {"S,A,red,,,,5,,incomplete", "l.csv:3: minimum"},
      {"S,A,red,0.2,0 or,0,10,mcd/lx,read", "l.csv:3: v_deg"},
      {"S,A,red,0.2,0 or x,0,10,mcd/lx,read", "l.csv:3: v_deg"},
      {"S,A,red,0.2,0,0 or +-5,10,mcd/lx,read", "l.csv:3: h_deg"},
      {"S,A,,,,,at most 0,cm2,read", "l.csv:3: minimum"},
      {"S,A,,,,,about 10,cm2,read", "l.csv:3: minimum"},
      {"S,A,,0.2,,,at most 10,cm2,read", "l.csv:3: observation_deg"},
      {"S,A,,,,,at most 10,cm2,guessed", "l.csv:3: status"},
  };
  for (const auto& [line, place] : cases) EXPECT_EQ(message_of(kHeader + good + line + "\n"), place) << line;
  EXPECT_EQ(message_of("standard,limit\n"), "l.csv:1");
  EXPECT_EQ(message_of(""), "l.csv");
  const std::string with_source = std::string(kHeader, std::string_view(kHeader).size() - 1) + ",source\n";
  EXPECT_EQ(parse_limits(with_source + "S,A,red,0.2,0,0,10,mcd/lx,read,a book\n", "l.csv").rows[0].source, "a book");
  EXPECT_EQ(message_of(with_source + good), "l.csv:2");
  EXPECT_EQ(message_of(with_source.substr(0, with_source.size() - 1) + ",x\n"), "l.csv:1");
  const LimitTable twice = parse_limits(kHeader + good + good, "l.csv");
  EXPECT_THROW(test_plan_of(twice, {}, {}, {}), InputError);
  const LimitTable nothing_to_multiply = parse_limits(kHeader + good + "S,B,amber,,,,2 x red,factor,read\n", "l.csv");
  EXPECT_THROW(test_plan_of(nothing_to_multiply, {}, "B", "amber"), InputError);
}

TEST(Limits, OnlyConfirmedAndCompleteProgrammesPass) {
  PhotometricPoint point;
  point.limit_mcd_per_lx = 10.0;
  point.r_i_mcd_per_lx = 10.0;
  TestPlan programme;
  for (const auto& [status, complete, verdict] : {std::tuple{LimitStatus::confirmed, true, Verdict::pass},
                                                  {LimitStatus::read, true, Verdict::pass},
                                                  {LimitStatus::recalled, true, Verdict::unconfirmed},
                                                  {LimitStatus::read, false, Verdict::unconfirmed}}) {
    point.test_point.status = status;
    programme.is_complete = complete;
    EXPECT_EQ(verdict_of({point}, programme), verdict);
    PhotometricPoint below = point;
    below.r_i_mcd_per_lx = 9.999;
    EXPECT_EQ(verdict_of({point, below}, programme), Verdict::fail);
  }
}

}  // namespace
}  // namespace retrace::studies::limits_test
