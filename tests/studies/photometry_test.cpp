// Photometry of whole designs: limits files, closed forms, retrace rre at the same directions, dyes, what to change.
#include "studies/photometry/photometry.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <tuple>

#include "core/error.h"
#include "materials/io/spectrum_reader.h"
#include "raytrace/sampling/threads.h"
#include "studies/photometry/io/limits_reader.h"
#include "studies/photometry/io/photometry_files.h"
#include "studies/photometry/standards.h"
#include "tests/studies/photometric_requests.h"
#include "tests/support/closed_forms.h"
#include "tests/support/designs.h"
#include "tests/support/refusals.h"
#include "tests/support/statistics.h"

namespace retrace::studies::photometry_test {
namespace {

using namespace testing;
using namespace photometric_requests;
using geometry::Arrangement;
using std::numbers::pi;

constexpr const char* kHeader = "standard,class,colour,observation_deg,v_deg,h_deg,minimum,unit,status\n";

std::string message_of(const std::string& table) {
  return refusal_of([&] { parse_limits(table, "l.csv"); }, "accepted");
}

TEST(Limits, ShippedProgrammesHoldTheirPoints) {
  const TestProgramme ia = r150("IA", "red");
  ASSERT_EQ(ia.points.size(), 14U);
  EXPECT_TRUE(ia.is_complete);
  EXPECT_EQ(ia.points[0].minimum, 300.0);
  EXPECT_NEAR(ia.points[0].observation_deg, 1.0 / 3.0, 1e-6);
  EXPECT_EQ(ia.points[0].status, LimitStatus::read);
  EXPECT_EQ(ia.points[0].v_beside_deg, (std::vector<double>{5.0, -5.0})) << "UN R3: where the face mirrors";
  EXPECT_TRUE(ia.points[1].v_beside_deg.empty());
  // Both signs of V, and four combinations of signs.
  EXPECT_EQ(ia.points[1].v_deg, 10.0);
  EXPECT_EQ(ia.points[2].v_deg, -10.0);
  EXPECT_EQ(ia.points[6].v_deg, -5.0);
  EXPECT_EQ(ia.points[6].h_deg, -20.0);
  EXPECT_EQ(programme_of(shipped(), "SAE J594 / FMVSS 108 XVI-a", {}, "amber").points.size(), 10U);
  const TestProgramme bicycle = programme_of(shipped(), "16 CFR 1512", {}, "white");
  EXPECT_EQ(bicycle.part_class, "bicycle");
  EXPECT_TRUE(bicycle.is_complete);
  EXPECT_EQ(bicycle.points.size(), 22U) << "0, 10 and 20 degrees at both observation angles";
  for (const ShippedStandard& standard : shipped_standards())
    EXPECT_THROW(programme_of(shipped(), std::string(standard.in_table), {}, "no such"), InputError) << standard.name;
}

/// The limits of a colour are so many times those of another, at its points.
void expect_multiple(const TestProgramme& other, double factor, const TestProgramme& of) {
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
  const auto bicycle = [](const std::string& colour) { return programme_of(shipped(), "16 CFR 1512", {}, colour); };
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
  const TestProgramme amber = r150("IVA", "amber");
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
  EXPECT_EQ(programme_of(table, {}, {}, "amber").points[0].status, LimitStatus::recalled);
}

// R_A in cd/(lx m2) at beta1 = -4 and 30 degrees, which are V = 4 and -30.
TEST(Limits, SheetingIsMeasuredInTheCoplanarGeometry) {
  const TestProgramme two = programme_of(shipped(), "ASTM D4956", "II", "white");
  ASSERT_EQ(two.points.size(), 4U);
  EXPECT_EQ(two.points[0].v_deg, 4.0);
  EXPECT_EQ(two.points[1].v_deg, -30.0);
  EXPECT_EQ(two.points[0].unit, PhotometricUnit::cd_per_lx_per_m2);
  const std::vector<double> minima = {140.0, 60.0, 50.0, 28.0};
  for (std::size_t k = 0; k < minima.size(); ++k) EXPECT_EQ(two.points[k].minimum, minima[k]);
  EXPECT_TRUE(two.is_complete);
  EXPECT_FALSE(programme_of(shipped(), "ASTM D4956", "III", "white").is_complete)
      << "the copy ends before its last row";
  const TestProgramme clothing = programme_of(shipped(), "ISO 20471", "separate", "white");
  ASSERT_EQ(clothing.points.size(), 16U);
  EXPECT_EQ(clothing.points.front().minimum, 330.0);
  EXPECT_EQ(clothing.points.back().minimum, 4.0);
  EXPECT_EQ(clothing.points.back().v_deg, -40.0);
  const TestProgramme sign = programme_of(shipped(), "StVZVO 1998", "2", "yellow");
  ASSERT_EQ(sign.points.size(), 9U);
  EXPECT_EQ(sign.points[5].minimum, 60.0);
}

/// How far a colour is inside its boundaries; below 0: outside.
double least_margin(const TestProgramme& programme, double x, double y) {
  double least = 1.0;
  for (const ColourBoundary& b : programme.boundaries) least = std::min(least, b.most - b.of_x * x - b.of_y * y);
  return least;
}

TEST(Limits, ColoursLieWithinTheirBoundaries) {
  const TestProgramme red = r150("IA", "red");
  ASSERT_EQ(red.boundaries.size(), 2U);
  EXPECT_EQ(red.boundaries[0].v_beside_deg, (std::vector<double>{5.0, -5.0}));
  EXPECT_NEAR(least_margin(red, 0.69, 0.305), 0.003, 1e-12) << "z = 0.005";
  EXPECT_NEAR(least_margin(red, 0.66, 0.34), -0.005, 1e-12) << "towards yellow";
  EXPECT_NEAR(least_margin(red, 0.68, 0.30), -0.012, 1e-12) << "towards purple";
  const TestProgramme amber = r150("IVA", "amber");
  EXPECT_GT(least_margin(amber, 0.585, 0.41), 0.0);
  EXPECT_LT(least_margin(amber, 0.60, 0.395), 0.0) << "towards red";
  EXPECT_LT(least_margin(amber, 0.565, 0.43), 0.0) << "towards yellow";
  EXPECT_LT(least_margin(amber, 0.57, 0.42), 0.0) << "towards white";
  const TestProgramme white = r150("IB", "white");
  ASSERT_EQ(white.boundaries.size(), 4U);
  EXPECT_GT(least_margin(white, 0.44757, 0.40745), 0.0) << "CIE A";
  for (const auto& [x, y] : {std::pair{0.31271, 0.32902}, {0.54, 0.44}, {0.45, 0.35}, {0.40, 0.46}})
    EXPECT_LT(least_margin(white, x, y), 0.0) << x << " " << y;
}

TEST(Limits, BoundariesAreLinesInThePlaneOfColours) {
  const auto boundary = [](const std::string& text) {
    const std::string line = "S,,red,0.3,0 or +-5,0," + text + ",chromaticity,read\n";
    return parse_limits(kHeader + std::string("S,,red,0.2,0,0,10,mcd/lx,read\n") + line, "l.csv").boundaries.at(0);
  };
  const auto margin = [&](const std::string& text, double x, double y) {
    const ColourBoundary b = boundary(text);
    return b.most - b.of_x * x - b.of_y * y;
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
    EXPECT_TRUE(message.starts_with("l.csv:3: minimum: must be x, y or z, <= or >=")) << text << ": " << message;
  }
  EXPECT_TRUE(message_of(kHeader + good + "S,,red,0.3,0,0,x <= 0.3 + 1 x,chromaticity,read\n")
                  .starts_with("l.csv:3: minimum: must bound a colour"));
  EXPECT_TRUE(message_of(kHeader + good + "S,,red,0.3,+-5,0,y <= 0.3,chromaticity,read\n")
                  .starts_with("l.csv:3: v_deg: must be one angle of a colour"));
  EXPECT_TRUE(message_of(kHeader + good + "S,,,0.3,0,0,y <= 0.3,chromaticity,read\n").starts_with("l.csv:3: colour: "));
  const LimitTable two = parse_limits(
      kHeader + good + "S,,red,0.3,0,0,y <= 0.3,chromaticity,read\n" + "S,,red,0.4,0,0,z <= 0.3,chromaticity,read\n",
      "l.csv");
  EXPECT_EQ(refusal_of([&] { programme_of(two, {}, {}, {}); }),
            "l.csv:4: must bound the colour at the angles of line 3");
}

// What is not from memory names where it was read.
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
  const auto holds = [](const TestProgramme& programme, double area_cm2) {
    return area_verdict(programme, area_cm2) == Verdict::pass;
  };
  for (const std::string part_class : {"IA", "IB"}) {
    EXPECT_TRUE(holds(r150(part_class, "red"), 100.0));
    EXPECT_FALSE(holds(r150(part_class, "amber"), 100.1));
  }
  EXPECT_TRUE(holds(r150("IIIA", "red"), 170.0)) << "triangles have sides, not areas";
  EXPECT_TRUE(holds(r150("IVA", "white"), 25.0));
  EXPECT_FALSE(holds(r150("IVA", "white"), 24.9));
  const TestProgramme j594 = programme_of(shipped(), "SAE J594 / FMVSS 108 XVI-a", {}, "red");
  EXPECT_TRUE(holds(j594, 77.4));
  EXPECT_FALSE(holds(j594, 77.5));
  TestProgramme recalled = j594;
  recalled.areas[0].status = LimitStatus::recalled;
  EXPECT_EQ(area_verdict(recalled, 30.0), Verdict::unconfirmed);
}

TEST(Limits, UnitsAreThoseOfTheStandards) {
  EXPECT_NEAR(in_mcd_per_lx(1.0, PhotometricUnit::cd_per_fc, 1.0), 92.903, 5e-4);
  EXPECT_EQ(in_mcd_per_lx(2.0, PhotometricUnit::cd_per_lx, 1.0), 2000.0);
  EXPECT_EQ(in_mcd_per_lx(2.0, PhotometricUnit::mcd_per_lx, 5.0), 2.0);
  // 100 cd/(lx m^2) of 30 cm^2.
  EXPECT_NEAR(in_mcd_per_lx(100.0, PhotometricUnit::cd_per_lx_per_m2, 30.0), 300.0, 1e-12);
}

TEST(Limits, MalformedLinesAreRefusedByTheirLine) {
  const std::string good = "S,A,red,0.2,0,0,10,mcd/lx,read\n";
  EXPECT_EQ(message_of(kHeader + good), "accepted");
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"S,A,red,0.2,0,0,10,lm,read", "l.csv:3: unit: must be"},
      {"S,A,red,0.2,0,0,10,mcd/lx,rumoured", "l.csv:3: status: must be"},
      {"S,A,red,0.2,0,0,10,mcd/lx", "l.csv:3: must have the 9 values of the header, got 8"},
      {"S,A,red,x,0,0,10,mcd/lx,read", "l.csv:3: observation_deg: must be a number"},
      {"S,A,red,-0.2,0,0,10,mcd/lx,read", "l.csv:3: observation_deg: must be"},
      {"S,A,red,21,0,0,10,mcd/lx,read", "l.csv:3: observation_deg: must be"},
      {"S,A,red,0.2,90,0,10,mcd/lx,read", "l.csv:3: v_deg: must be"},
      {"S,A,red,0.2,0,+-0,10,mcd/lx,read", "l.csv:3: h_deg: must be"},
      {"S,A,red,0.2,0,nan,10,mcd/lx,read", "l.csv:3: h_deg: must be"},
      {"S,A,red,0.2,0,0,0,mcd/lx,read", "l.csv:3: minimum: must be a number > 0"},
      {"S,A,red,0.2,0,0,inf,mcd/lx,read", "l.csv:3: minimum: must be"},
      {",A,red,0.2,0,0,10,mcd/lx,read", "l.csv:3: standard: must name"},
      {"S,A,,0.2,0,0,10,mcd/lx,read", "l.csv:3: colour: must name"},
      {"S,A,amber,,,,2.5 times red,factor,read", "l.csv:3: minimum: must be a number above 0, to 1000, x and a colour"},
      {"S,A,amber,0.2,,,2.5 x red,factor,read", "l.csv:3: observation_deg: must be empty"},
      {"S,A,red,,,,5,,incomplete", "l.csv:3: minimum: must be empty"},
      {"S,A,red,0.2,0 or,0,10,mcd/lx,read", "l.csv:3: v_deg: must be"},
      {"S,A,red,0.2,0 or x,0,10,mcd/lx,read", "l.csv:3: v_deg: must be"},
      {"S,A,red,0.2,0,0 or +-5,10,mcd/lx,read", "l.csv:3: h_deg: must be"},
      {"S,A,,,,,at most 0,cm2,read",
       "l.csv:3: minimum: must be \"at most\" or \"at least\" and a number above 0, to 1e+06, got \"at most 0\""},
      {"S,A,,,,,about 10,cm2,read", "l.csv:3: minimum: must be \"at most\""},
      {"S,A,,0.2,,,at most 10,cm2,read", "l.csv:3: observation_deg: must be empty of an area"},
      {"S,A,,,,,at most 10,cm2,guessed", "l.csv:3: status: must be"},
  };
  for (const auto& [line, begin] : cases) {
    const std::string message = message_of(kHeader + good + line + "\n");
    EXPECT_TRUE(message.starts_with(begin)) << message << " should begin: " << begin;
    EXPECT_EQ(message.find('\n'), std::string::npos);
  }
  EXPECT_TRUE(message_of("standard,limit\n").starts_with("l.csv:1: must be the header"));
  EXPECT_TRUE(message_of("").starts_with("l.csv: must have the header"));
  const std::string with_source = std::string(kHeader, std::string_view(kHeader).size() - 1) + ",source\n";
  EXPECT_EQ(parse_limits(with_source + "S,A,red,0.2,0,0,10,mcd/lx,read,a book\n", "l.csv").rows[0].source, "a book");
  EXPECT_TRUE(message_of(with_source + good).starts_with("l.csv:2: must have the 10 values of the header, got 9"));
  EXPECT_TRUE(message_of(with_source.substr(0, with_source.size() - 1) + ",x\n").starts_with("l.csv:1: must be the"));
  const LimitTable twice = parse_limits(kHeader + good + good, "l.csv");
  EXPECT_THROW(programme_of(twice, {}, {}, {}), InputError);
  const LimitTable nothing_to_multiply = parse_limits(kHeader + good + "S,B,amber,,,,2 x red,factor,read\n", "l.csv");
  EXPECT_THROW(programme_of(nothing_to_multiply, {}, "B", "amber"), InputError);
}

TEST(Limits, OnlyConfirmedAndCompleteProgrammesPass) {
  PhotometricPoint point;
  point.limit_mcd_per_lx = 10.0;
  point.r_i_mcd_per_lx = 10.0;
  TestProgramme programme;
  for (const auto& [status, complete, verdict] : {std::tuple{LimitStatus::confirmed, true, Verdict::pass},
                                                  {LimitStatus::read, true, Verdict::pass},
                                                  {LimitStatus::recalled, true, Verdict::unconfirmed},
                                                  {LimitStatus::read, false, Verdict::unconfirmed}}) {
    point.asked.status = status;
    programme.is_complete = complete;
    EXPECT_EQ(verdict_of({point}, programme), verdict);
    PhotometricPoint below = point;
    below.r_i_mcd_per_lx = 9.999;
    EXPECT_EQ(verdict_of({point, below}, programme), Verdict::fail);
  }
}

// Perfect cubes with all dihedral errors 2.46 arcmin at n = 1.49 put six spots of a sixth at 0.2 degrees: a receiver
// there, smaller than the source, sees the lamp in one of them, R_A = 1 / (6 Omega_source); turned by 30 degrees it
// sees between two.
TEST(Photometry, ReceiverSeesOneOfSixSpots) {
  Design design = design_of(honeycomb(2.46), true);
  design.substance.refractive_index = 1.49;
  PhotometryRequest request = request_of(points_at({0.2}, 1.0));
  request.apertures = {Angle::from_deg(0.1), Angle::from_deg(0.05)};
  const double source_sr = pi * std::pow(0.05 * kDeg, 2.0);
  std::vector<double> seen;
  double rre = 0.0;
  for (const double turn : {0.0, 30.0, 60.0, 90.0, 180.0}) {
    request.rotation_deg = {turn};
    const PhotometryResult result = run(design, request);
    seen.push_back(result.points[0].r_a);
    rre = result.directions[0].rre;
  }
  EXPECT_NEAR(rre, 1.0, 0.01) << "rims that errors of angle lift take a little";
  const double most = *std::max_element(seen.begin(), seen.end());
  EXPECT_NEAR(most, rre / (6.0 * source_sr), 1e-6 * most);
  EXPECT_EQ(*std::min_element(seen.begin(), seen.end()), 0.0);
  EXPECT_NEAR(seen[0], seen[2], 1e-9 * most) << "a sixth of a turn";
  EXPECT_NEAR(seen[1], seen[3], 1e-9 * most);
  // Over several turns the least counts.
  request.rotation_deg = {0.0, 30.0, 60.0, 90.0};
  const PhotometricPoint all = run(design, request).points[0];
  EXPECT_EQ(all.r_a, 0.0);
  EXPECT_EQ(all.rotation_deg, seen[0] > 0.0 ? 30.0 : 0.0);
}

// The directions of V and H, turned into incidence and azimuth: RRE there is that of retrace rre.
TEST(Photometry, VhGridAgreesWithRre) {
  for (const geometry::PartSpec& spec :
       {honeycomb(), infinite(geometry::TriangularCube{1.0}, Arrangement::triangular, 1.0)}) {
    const Design design = design_of(spec, true);
    PhotometryRequest request = request_of(r150("IA", "red"));
    request.cutoff = 1e-9;
    const PhotometryResult result = run(design, request);
    ASSERT_EQ(result.directions.size(), 7U);
    for (const PhotometricDirection& at : result.directions) {
      const double v = at.v_deg * kDeg;
      const double h = at.h_deg * kDeg;
      RreRequest asked;
      asked.incidence_deg = {std::acos(std::cos(v) * std::cos(h)) / kDeg};
      asked.azimuth_deg = {std::atan2(std::sin(v), std::sin(h) * std::cos(v)) / kDeg};
      asked.engine = Engine::exact;
      asked.cutoff = 1e-9;
      const RreResult rre = RreStudy({design}, asked).run();
      EXPECT_NEAR(at.rre, rre.points[0].rre, 1e-8) << at.v_deg << " " << at.h_deg;
      EXPECT_GT(at.rre, 0.3);
    }
  }
}

// UN R3: where the face sends the mirror image of the lamp back, the least of the values at V = 5 and -5 counts.
TEST(Photometry, IsMeasuredBesideTheMirrorImage) {
  TestProgramme beside = points_at({0.2}, 1.0);
  beside.points[0].v_beside_deg = {5.0, -5.0};
  TestProgramme both = points_at({0.2, 0.2}, 1.0);
  both.points[0].v_deg = 5.0;
  both.points[1].v_deg = -5.0;
  // Unlike errors, so that both signs differ.
  geometry::PartSpec spec = honeycomb();
  spec.angle_errors.dihedral_error_arcmin = {2.0, 1.0, 3.0};
  const PhotometryResult found = run(design_of(spec), request_of(beside));
  const PhotometryResult apart = run(design_of(spec), request_of(both));
  const PhotometricPoint& up = apart.points[0];
  const PhotometricPoint& down = apart.points[1];
  ASSERT_GT(std::abs(up.r_a - down.r_a), 1e-3 * up.r_a);
  EXPECT_EQ(found.points[0].r_a, std::min(up.r_a, down.r_a));
  EXPECT_EQ(found.points[0].v_deg, up.r_a < down.r_a ? 5.0 : -5.0);
  EXPECT_EQ(found.points[0].asked.v_deg, 0.0);
  EXPECT_NE(photometry_table(found).find("beside the mirror image"), std::string::npos);
  // A face that reflects nothing has no mirror image.
  const PhotometryResult lossless = run(design_of(spec, true), request_of(beside));
  EXPECT_EQ(lossless.points[0].v_deg, 0.0);
  EXPECT_EQ(lossless.points[0].r_a, run(design_of(spec, true), request_of(points_at({0.2}, 1.0))).points[0].r_a);
}

// Directions that share their light, as turns at normal incidence and mirror images do, have the values that each has
// by itself.
TEST(Photometry, DirectionsThatShareTheirLightHaveTheirOwnValues) {
  TestProgramme all = points_at({0.2, 0.33, 0.33, 0.33}, 1.0);
  const std::vector<std::pair<double, double>> v_and_h = {{0.0, 0.0}, {5.0, 20.0}, {-5.0, 20.0}, {-5.0, -20.0}};
  for (std::size_t k = 0; k < v_and_h.size(); ++k) std::tie(all.points[k].v_deg, all.points[k].h_deg) = v_and_h[k];
  PhotometryRequest request = request_of(all);
  request.diffraction = true;
  request.engine = Engine::exact;
  request.cutoff = 1e-6;
  const Design design = design_of(honeycomb(2.0));
  for (const double turn : {0.0, 40.0}) {
    request.rotation_deg = {turn};
    request.programme = all;
    const PhotometryResult together = run(design, request);
    for (std::size_t k = 0; k < v_and_h.size(); ++k) {
      request.programme = all;
      request.programme.points = {all.points[k]};
      const PhotometryResult alone = run(design, request);
      EXPECT_NEAR(together.points[k].r_a, alone.points[0].r_a, 1e-4 * alone.points[0].r_a) << k << ", turned " << turn;
      EXPECT_EQ(together.points[k].v_deg, alone.points[0].v_deg);
      EXPECT_NEAR(together.directions[k].rre, alone.directions[0].rre, 1e-5) << k;
    }
  }
}

/// Diffracted, at 20 degrees, where light is trapped.
PhotometryRequest diffracted(Engine engine) {
  TestProgramme programme = points_at({0.0, 0.2, 0.33, 0.5}, 1.0);
  for (TestPoint& point : programme.points) point.h_deg = 20.0;
  PhotometryRequest request = request_of(programme);
  request.diffraction = true;
  request.engine = engine;
  return request;
}

// Beams below the cut-off are resampled, so that nothing is given up and the error of points is known; the exact engine
// gives them up.
TEST(Photometry, ResamplesWeakBeams) {
  geometry::PartSpec small = finite(geometry::HexagonalCube{1.0}, Arrangement::honeycomb, 4.0, 4.0, 1.0);
  small.angle_errors.dihedral_error_arcmin.fill(2.0);
  for (const geometry::PartSpec& spec : {honeycomb(2.0), small}) {
    const Design design = design_of(spec);
    PhotometryRequest request = diffracted(Engine::exact);
    const PhotometryResult exact = run(design, request);
    request.cutoff = 1e-7;
    const PhotometryResult further = run(design, request);
    const PhotometryResult resampled = run(design, diffracted(Engine::automatic));
    EXPECT_EQ(exact.engine, "exact");
    EXPECT_EQ(resampled.engine, "stochastic");
    EXPECT_GT(exact.directions[0].truncated, 1e-5);
    EXPECT_EQ(exact.directions[0].std_error, 0.0);
    EXPECT_LT(std::abs(resampled.directions[0].truncated), 1e-12);
    EXPECT_GT(resampled.directions[0].std_error, 0.0);
    EXPECT_NEAR(resampled.directions[0].rre, further.directions[0].rre,
                student_bound(2, 16) * resampled.directions[0].std_error + further.directions[0].truncated);
    for (std::size_t k = 0; k < resampled.points.size(); ++k) {
      const PhotometricPoint& point = resampled.points[k];
      EXPECT_EQ(exact.points[k].std_error_mcd_per_lx, 0.0);
      EXPECT_GT(point.std_error_mcd_per_lx, 0.0);
      EXPECT_LT(point.std_error_mcd_per_lx, 2e-3 * point.r_i_mcd_per_lx);
      // Interference that is lost takes or gives some 1e-3 more.
      EXPECT_NEAR(point.r_i_mcd_per_lx, further.points[k].r_i_mcd_per_lx,
                  student_bound(8, 16) * point.std_error_mcd_per_lx + 2e-3 * point.r_i_mcd_per_lx)
          << k;
    }
  }
}

TEST(Photometry, ResampledBeamsDependOnTheSeedAndNotOnThreads) {
  const Design design = design_of(honeycomb(2.0));
  PhotometryRequest request = diffracted(Engine::automatic);
  std::vector<PhotometryResult> results;
  for (const unsigned threads : {1U, 3U})
    raytrace::run_with_threads(threads, [&] { results.push_back(run(design, request)); });
  request.seed = 2;
  const PhotometryResult other = run(design, request);
  for (std::size_t k = 0; k < other.points.size(); ++k) {
    EXPECT_EQ(results[0].points[k].r_a, results[1].points[k].r_a);
    EXPECT_EQ(results[0].points[k].std_error_mcd_per_lx, results[1].points[k].std_error_mcd_per_lx);
    EXPECT_NE(results[0].points[k].r_a, other.points[k].r_a);
  }
}

// However bright it is, a part of another size is not one of its class, and no change of its cells mends that.
TEST(Photometry, APartOfTheWrongAreaFails) {
  PhotometryRequest request = request_of(points_at({0.1}, 1.0));
  LimitArea most;
  most.area_cm2 = 5.0;
  most.status = LimitStatus::read;
  request.programme.areas = {most};
  request.advice = true;
  const Design design = design_of(honeycomb(0.0, 20.0), true);
  const PhotometryResult large = run(design, request);
  EXPECT_EQ(large.verdict, Verdict::fail);
  EXPECT_EQ(large.points[0].verdict(), Verdict::pass);
  EXPECT_TRUE(large.changes.empty());
  EXPECT_NE(photometry_table(large).find("area: FAIL - at most 5 cm2, has 10"), std::string::npos);
  EXPECT_NE(photometry_json(large).find("\"limit\": \"at most 5 cm2\""), std::string::npos);
  request.area_cm2 = 4.0;
  EXPECT_EQ(run(design, request).verdict, Verdict::pass);
}

// A grey dye takes exp(-a L) of every direction at normal incidence, L = 2 (plate + depth) in a perfect prism array.
TEST(Photometry, DyeTakesItsShareOfTheFlux) {
  const Design design = design_of(infinite(geometry::RtpElement{0.5, 0.5, 90.0}, Arrangement::aligned, 2.0), true);
  PhotometryRequest request = request_of(points_at({0.05}, 1.0));
  request.light = PhotometricLight::illuminant_a;
  const double clear = run(design, request).points[0].r_a;
  const double way_mm = 2.0 * 2.25;
  request.dye_absorption_per_mm = {{380.0, 780.0}, {0.2, 0.2}};
  EXPECT_NEAR(run(design, request).points[0].r_a / clear, std::exp(-0.2 * way_mm), 1e-9);
  // The shipped ones: the sum over the table of the lamp and the eye.
  const materials::CieTable cie =
      materials::read_cie_table(std::string(RETRACE_SOURCE_DIR) + "/data/cie_v_a_d65_5nm.csv");
  for (const std::string name : {"red", "amber"}) {
    request.dye_absorption_per_mm =
        materials::read_spectral_absorption(std::string(RETRACE_SOURCE_DIR) + "/data/dye_" + name + ".csv");
    double all = 0.0;
    double behind = 0.0;
    for (std::size_t k = 0; k < cie.illuminant_a.values.size(); ++k) {
      const double w = cie.illuminant_a.wavelengths_nm[k];
      const double flux = cie.illuminant_a.values[k] * cie.photopic_efficiency.at(w);
      all += flux;
      behind += flux * std::exp(-request.dye_absorption_per_mm.at(w) * way_mm);
    }
    EXPECT_NEAR(run(design, request).points[0].r_a / clear, behind / all, 2e-3 * behind / all) << name;
    EXPECT_GT(behind / all, 0.1);
    EXPECT_LT(behind / all, 0.7);
  }
}

// Monte Carlo through the same discs, within its own error.
TEST(Photometry, MonteCarloAgreesWithTheExactEngine) {
  const Design design = design_of(honeycomb(4.0));
  PhotometryRequest request = request_of(r150("IA", "red"));
  request.programme.points.resize(4);
  request.engine = Engine::exact;
  const PhotometryResult exact = run(design, request);
  request.engine = Engine::montecarlo;
  request.rays = 1U << 17;
  const PhotometryResult found = run(design, request);
  EXPECT_EQ(exact.engine, "exact");
  EXPECT_EQ(found.engine, "embree");
  const double bound = student_bound(exact.points.size());
  for (std::size_t k = 0; k < exact.points.size(); ++k) {
    EXPECT_GT(found.points[k].std_error_mcd_per_lx, 0.0);
    EXPECT_NEAR(found.points[k].r_i_mcd_per_lx, exact.points[k].r_i_mcd_per_lx,
                bound * found.points[k].std_error_mcd_per_lx + 1e-3 * exact.points[k].r_i_mcd_per_lx);
  }
}

// Diffraction fills the place between the spots, and what leaves the window is told.
TEST(Photometry, DiffractionReachesWhereRaysDoNot) {
  const Design design = design_of(honeycomb(0.0, 0.4));
  PhotometryRequest request = request_of(points_at({1.0 / 3.0}, 1.0));
  EXPECT_EQ(run(design, request).points[0].r_a, 0.0);
  request.diffraction = true;
  EXPECT_FALSE(run(design, request).directions[0].split) << "takes long, and was not asked for";
  request.window_power = true;
  const PhotometryResult result = run(design, request);
  EXPECT_GT(result.points[0].r_a, 50.0);
  ASSERT_TRUE(result.directions[0].split);
  const auto& split = *result.directions[0].split;
  EXPECT_NEAR(split.window + split.outside, split.geometric, 1e-3);
  EXPECT_GT(split.outside, 5e-3);
}

// Flawless cubes send nothing to a driver above the lamps; the program finds the error that does, and its table is that
// of the changed design.
TEST(Photometry, FindsTheAngleErrorThatPasses) {
  const Design design = design_of(honeycomb(0.0, 10.0), true);
  PhotometryRequest request = request_of(points_at({1.0 / 3.0}, 300.0));
  request.rotation_deg = {0.0, 30.0};
  // Half a degree of receiver, so that one ring of six spots serves both turns.
  request.apertures = {Angle::from_deg(0.5), Angle::from_deg(0.1)};
  request.advice = true;
  const PhotometryResult result = run(design, request);
  EXPECT_EQ(result.verdict, Verdict::fail);
  ASSERT_EQ(result.changes.size(), 1U);
  const PhotometricChange& change = result.changes[0];
  EXPECT_EQ(change.key, "surface.dihedral_error_arcmin");
  EXPECT_EQ(change.verdict, Verdict::pass);
  Design changed = design;
  changed.part().angle_errors.dihedral_error_arcmin.fill(change.to);
  request.advice = false;
  const PhotometryResult again = run(changed, request);
  ASSERT_EQ(again.points.size(), change.points.size());
  for (std::size_t k = 0; k < again.points.size(); ++k)
    EXPECT_EQ(again.points[k].r_i_mcd_per_lx, change.points[k].r_i_mcd_per_lx);
  EXPECT_EQ(again.verdict, Verdict::pass);
}

/// Interrupts when all of the table has been measured.
struct InterruptAfterTheTable : Progress {
  Cancellation cancellation;
  void at(double share) override {
    if (share >= 1.0) cancellation.request();
  }
};

TEST(Photometry, AnInterruptedSearchForWhatToChangeIsNotComplete) {
  PhotometryRequest request = request_of(points_at({1.0 / 3.0}, 1e8));
  request.advice = true;
  InterruptAfterTheTable interrupt;
  const PhotometryResult result =
      PhotometryStudy(design_of(honeycomb(0.0, 60.0), true), request).run(&interrupt, &interrupt.cancellation);
  EXPECT_EQ(result.points.size(), 1U);
  EXPECT_FALSE(result.complete);
  EXPECT_TRUE(result.changes.empty());
}

TEST(Photometry, WhatCannotPassIsToldWithTheBestThatWasTried) {
  const Design design = design_of(honeycomb(0.0, 60.0), true);
  PhotometryRequest request = request_of(points_at({1.0 / 3.0}, 1e8));
  request.advice = true;
  const PhotometryResult result = run(design, request);
  ASSERT_EQ(result.changes.size(), 2U);
  for (const PhotometricChange& change : result.changes) EXPECT_EQ(change.verdict, Verdict::fail);
  EXPECT_NE(photometry_table(result).find("not enough"), std::string::npos);
}

TEST(Photometry, RefusesWhatItCannotMeasure) {
  const Design design = design_of(honeycomb(), true);
  const auto refusal = [&](const std::function<void(PhotometryRequest&)>& spoil) -> std::string {
    PhotometryRequest request = request_of(points_at({0.2, 1.5}, 1.0));
    request.limits_source = "l.csv";
    spoil(request);
    return refusal_of([&] { PhotometryStudy(design, request); }, "accepted");
  };
  EXPECT_EQ(refusal([](auto&) {}), "accepted");
  EXPECT_TRUE(refusal([](auto& r) { r.area_cm2 = 0.0; }).starts_with("--area-cm2: must be a number above 0"));
  EXPECT_TRUE(refusal([](auto& r) { r.window_deg = 1.0; }).starts_with("l.csv:2: observation_deg: must lie within"));
  EXPECT_TRUE(refusal([](auto& r) { r.window_deg = 20.0; }).starts_with("--window-deg: must be"));
  EXPECT_TRUE(refusal([](auto& r) { r.apertures = {}; }).starts_with("--source-arcmin: must be"));
  EXPECT_TRUE(refusal([](auto& r) { r.engine = Engine::cell; }).starts_with("--engine: must be"));
}

}  // namespace
}  // namespace retrace::studies::photometry_test
