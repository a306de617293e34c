#include "geometry/part/part.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/error.h"
#include "tests/geometry/part_checks.h"

namespace retrace::geometry::part_test {
namespace {

PartSpec rtp_array(double base, double width, double length, Arrangement arrangement) {
  PartSpec spec;
  spec.element = RtpElement{base, width, 90.0};
  spec.array.arrangement = arrangement;
  spec.array.x_length_mm = spec.array.y_length_mm = length;
  spec.thickness_mm = 0.5;
  return spec;
}

PartSpec cube_array(Element element, Arrangement arrangement, double length) {
  PartSpec spec;
  spec.element = element;
  spec.array.arrangement = arrangement;
  spec.array.x_length_mm = length;
  spec.array.y_length_mm = 0.8 * length;
  spec.thickness_mm = 0.5;
  return spec;
}

TEST(Part, SingleElementsAreClosed) {
  PartSpec spec;
  spec.array.arrangement = Arrangement::single;
  spec.thickness_mm = 0.5;
  for (const Element& element :
       {Element(RtpElement{0.45, 0.45, 90.0}), Element(HexagonalCube{1.6}), Element(TriangularCube{1.6})}) {
    spec.element = element;
    expect_valid(spec);
  }
}

TEST(Part, RtpArraysAreClosed) {
  for (const Arrangement arrangement : {Arrangement::aligned, Arrangement::offset, Arrangement::checker}) {
    PartSpec spec = rtp_array(0.5, 0.5, 2.5, arrangement);
    expect_valid(spec);
    spec.array.x_gap_mm = 0.05;
    spec.array.y_gap_mm = 0.1;
    expect_valid(spec);
    spec.array.x_offset_mm = 0.2;
    spec.array.y_offset_mm = 0.1;
    expect_valid(spec);
    spec.array.shifted_rows = RowParity::odd;
    spec.array.overlap_percent = 30.0;
    expect_valid(spec);
    spec.array.partial_elements = PartialElements::omit;
    expect_valid(spec);
  }
}

TEST(Part, CubeCornerArraysAreClosed) {
  for (const PartialElements partial : {PartialElements::cut, PartialElements::omit}) {
    PartSpec hexagonal = cube_array(HexagonalCube{1.0}, Arrangement::honeycomb, 4.3);
    PartSpec triangular = cube_array(TriangularCube{1.0}, Arrangement::triangular, 4.3);
    hexagonal.array.partial_elements = triangular.array.partial_elements = partial;
    expect_valid(hexagonal);
    expect_valid(triangular);
    hexagonal.array.x_offset_mm = triangular.array.y_offset_mm = 0.3;
    expect_valid(hexagonal);
    expect_valid(triangular);
  }
}

TEST(Part, FacetsAreAtTheRightAngles) {
  for (const Element& element : {Element(HexagonalCube{1.3}), Element(TriangularCube{1.3})}) {
    PartSpec spec;
    spec.element = element;
    spec.array.arrangement = Arrangement::single;
    spec.thickness_mm = 1.0;
    const Part part = build_part(spec);
    const auto& facets = part.patches[0].facets;
    ASSERT_EQ(facets.size(), 3U);
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_NEAR(facets[i].normal.dot(facets[(i + 1) % 3].normal), 0.0, 1e-14);
      EXPECT_NEAR(facets[i].normal.z(), -1.0 / std::numbers::sqrt3, 1e-14);
    }
  }
}

TEST(Part, DepthsOfTheContract) {
  const double a = 0.7;
  EXPECT_NEAR(element_depth_mm(HexagonalCube{2.0 * a * std::sqrt(2.0 / 3.0)}), 2.0 * a / std::sqrt(3.0), 1e-14);
  EXPECT_NEAR(element_depth_mm(TriangularCube{2.0 * a * std::sqrt(2.0 / 3.0)}), a / std::sqrt(3.0), 1e-14);
  EXPECT_NEAR(element_depth_mm(RtpElement{0.5, 0.5, 90.0}), 0.25, 1e-15);
}

// Seen from the apex, one dihedral edge projects onto +x. The facet opposite to this edge faces -x.
TEST(Part, CubeCornerOrientation) {
  PartSpec spec;
  spec.element = TriangularCube{1.0};
  spec.array.arrangement = Arrangement::single;
  spec.thickness_mm = 1.0;
  const Part part = build_part(spec);
  const Vec3 opposite = part.patches[0].facets[1].normal;
  EXPECT_NEAR(opposite.x(), -std::sqrt(2.0 / 3.0), 1e-14);
  EXPECT_NEAR(opposite.y(), 0.0, 1e-14);
}

// Equal portions of an array share a patch. A large array must therefore have few distinct patches. The facets must
// cover the area of the whole array.
TEST(Part, LargeArraysShareTheirPieces) {
  const Part rtp = build_part(rtp_array(0.451, 0.451, 222 * 0.451, Arrangement::offset));
  EXPECT_EQ(rtp.elements_full, 222 * 222 - 111);
  EXPECT_LE(rtp.patches.size(), 16U);
  EXPECT_GT(rtp.placements.size(), 20U);
  EXPECT_NEAR(rtp.retro_facet_area_mm2, std::numbers::sqrt2 * rtp.entrance_area_mm2, 1e-6);
  const Part honeycomb = build_part(cube_array(HexagonalCube{0.5}, Arrangement::honeycomb, 60.0));
  EXPECT_LE(honeycomb.patches.size(), 16U);
  EXPECT_NEAR(honeycomb.retro_facet_area_mm2, std::numbers::sqrt3 * honeycomb.entrance_area_mm2, 1e-6);
}

TEST(Part, InfiniteCellCoversItsPeriod) {
  PartSpec spec = rtp_array(0.5, 0.4, 0.0, Arrangement::offset);
  spec.array.extent = Extent::infinite;
  const Part part = build_part(spec);
  EXPECT_NEAR(part.period_mm->x(), 0.5, 1e-15);
  EXPECT_NEAR(part.period_mm->y(), 0.8, 1e-15);
  EXPECT_NEAR(part.retro_facet_area_mm2, std::numbers::sqrt2 * 0.4, 1e-12);
}

TEST(Part, WholeNumbersUpToRoundingAreWhole) {
  EXPECT_EQ(build_part(rtp_array(0.1, 0.1, 0.3, Arrangement::aligned)).elements_full, 9);
  EXPECT_EQ(build_part(rtp_array(0.1, 0.1, 0.7 * (1.0 - 5e-10), Arrangement::aligned)).elements_full, 49);
}

TEST(Part, OneRowIsNeverShifted) {
  PartSpec spec = rtp_array(1.0, 1.0, 3.0, Arrangement::offset);
  spec.array.y_length_mm = 1.0;
  spec.array.shifted_rows = RowParity::odd;
  const Part part = build_part(spec);
  EXPECT_EQ(part.elements_full, 3);
  EXPECT_EQ(part.elements_partial, 0);
}

TEST(Part, TooSmallForOneElement) {
  EXPECT_THROW(build_part(rtp_array(1.0, 1.0, 0.9, Arrangement::aligned)), InputError);
  EXPECT_THROW(build_part(cube_array(HexagonalCube{1.0}, Arrangement::honeycomb, 0.9)), InputError);
}

}  // namespace
}  // namespace retrace::geometry::part_test
