// Tests of the area that a polygon covers in each pixel of a grid.
#include "raytrace/observers/pixel_grid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "core/random.h"

namespace retrace::testing::pixel_grid_test {
namespace {

using geometry::Polygon, geometry::Vec2;
using raytrace::PixelGrid;

std::vector<double> covered(const PixelGrid& grid, const Polygon& polygon) {
  std::vector<double> areas(grid.size(), 0.0);
  grid.cover(polygon, [&](std::size_t pixel, double area) { areas[pixel] += area; });
  return areas;
}

double sum_of(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double v : values) sum += v;
  return sum;
}

/// Returns a convex quadrilateral with random corners on a circle.
Polygon random_polygon(std::uint32_t number, const Vec2& centre, double radius) {
  const auto words = philox({7, 1}, number, 0);
  std::vector<double> turns;
  for (std::size_t k = 0; k < 4; ++k) turns.push_back(2.0 * std::numbers::pi * unit_interval(words[k]));
  std::sort(turns.begin(), turns.end());
  Polygon polygon;
  for (const double t : turns) polygon.push_back(centre + radius * Vec2(std::cos(t), std::sin(t)));
  return polygon;
}

TEST(PixelGrid, RowsCountFromAbove) {
  const PixelGrid grid({{-1.0, 2.0}, {3.0, 4.0}}, 4, 2);
  EXPECT_EQ(grid.pixel_area_mm2(), 1.0);
  EXPECT_EQ(grid.pixel_at({-0.5, 3.5}), 0U);
  EXPECT_EQ(grid.pixel_at({2.5, 2.5}), 7U);
  EXPECT_EQ(grid.pixel_at({3.0, 4.0}), 3U) << "the borders belong to it";
  EXPECT_FALSE(grid.pixel_at({3.1, 3.0}));
  EXPECT_FALSE(grid.pixel_at({0.0, std::nan("")}));
  EXPECT_EQ(grid.pixel_mm(0, 0).lower, Vec2(-1.0, 3.0));
}

TEST(PixelGrid, AreasOfAPolygonAddUpToIt) {
  const PixelGrid grid({{0.0, 0.0}, {10.0, 7.0}}, 23, 17);
  for (std::uint32_t number = 0; number < 200; ++number) {
    const Polygon polygon = random_polygon(number, {5.0, 3.5}, 3.4);
    const std::vector<double> areas = covered(grid, polygon);
    EXPECT_NEAR(sum_of(areas), geometry::area(polygon), 1e-11) << number;
    for (const double area : areas) {
      EXPECT_GE(area, 0.0);
      EXPECT_LE(area, grid.pixel_area_mm2() * (1.0 + 1e-12));
    }
  }
}

TEST(PixelGrid, CoverageMeetsItsClosedForm) {
  const PixelGrid grid({{0.0, 0.0}, {2.0, 2.0}}, 2, 2);
  // The triangle has legs of 1.5. It covers pixel 2 except for one corner, and triangles with legs of 0.5 in the pixels
  // 0 and 3.
  const std::vector<double> areas = covered(grid, {{0.0, 0.0}, {1.5, 0.0}, {0.0, 1.5}});
  EXPECT_DOUBLE_EQ(areas[2], 1.0 - 0.125);  // lower left pixel, without the corner beyond x + y = 1.5
  EXPECT_DOUBLE_EQ(areas[0], 0.125);
  EXPECT_DOUBLE_EQ(areas[3], 0.125);
  EXPECT_DOUBLE_EQ(areas[1], 0.0);
}

TEST(PixelGrid, WhatLiesOutsideIsLeftOut) {
  const PixelGrid grid({{0.0, 0.0}, {1.0, 1.0}}, 5, 3);
  EXPECT_NEAR(sum_of(covered(grid, {{-3.0, -3.0}, {4.0, -3.0}, {4.0, 4.0}, {-3.0, 4.0}})), 1.0, 1e-13);
  EXPECT_EQ(sum_of(covered(grid, {{2.0, 0.0}, {3.0, 0.0}, {3.0, 1.0}})), 0.0);
  EXPECT_EQ(sum_of(covered(grid, {})), 0.0);
}

}  // namespace
}  // namespace retrace::testing::pixel_grid_test
