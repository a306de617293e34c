// Tests of polygons that are cross-sections of beams: cutting conserves the total area, in spite of rounding errors
// at short edges.
#include "raytrace/exact/flat_polygon.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace retrace::testing::flat_polygon_test {
namespace {

using namespace raytrace;
using geometry::Vec2;

constexpr double kMerge_mm = 1e-11;

/// Returns the area of the part of the polygon `of` that is outside the polygon `by`.
double area_left(const FlatPolygon& of, const FlatPolygon& by) {
  constexpr double kMinArea = 1e-15;
  FlatPolygons left;
  subtract(of, by, kMinArea, kMerge_mm, left);
  double sum = 0.0;
  for (const FlatPolygon& piece : left) sum += area(piece);
  return sum;
}

class RandomPolygons {
 public:
  explicit RandomPolygons(unsigned seed) : random_(seed) {}

  double between(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }

  /// Returns a polygon far from the origin. Some corners are cut off at distances from 4e-12 to 5e-8 mm, which leaves
  /// edges so short that rounding errors change their directions.
  FlatPolygon next() {
    const Vec2 centre(between(-40.0, 40.0), between(-40.0, 40.0));
    FlatPolygon polygon;
    for (int k = 0; k < 6; ++k) {
      const double turn = (k + between(0.0, 0.9)) / 6.0 * 2.0 * std::numbers::pi;
      polygon.push_back(centre + 0.03 * Vec2(std::cos(turn), std::sin(turn)));
    }
    for (int k = 0; k < 4; ++k) {
      const auto n = static_cast<int>(polygon.size());
      const int at = std::uniform_int_distribution<int>(0, n - 1)(random_);
      const auto corner = [&](int number) { return polygon[static_cast<std::size_t>((number + n) % n)]; };
      const double least = std::exp(between(std::log(2.0 * kMerge_mm), std::log(1e-8)));
      const auto along = [&](int number) -> Vec2 {
        return corner(at) + least * between(0.2, 5.0) * (corner(number) - corner(at)).normalized();
      };
      clip(polygon, left_of(along(at - 1), along(at + 1)), kMerge_mm);
    }
    make_convex(polygon);
    return polygon;
  }

 private:
  std::mt19937 random_;
};

TEST(FlatPolygon, WhatIsCommonAndWhatIsLeftAddUp) {
  RandomPolygons random(1);
  for (int k = 0; k < 20000; ++k) {
    const FlatPolygon of = random.next();
    FlatPolygon by = random.next();
    const Vec2 shift = of[0] - by[0] + Vec2(random.between(-0.04, 0.04), random.between(-0.04, 0.04));
    for (Vec2& p : by) p += shift;
    make_convex(by);
    ASSERT_NEAR(area_left(of, by) + area(intersection(of, by, kMerge_mm)), area(of), 1e-12) << k;
    ASSERT_EQ(area_left(of, of), 0.0) << k;
  }
}

TEST(FlatPolygon, ClockwiseCornersAreLeftOut) {
  FlatPolygon polygon = {{0.0, 0.0}, {1.0, 0.0}, {1.0 - 1e-12, 0.5}, {1.0, 1.0}, {0.5, 1.0 - 1e-12}, {0.0, 1.0}};
  make_convex(polygon);
  EXPECT_EQ(polygon.size(), 4U);
  EXPECT_EQ(area(polygon), 1.0);
  // The outline turns clockwise at the second corner only after the third corner has been removed.
  FlatPolygon chain = {{0.0, 0.0}, {0.4, 0.05}, {0.5, 0.1}, {1.0, 0.0}, {1.0, 1.0}, {0.0, 1.0}};
  make_convex(chain);
  EXPECT_EQ(chain.size(), 4U);
}

/// Every second corner of a star turns clockwise. Each removal requires another check of two neighbours, so that all
/// clockwise corners are found only if removals extend the search.
TEST(FlatPolygon, EveryClockwiseCornerOfAStarIsLeftOut) {
  for (const int points : {5, 8, 20}) {
    FlatPolygon star;
    for (int k = 0; k < 2 * points; ++k) {
      const double turn = std::numbers::pi * k / points;
      const double radius = k % 2 == 0 ? 1.0 : 0.4;
      star.emplace_back(radius * std::cos(turn), radius * std::sin(turn));
    }
    make_convex(star);
    EXPECT_EQ(star.size(), static_cast<std::size_t>(points));
    EXPECT_NEAR(area(star), 0.5 * points * std::sin(2.0 * std::numbers::pi / points), 1e-12);
  }
}

/// The second rectangle has a convex union with the first one only after the third rectangle has been joined.
TEST(FlatPolygon, PiecesAreTriedAgainAfterAJoin) {
  const auto rectangle = [](double left, double right, double bottom, double top) {
    FlatPolygon polygon;
    for (const Vec2& p : {Vec2(left, bottom), Vec2(right, bottom), Vec2(right, top), Vec2(left, top)})
      polygon.emplace_back(p.x(), p.y());
    return polygon;
  };
  FlatPolygons pieces = {rectangle(0.0, 1.0, 0.0, 1.0), rectangle(0.0, 2.0, 1.0, 2.0), rectangle(1.0, 2.0, 0.0, 1.0)};
  join_convex(pieces, 1e-13);
  ASSERT_EQ(pieces.size(), 1U);
  EXPECT_NEAR(area(pieces[0]), 4.0, 1e-12);
}

}  // namespace
}  // namespace retrace::testing::flat_polygon_test
