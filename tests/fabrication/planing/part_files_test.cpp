// Tests of the files of planed and turned parts: what is read, and what is refused with one line.

#include <gtest/gtest.h>

#include <string>

#include "core/error.h"
#include "core/number_format.h"
#include "fabrication/planing/io/part_files.h"
#include "fabrication/planing/plan/nose_path.h"
#include "tests/support/refusals.h"

namespace retrace::fabrication::part_files_test {
namespace {

const std::string kMilled = R"(schema = "retrace.planed_part/1"
[element]
kind = "zone_lens"
focal_length_mm = 500
wavelength_mm = 5
refractive_index = 1.5
width_mm = 400
length_mm = 300
[tolerance]
form_mm = 0.2
[mill]
fast_feed_mm_per_min = 3000
)";

std::string refusal(const std::string& from, const std::string& to, const std::string& text = kMilled) {
  return refusal_of([&] { parse_planed_part(with_replaced(text, from, to), "p.toml"); }, "accepted");
}

TEST(PlanedPart, DefaultsAreThoseOfTheMachineOfThePaper) {
  const PlanedPart part = parse_planed_part(kMilled, "p.toml");
  ASSERT_TRUE(part.mill);
  EXPECT_FALSE(part.lathe);
  EXPECT_EQ(part.lens.half_width_mm, 200.0);
  EXPECT_EQ(part.mill->grid_mm, 0.01);
  EXPECT_EQ(part.mill->least_x_mm, 13.0);
  EXPECT_EQ(part.mill->least_y_mm, 13.0);
  EXPECT_EQ(part.mill->least_z_mm, 6.0);
  EXPECT_EQ(part.mill->most_hours, 8.0);
}

const std::string kTurned = R"(schema = "retrace.planed_part/1"
[element]
kind = "round_zone_lens"
focal_length_mm = 500
wavelength_mm = 5
refractive_index = 1.5
width_mm = 400
[tolerance]
form_mm = 0.05
[lathe]
feed_mm_per_min = 200
nose_radius_mm = 0.8
spindle_rpm = 800
spindle_direction = "counterclockwise"
)";
const std::string kTexts = "spindle_start = \"M103\"\nspindle_stop = \"M105\"\n";

TEST(PlanedPart, NoseOfALathe) {
  EXPECT_EQ(parse_planed_part(kTurned, "p.toml").lathe->nose_radius_mm, 0.8);
  EXPECT_EQ(refusal("nose_radius_mm = 0.8", "nose_radius_mm = -0.1", kTurned),
            "p.toml:12: lathe.nose_radius_mm: must be >= 0 and <= 100, got -0.1");
  const std::string most = fixed(largest_nose_mm(ZoneProfile({500.0, 5.0, 1.5, 200.0})), 3);
  EXPECT_EQ(refusal("nose_radius_mm = 0.8", "nose_radius_mm = 40", kTurned),
            "p.toml:12: lathe.nose_radius_mm: must be <= " + most +
                ", or the nose does not reach the bottom of every zone, got 40");
}

TEST(PlanedPart, SpindleOfALathe) {
  const PlaningLathe lathe = *parse_planed_part(kTurned + kTexts, "p.toml").lathe;
  EXPECT_EQ(lathe.spindle_rpm, 800);
  EXPECT_EQ(lathe.spindle_direction, SpindleDirection::counterclockwise);
  EXPECT_EQ(lathe.spindle_start, "M103");
  EXPECT_EQ(lathe.spindle_stop, "M105");
  EXPECT_EQ(lathe.spindle_start_at.line, 15);
  EXPECT_EQ(parse_planed_part(kTurned, "p.toml").lathe->spindle_start, "");
  const auto turned = [](const std::string& from, const std::string& to) {
    return refusal(from, to, kTurned + kTexts);
  };
  EXPECT_EQ(turned("spindle_rpm = 800\n", ""),
            "p.toml:10: lathe.spindle_rpm: missing, must be a whole number >= 1 and <= 99999");
  EXPECT_EQ(turned("spindle_rpm = 800", "spindle_rpm = 0"),
            "p.toml:13: lathe.spindle_rpm: must be >= 1 and <= 99999, got 0");
  EXPECT_EQ(turned("spindle_rpm = 800", "spindle_rpm = 100000"),
            "p.toml:13: lathe.spindle_rpm: must be >= 1 and <= 99999, got 100000");
  EXPECT_EQ(turned("spindle_rpm = 800", "spindle_rpm = 800.5"),
            "p.toml:13: lathe.spindle_rpm: must be a whole number, got 800.5");
  EXPECT_EQ(turned("spindle_direction = \"counterclockwise\"\n", ""),
            "p.toml:10: lathe.spindle_direction: missing, must be \"clockwise\" or \"counterclockwise\"");
  EXPECT_EQ(turned("\"counterclockwise\"", "\"left\""),
            "p.toml:14: lathe.spindle_direction: must be \"clockwise\" or \"counterclockwise\", got \"left\"");
  EXPECT_EQ(turned("spindle_start = \"M103\"\n", ""),
            "p.toml:15: lathe.spindle_stop: only allowed with spindle_start, got \"M105\"");
  EXPECT_EQ(turned("spindle_stop = \"M105\"\n", ""),
            "p.toml:15: lathe.spindle_start: only allowed with spindle_stop, got \"M103\"");
  EXPECT_EQ(turned("M105", "M103"), "p.toml:16: lathe.spindle_stop: must not be spindle_start, got \"M103\"");
  for (const char* bad : {"", " M103", "M103 ", "M103 // on", "M103\\nM7", "M\\u00fc"})
    EXPECT_TRUE(turned("\"M103\"", "\"" + std::string(bad) + "\"")
                    .starts_with("p.toml:15: lathe.spindle_start: must be one line of 1 to 200 printable ASCII "
                                 "characters, without // and "
                                 "without bla"))
        << bad;
}

TEST(PlanedPart, FeedsThatNoProgramCanSayAreRefused) {
  EXPECT_EQ(refusal("feed_mm_per_min = 200", "feed_mm_per_min = 4e-4", kTurned),
            "p.toml:11: lathe.feed_mm_per_min: must be >= 1 and <= 1e+06, got 4e-04");
  EXPECT_EQ(refusal("fast_feed_mm_per_min = 3000", "fast_feed_mm_per_min = 4e-4"),
            "p.toml:12: mill.fast_feed_mm_per_min: must be >= 1 and <= 1e+06, got 4e-04");
}

TEST(PlanedPart, BadInputIsOneLineWithItsPlace) {
  EXPECT_EQ(refusal("retrace.planed_part/1", "retrace.job/1"),
            "p.toml:1: schema: must be \"retrace.planed_part/1\", got \"retrace.job/1\"");
  EXPECT_EQ(refusal("focal_length_mm = 500", "focal_length_mm = -5"),
            "p.toml:4: element.focal_length_mm: must be >= 0.1 and <= 10000, got -5");
  EXPECT_EQ(refusal("refractive_index = 1.5", "refractive_index = 1"),
            "p.toml:6: element.refractive_index: must be >= 1.01 and <= 5, got 1");
  EXPECT_EQ(refusal("form_mm = 0.2", "form_mm = 0.015"),
            "p.toml:10: tolerance.form_mm: must be >= two steps of the machine's grid, 0.020000, got 0.015");
  EXPECT_EQ(refusal("form_mm = 0.2", "form_mm = 6"),
            "p.toml:10: tolerance.form_mm: must be <= half the depth of a zone, 5.000000, got 6");
  EXPECT_EQ(refusal("form_mm = 0.2", "form_mm = 4"),
            "p.toml:10: tolerance.form_mm: must be <= 200 steps of the machine's grid, 2.000000, got 4");
  EXPECT_EQ(refusal("[mill]\n", "[mill]\nclear_mm = 3\n"),
            "p.toml:12: mill.clear_mm: must be at least the least move of Z, 6, got 3");
  EXPECT_EQ(refusal("[mill]\nfast_feed_mm_per_min = 3000\n", ""), "p.toml: mill: missing, must be a table");
}

TEST(PlanedPart, UnknownKeysAndTablesAreRefused) {
  EXPECT_NE(refusal("[mill]\n", "[mill]\nspeed = 3\n").find("p.toml:12: mill.speed"), std::string::npos);
  EXPECT_NE(refusal("[mill]\n", "[lathe]\nfeed_mm_per_min = 3\n[mill]\n").find("lathe"), std::string::npos);
  EXPECT_NE(refusal("kind = \"zone_lens\"", "kind = \"lens\"").find("p.toml:3: element.kind"), std::string::npos);
}

TEST(PlanedPart, ZonesThatDoNotFitAreRefused) {
  EXPECT_NE(refusal("focal_length_mm = 500", "focal_length_mm = 20").find("p.toml:4: element.focal_length_mm"),
            std::string::npos)
      << refusal("focal_length_mm = 500", "focal_length_mm = 20");
}

}  // namespace
}  // namespace retrace::fabrication::part_files_test
