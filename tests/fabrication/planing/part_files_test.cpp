// Tests of the files of planed and turned parts: the values of accepted files, and the one-line messages for refused
// files.

#include <gtest/gtest.h>

#include <string>

#include "core/error.h"
#include "fabrication/planing/io/part_files.h"
#include "tests/support/refusals.h"

namespace retrace::fabrication::part_files_test {
namespace {

/// Returns the first lines of a part file, up to the width of the lens.
std::string lens(const std::string& kind) {
  return "schema = \"retrace.planed_part/1\"\n[element]\nkind = \"" + kind +
         "\"\nfocal_length_mm = 500\nwavelength_mm = 5\nrefractive_index = 1.5\nwidth_mm = 400\n";
}

const std::string kMilled = lens("zone_lens") + R"(length_mm = 300
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
  EXPECT_EQ(part.mill->min_move_x_mm, 13.0);
  EXPECT_EQ(part.mill->min_move_y_mm, 13.0);
  EXPECT_EQ(part.mill->min_move_z_mm, 6.0);
  EXPECT_EQ(part.mill->max_hours, 8.0);
}

const std::string kTurned = lens("round_zone_lens") + R"([tolerance]
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
  EXPECT_EQ(refusal("nose_radius_mm = 0.8", "nose_radius_mm = -0.1", kTurned), "p.toml:12: lathe.nose_radius_mm");
  EXPECT_EQ(refusal("nose_radius_mm = 0.8", "nose_radius_mm = 40", kTurned), "p.toml:12: lathe.nose_radius_mm");
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
  EXPECT_EQ(turned("spindle_rpm = 800\n", ""), "p.toml:10: lathe.spindle_rpm");
  EXPECT_EQ(turned("spindle_rpm = 800", "spindle_rpm = 0"), "p.toml:13: lathe.spindle_rpm");
  EXPECT_EQ(turned("spindle_rpm = 800", "spindle_rpm = 100000"), "p.toml:13: lathe.spindle_rpm");
  EXPECT_EQ(turned("spindle_rpm = 800", "spindle_rpm = 800.5"), "p.toml:13: lathe.spindle_rpm");
  EXPECT_EQ(turned("spindle_direction = \"counterclockwise\"\n", ""), "p.toml:10: lathe.spindle_direction");
  EXPECT_EQ(turned("\"counterclockwise\"", "\"left\""), "p.toml:14: lathe.spindle_direction");
  EXPECT_EQ(turned("spindle_start = \"M103\"\n", ""), "p.toml:15: lathe.spindle_stop");
  EXPECT_EQ(turned("spindle_stop = \"M105\"\n", ""), "p.toml:15: lathe.spindle_start");
  EXPECT_EQ(turned("M105", "M103"), "p.toml:16: lathe.spindle_stop");
  for (const char* bad : {"", " M103", "M103 ", "M103 // on", "M103\\nM7", "M\\u00fc"})
    EXPECT_EQ(turned("\"M103\"", "\"" + std::string(bad) + "\""), "p.toml:15: lathe.spindle_start");
}

TEST(PlanedPart, FeedsThatNoProgramCanSayAreRefused) {
  EXPECT_EQ(refusal("feed_mm_per_min = 200", "feed_mm_per_min = 4e-4", kTurned), "p.toml:11: lathe.feed_mm_per_min");
  EXPECT_EQ(refusal("fast_feed_mm_per_min = 3000", "fast_feed_mm_per_min = 4e-4"),
            "p.toml:12: mill.fast_feed_mm_per_min");
}

TEST(PlanedPart, BadInputIsOneLineWithItsPlace) {
  expect_change_refusals([](const std::string& from, const std::string& to) { return refusal(from, to); },
                         {{"retrace.planed_part/1", "retrace.job/1", "p.toml:1: schema"},
                          {"focal_length_mm = 500", "focal_length_mm = -5", "p.toml:4: element.focal_length_mm"},
                          {"refractive_index = 1.5", "refractive_index = 1", "p.toml:6: element.refractive_index"},
                          {"form_mm = 0.2", "form_mm = 0.015", "p.toml:10: tolerance.form_mm"},
                          {"form_mm = 0.2", "form_mm = 6", "p.toml:10: tolerance.form_mm"},
                          {"form_mm = 0.2", "form_mm = 4", "p.toml:10: tolerance.form_mm"},
                          {"[mill]\n", "[mill]\nclear_mm = 3\n", "p.toml:12: mill.clear_mm"},
                          {"[mill]\nfast_feed_mm_per_min = 3000\n", "", "p.toml: mill"}});
}

TEST(PlanedPart, UnknownKeysAndTablesAreRefused) {
  EXPECT_EQ(refusal("[mill]\n", "[mill]\nspeed = 3\n"), "p.toml:12: mill.speed");
  EXPECT_EQ(refusal("[mill]\n", "[lathe]\nfeed_mm_per_min = 3\n[mill]\n"), "p.toml:11: lathe");
  EXPECT_EQ(refusal("kind = \"zone_lens\"", "kind = \"lens\""), "p.toml:3: element.kind");
}

TEST(PlanedPart, ZonesThatDoNotFitAreRefused) {
  EXPECT_EQ(refusal("focal_length_mm = 500", "focal_length_mm = 20"), "p.toml:4: element.focal_length_mm");
}

}  // namespace
}  // namespace retrace::fabrication::part_files_test
