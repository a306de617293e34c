// Tests of contour lines against level lines in closed form.
#include "report/contours.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace retrace::report::contours_test {
namespace {

constexpr std::size_t kColumns = 41;

template <class Function>
std::vector<double> grid_of(const Function& value) {
  std::vector<double> values;
  for (std::size_t row = 0; row < kColumns; ++row)
    for (std::size_t column = 0; column < kColumns; ++column)
      values.push_back(value(static_cast<double>(column), static_cast<double>(row)));
  return values;
}

double length_of(const std::vector<Point>& line) {
  double length = 0.0;
  for (std::size_t k = 1; k < line.size(); ++k)
    length += std::hypot(line[k].x - line[k - 1].x, line[k].y - line[k - 1].y);
  return length;
}

/// Linear values have straight contour lines from border to border, without interpolation error.
TEST(ContourLines, OfALinearFunctionAreStraight) {
  const auto lines = contour_lines(grid_of([](double x, double y) { return x + 0.5 * y; }), kColumns, 20.25);
  ASSERT_EQ(lines.size(), 1U);
  for (const Point& p : lines.front()) EXPECT_NEAR(p.x + 0.5 * p.y, 20.25, 1e-12);
  EXPECT_NEAR(length_of(lines.front()), 40.0 * std::hypot(1.0, 0.5), 1e-9);
}

/// The contour line of a paraboloid is a circle. Linear interpolation along an edge shifts a point by at most 1 / (8
/// r), which is 0.01 and shortens the line by 8e-4. Chords shorten it by about 1e-4.
TEST(ContourLines, OfAParaboloidAreClosedCircles) {
  const auto lines = contour_lines(
      grid_of([](double x, double y) { return std::pow(x - 20.0, 2.0) + std::pow(y - 20.0, 2.0); }), kColumns, 150.3);
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_EQ(lines.front().front().x, lines.front().back().x);
  EXPECT_EQ(lines.front().front().y, lines.front().back().y);
  const double radius = std::sqrt(150.3);
  for (const Point& p : lines.front()) EXPECT_NEAR(std::hypot(p.x - 20.0, p.y - 20.0), radius, 0.011);
  EXPECT_NEAR(length_of(lines.front()), 2.0 * std::numbers::pi * radius, 1e-3 * 2.0 * std::numbers::pi * radius);
}

/// At a saddle, the value at the centre of the cell decides. The lines do not cross.
TEST(ContourLines, OfASaddleDoNotCross) {
  const std::vector<double> saddle = {1.0, 0.0, 0.0, 1.0};
  for (const double level : {0.4, 0.6}) {
    const auto lines = contour_lines(saddle, 2, level);
    ASSERT_EQ(lines.size(), 2U);
    // Below the mean, the lines cut off the corners with 0; above the mean, those with 1.
    for (const auto& line : lines) {
      ASSERT_EQ(line.size(), 2U);
      const double x = 0.5 * (line[0].x + line[1].x);
      const double y = 0.5 * (line[0].y + line[1].y);
      EXPECT_EQ((x < 0.5) == (y < 0.5), level > 0.5);
    }
  }
}

TEST(ContourLines, SkipCellsWithoutNumbers) {
  std::vector<double> values = grid_of([](double x, double) { return x; });
  values[20 * kColumns + 20] = std::numeric_limits<double>::quiet_NaN();
  std::size_t points = 0;
  for (const auto& line : contour_lines(values, kColumns, 20.5)) {
    for (const Point& p : line) {
      EXPECT_TRUE(std::isfinite(p.x) && std::isfinite(p.y));
      EXPECT_TRUE(p.y <= 19.0 || p.y >= 21.0);
    }
    points += line.size();
  }
  EXPECT_EQ(points, 40U);
  EXPECT_TRUE(contour_lines(values, kColumns, 100.0).empty());
  EXPECT_TRUE(contour_lines({}, kColumns, 0.0).empty());
}

}  // namespace
}  // namespace retrace::report::contours_test
