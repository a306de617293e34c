// Tests of the keys of designs for elements and arrays.
#include "design/io/design_reader.h"

#include <gtest/gtest.h>

#include <string>

#include "tests/studies/design_texts.h"
#include "tests/support/refusals.h"

namespace retrace::studies::design_array_test {
namespace {

using geometry::Arrangement;

TEST(DesignReader, ArrangementDefaultsToTheOneOfItsKind) {
  const std::string lengths = "x_length_mm = 10; y_length_mm = 10";
  EXPECT_EQ(design::parse_design(design_of(kRtp, lengths), "d", {}).part().array.arrangement, Arrangement::aligned);
  EXPECT_EQ(design::parse_design(design_of(kHexagonal, lengths), "d", {}).part().array.arrangement,
            Arrangement::honeycomb);
  EXPECT_EQ(design::parse_design(design_of(kTriangular, lengths), "d", {}).part().array.arrangement,
            Arrangement::triangular);
}

TEST(DesignReader, ArrangementMustFitTheKind) {
  EXPECT_EQ(complaint(with_line(6, "arrangement = \"honeycomb\"")), "d.toml:6: array.arrangement");
  EXPECT_EQ(complaint(design_of(kHexagonal, "arrangement = \"triangular\"")), "d.toml:5: array.arrangement");
  EXPECT_EQ(complaint(design_of(kTriangular, "arrangement = \"offset\"")), "d.toml:5: array.arrangement");
}

TEST(DesignReader, KeysOfAnotherKindAreRefused) {
  EXPECT_EQ(set_complaint({"element.aperture_mm=1"}), "--set element.aperture_mm=1: element.aperture_mm");
  EXPECT_EQ(complaint(design_of(kHexagonal + "; base_mm = 1", "")), "d.toml:4: element.base_mm");
}

TEST(DesignReader, SingleAndInfiniteTakeNoLengths) {
  expect_refusals([](const std::string& given) { return complaint(given); },
                  {{design_of(kRtp, "arrangement = \"single\"; x_length_mm = 1"), "d.toml:7: array.x_length_mm"},
                   {design_of(kRtp, "arrangement = \"single\"; y_offset_mm = 1"), "d.toml:7: array.y_offset_mm"},
                   {design_of(kRtp, "extent = \"infinite\"; y_length_mm = 3"), "d.toml:7: array.y_length_mm"},
                   {design_of(kRtp, "extent = \"infinite\"; x_offset_mm = 3"), "d.toml:7: array.x_offset_mm"},
                   {design_of(kRtp, "arrangement = \"single\"; extent = \"infinite\""), "d.toml:7: array.extent"},
                   {design_of(kRtp, "arrangement = \"single\"; x_offset_mm = 0; x_gap_mm = 0.0"), ""}});
}

TEST(DesignReader, GapsRowsAndOverlapOnlyWhereTheyMeanSomething) {
  expect_refusals([](const std::string& given) { return complaint(given); },
                  {{design_of(kHexagonal, "extent = \"infinite\"; x_gap_mm = 0.1"), "d.toml:6: array.x_gap_mm"},
                   {design_of(kRtp, "arrangement = \"single\"; y_gap_mm = 0.1"), "d.toml:7: array.y_gap_mm"},
                   {design_of(kRtp, "extent = \"infinite\"; shifted_rows = \"odd\""), "d.toml:7: array.shifted_rows"},
                   {design_of(kRtp, "extent = \"infinite\"; overlap_percent = 50"), "d.toml:7: array.overlap_percent"},
                   {design_of(kRtp, "extent = \"infinite\"; x_gap_mm = 0.1"), ""}});
  EXPECT_EQ(set_complaint({"array.x_gap_mm=-0.1"}), "--set array.x_gap_mm=-0.1: array.x_gap_mm");
  EXPECT_EQ(set_complaint({"array.y_offset_mm=-0.1"}), "--set array.y_offset_mm=-0.1: array.y_offset_mm");
  EXPECT_EQ(set_complaint({"array.overlap_percent=100"}), "--set array.overlap_percent=100: array.overlap_percent");
  EXPECT_EQ(set({"array.overlap_percent=0"}).part().array.overlap_percent, 0.0);
}

TEST(DesignReader, CheckerNeedsSquareCells) {
  const std::string lengths = "x_length_mm = 10; y_length_mm = 10; arrangement = \"checker\"";
  EXPECT_EQ(complaint(design_of("kind = \"rtp\"; base_mm = 0.5; width_mm = 0.4", lengths)),
            "d.toml:4: element.width_mm");
  EXPECT_EQ(complaint(design_of("kind = \"rtp\"; base_mm = 0.5; width_mm = 0.5000000001", lengths)), "");
}

TEST(DesignReader, ArrayMustHoldOneElement) {
  EXPECT_EQ(complaint(with_line(7, "x_length_mm = 0.3")), "d.toml:7: array.x_length_mm");
  EXPECT_EQ(set_complaint({"array.y_offset_mm=4.9"}), "d.toml:8: array.y_length_mm");
  EXPECT_EQ(complaint(design_of(kRtp, "x_length_mm = 0.9999999999; y_length_mm = 1")), "");
  // The array must contain one hexagon or triangle with a circumscribed radius of 1 whose apex is at the centre. The
  // smallest such array is 2 x sqrt(3).
  for (const std::string& cube : {kHexagonal, kTriangular}) {
    EXPECT_EQ(complaint(design_of(cube, "x_length_mm = 2; y_length_mm = 1.7320508075688772")), "");
    EXPECT_EQ(complaint(design_of(cube, "x_length_mm = 2; y_length_mm = 1.73")), "d.toml:6: array.y_length_mm");
    EXPECT_EQ(complaint(design_of(cube, "x_length_mm = 1.9; y_length_mm = 5")), "d.toml:5: array.x_length_mm");
  }
}

TEST(DesignReader, ArrayHasAtMost1e8Elements) {
  EXPECT_EQ(set_complaint({"array.x_length_mm=1e6", "array.y_length_mm=1e6"}),
            "--set array.x_length_mm=1e6: array.x_length_mm");
  EXPECT_EQ(set_complaint({"array.x_length_mm=5000", "array.y_length_mm=5000"}), "");
}

}  // namespace
}  // namespace retrace::studies::design_array_test
