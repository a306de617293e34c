#include <gtest/gtest.h>

#include <numbers>
#include <string>

#include "design/io/design_document.h"
#include "design/io/design_reader.h"
#include "design/part_of_design.h"
#include "geometry/outline/plan_region.h"
#include "geometry/part/part.h"
#include "tests/support/refusals.h"

// Tests of the table [outline]: allowed values, the part that results, and errors at the key that causes them.

namespace retrace::studies::outline_reader_test {
namespace {

constexpr double kPi = std::numbers::pi;

std::string design(const std::string& outline, const std::string& array = "", const std::string& more = "") {
  return "[element]\nkind = \"rtp\"\nbase_mm = 0.5\nwidth_mm = 0.5\n[array]\n" + array + "\n[outline]\n" + outline +
         "\n[body]\nthickness_mm = 1\n" + more;
}
const std::string kSquare = "polygon_mm = [[0, 0], [10, 0], [10, 10], [0, 10]]\n";

design::Design read(const std::string& text) {
  return design::parse_design(text, "d.toml", {});
}
std::string complaint(const std::string& text) {
  return refusal_of([&] { read(text); }, "nothing");
}
double area_of(const std::string& outline) {
  return geometry::build_part(read(design(outline)).part()).entrance_area_mm2;
}

TEST(OutlineReader, AreasAreAnalytic) {
  EXPECT_NEAR(area_of(kSquare), 100.0, 1e-12);
  EXPECT_NEAR(area_of(kSquare + "corner_radius_mm = 2"), 100 - (4 - kPi) * 4, 1e-9);
  EXPECT_NEAR(area_of(kSquare + "corner_radius_mm = [2, 0, 0, 1]"), 100 - (1 - kPi / 4) * 5, 1e-9);
  EXPECT_NEAR(area_of("circle_mm = [3, -4, 5]\nholes_mm = [[3, -4, 1]]"), kPi * 24, 1e-9);
  // A sagitta of half the chord is a half circle, outside or inside, for both directions of the border.
  EXPECT_NEAR(area_of(kSquare + "side_sagitta_mm = [0, 5, 0, 0]"), 100 + 12.5 * kPi, 1e-9);
  EXPECT_NEAR(area_of("polygon_mm = [[0, 10], [10, 10], [10, 0], [0, 0]]\nside_sagitta_mm = [0, -2, 0, 0]"),
              area_of(kSquare + "side_sagitta_mm = [0, -2, 0, 0]"), 1e-9);
}

TEST(OutlineReader, TheOriginIsTheCornerOfTheBoundingBox) {
  const design::Design moved = read(design("polygon_mm = [[-5, 3], [5, 3], [8, 9], [-2, 9]]"));
  EXPECT_DOUBLE_EQ(moved.part().array.x_length_mm, 13.0);
  EXPECT_DOUBLE_EQ(moved.part().array.y_length_mm, 6.0);
  EXPECT_DOUBLE_EQ(moved.part().array.outline->whole.borders[0][0].x(), 0.0);
}

TEST(OutlineReader, DocumentsDescribeTheSameOutline) {
  for (const std::string& outline :
       {kSquare + "corner_radius_mm = 2\nmargin_mm = 0.3\nside_sagitta_mm = [1, 0, -1, 0]",
        std::string("circle_mm = [3, -4, 5]\nholes_mm = [[3, -4, 1]]\ntolerance_mm = 0.02")}) {
    const design::Design first = read(design(outline));
    const design::Design second = read(design::design_text(first));
    EXPECT_NEAR(first.part().array.outline->area_mm2(), second.part().array.outline->area_mm2(), 1e-9);
    EXPECT_EQ(first.part().array.outline->margin_mm, second.part().array.outline->margin_mm);
    EXPECT_EQ(first.part().array.outline->tolerance_mm, second.part().array.outline->tolerance_mm);
    EXPECT_EQ(first.part().array.outline->whole.borders.size(), second.part().array.outline->whole.borders.size());
  }
}

TEST(OutlineReader, FaultsAreReportedAtTheirKey) {
  EXPECT_EQ(complaint(design("polygon_mm = [[0, 0], [10, 10], [10, 0], [0, 10]]")), "d.toml:8: outline.polygon_mm");
  EXPECT_EQ(complaint(design("polygon_mm = [[0, 0], [10, 10], [10, 0], [0, 10]]\nholes_mm = [[3, 5, 1]]")),
            "d.toml:8: outline.polygon_mm");
  EXPECT_EQ(complaint(design("polygon_mm = [[0, 0], [10, 0], [10, 0], [0, 10]]")), "d.toml:8: outline.polygon_mm");
  EXPECT_EQ(complaint(design(kSquare + "corner_radius_mm = 6")), "d.toml:9: outline.corner_radius_mm");
  EXPECT_EQ(complaint(design(kSquare + "corner_radius_mm = [1, 2]")), "d.toml:9: outline.corner_radius_mm");
  EXPECT_EQ(complaint(design(kSquare + "side_sagitta_mm = [1, 2]")), "d.toml:9: outline.side_sagitta_mm");
  EXPECT_EQ(complaint(design(kSquare + "side_sagitta_mm = [0, 51, 0, 0]")), "d.toml:9: outline.side_sagitta_mm");
  EXPECT_EQ(complaint(design(kSquare + "holes_mm = [[20, 5, 1]]")), "d.toml:9: outline.holes_mm");
  EXPECT_EQ(complaint(design(kSquare + "holes_mm = [[5, 5, 9]]")), "d.toml:9: outline.holes_mm");
  EXPECT_EQ(complaint(design(kSquare + "holes_mm = [[5, 5, 0]]")), "d.toml:9: outline.holes_mm");
  EXPECT_EQ(complaint(design(kSquare + "holes_mm = [[5, 5, 1]]\nmargin_mm = 3")), "d.toml:10: outline.margin_mm");
  EXPECT_EQ(complaint(design("circle_mm = [0, 0, 0]")), "d.toml:8: outline.circle_mm");
  EXPECT_EQ(complaint(design("circle_mm = [0, 0, 100]\ntolerance_mm = 1e-6")), "d.toml:9: outline.tolerance_mm");
  EXPECT_EQ(complaint(design("circle_mm = [0, 0, 0.2]")), "d.toml:8: outline.circle_mm");
  EXPECT_EQ(complaint(design("circle_mm = [0, 0, 5]\ncorner_radius_mm = 1")), "d.toml:9: outline.corner_radius_mm");
  EXPECT_EQ(complaint(design("margin_mm = 1")), "d.toml:7: outline");
  EXPECT_EQ(complaint(design(kSquare + "circle_mm = [0, 0, 5]")), "d.toml:9: outline.circle_mm");
  EXPECT_EQ(complaint(design(kSquare, "x_length_mm = 10")), "d.toml:6: array.x_length_mm");
  EXPECT_EQ(complaint(design(kSquare, "x_offset_mm = 1")), "d.toml:6: array.x_offset_mm");
  EXPECT_EQ(complaint(design(kSquare, "extent = \"infinite\"")), "d.toml:7: outline");
  EXPECT_EQ(complaint(design(kSquare, "arrangement = \"single\"")), "d.toml:7: outline");
  EXPECT_EQ(complaint(design(kSquare + "holes_mm = [[5, 5, 1]]", "", "[entrance_surface]\nmesh = \"face.stl\"")),
            "d.toml:9: outline.holes_mm");
}

/// A document contains the keys of the outline as given, so that polygons with many rounded corners can be read again.
TEST(OutlineReader, DocumentsContainTheKeysAsGiven) {
  std::string corners;
  constexpr int kCorners = 800;
  for (int k = 0; k < kCorners; ++k) {
    const double radius = k % 2 == 0 ? 100.0 : 99.0;
    const double at = 2.0 * kPi * k / kCorners;
    corners += "[" + std::to_string(radius * std::cos(at)) + ", " + std::to_string(radius * std::sin(at)) + "], ";
  }
  const design::Design star =
      read(design("polygon_mm = [" + corners + "]\ncorner_radius_mm = 0.1\ntolerance_mm = 0.5"));
  ASSERT_EQ(star.part().array.outline->outline.loops[0].size(), 2U * kCorners);
  const std::string text = design::design_text(star);
  EXPECT_NE(text.find("corner_radius_mm = 0.1\n"), std::string::npos);
  const design::Design again = read(text);
  EXPECT_EQ(again.part().array.outline->area_mm2(), star.part().array.outline->area_mm2());
  EXPECT_EQ(design::design_text(again), text);
  const design::Design arcs = read(design(kSquare + "side_sagitta_mm = [1, 0, -1, 0]\nholes_mm = [[5, 5, 1]]"));
  EXPECT_NE(design::design_text(arcs).find("side_sagitta_mm = [1, 0, -1, 0]"), std::string::npos)
      << design::design_text(arcs);
}

std::string zones_of(const std::string& zones, const std::string& outline = kSquare) {
  return design(outline, "", zones);
}

TEST(OutlineReader, StripesHaveTheirFractionsOfTheArea) {
  const std::string outline =
      "polygon_mm = [[0, 0], [20, 0], [10, 16]]\ncorner_radius_mm = 1\nholes_mm = [[10, 5, 2]]\n";
  const design::Design design =
      read(zones_of("[[zone]]\narea_fraction = 0.25\n[[zone]]\narea_fraction = 0.6\n"
                    "set = [\"element.base_mm=0.4\"]\n[[zone]]\narea_fraction = 0.15\n",
                    outline));
  const geometry::Part part = design::part_of_design(design, nullptr);
  const double all = part.entrance_area_mm2;
  EXPECT_NEAR(part.zones[0].area_mm2 / all, 0.25, 1e-9);
  EXPECT_NEAR(part.zones[1].area_mm2 / all, 0.6, 1e-9);
  EXPECT_NEAR(part.zones[2].area_mm2 / all, 0.15, 1e-9);
  // A triangle with the area A and half the perimeter s loses r^2 (s^2 / A - pi) at its rounded corners.
  const double half_perimeter = 10 + std::sqrt(356.0);
  EXPECT_NEAR(all, 160 - 4 * kPi - (half_perimeter * half_perimeter / 160 - kPi), 1e-8);
  const geometry::Part again = design::part_of_design(read(design::design_text(design)), nullptr);
  EXPECT_EQ(again.elements_full, part.elements_full);
  EXPECT_NEAR(again.zones[1].area_mm2, part.zones[1].area_mm2, 1e-9);
}

TEST(OutlineReader, ZonesMustBeInsideTheOutline) {
  const std::string notch = "polygon_mm = [[0, 0], [10, 0], [10, 5], [5, 5], [5, 10], [0, 10]]\n";
  const auto zone = [](const std::string& box) { return "[[zone]]\nrectangles_mm = [" + box + "]\n"; };
  EXPECT_EQ(complaint(zones_of(zone("[0, 0, 10, 5]") + zone("[0, 5, 5, 10]"), notch)), "nothing");
  EXPECT_EQ(complaint(zones_of(zone("[0, 0, 10, 5]") + zone("[0, 5, 10, 10]"), notch)), "nothing");
  EXPECT_EQ(complaint(zones_of(zone("[0, 0, 10, 5], [0, 5, 5, 10]") + zone("[5, 5, 10, 10]"), notch)),
            "d.toml:14: zone[2]");
  EXPECT_EQ(complaint(zones_of(zone("[0, 0, 10, 5]") + zone("[0, 5, 4, 10]"), notch)), "d.toml:14: zone[2]");
}

}  // namespace
}  // namespace retrace::studies::outline_reader_test
