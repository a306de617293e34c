#include "raytrace/exact/overlay.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "geometry/point_lookup.h"

namespace retrace::raytrace::overlay_test {
namespace {

using geometry::Vec2;

FlatPolygon rectangle(double x0, double y0, double x1, double y1) {
  return {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
}

/// Returns a convex polygon with random corners on a rotated ellipse.
FlatPolygon random_polygon(std::mt19937& random, double radius) {
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::vector<double> angles(3 + random() % 5);
  for (double& a : angles) a = 2.0 * std::numbers::pi * unit(random);
  std::sort(angles.begin(), angles.end());
  const Vec2 centre(unit(random), unit(random));
  const double flat = 0.2 + 0.8 * unit(random);
  const double turn = 2.0 * std::numbers::pi * unit(random);
  FlatPolygon polygon;
  for (const double a : angles) {
    const Vec2 p = radius * Vec2(std::cos(a), flat * std::sin(a));
    polygon.push_back(centre + Vec2(std::cos(turn) * p.x() - std::sin(turn) * p.y(),
                                    std::sin(turn) * p.x() + std::cos(turn) * p.y()));
  }
  return polygon;
}

double sum_of_areas(const std::vector<ValuedPolygon>& pieces) {
  double sum = 0.0;
  for (const ValuedPolygon& piece : pieces) sum += area(piece.polygon);
  return sum;
}

double sum_of_values(const std::vector<ValuedPolygon>& pieces) {
  double sum = 0.0;
  for (const ValuedPolygon& piece : pieces) sum += piece.value * area(piece.polygon);
  return sum;
}

bool holds(const FlatPolygon& polygon, const Vec2& p) {
  for (std::size_t k = 0; k < polygon.size(); ++k)
    if (left_of(polygon[k], polygon[(k + 1) % polygon.size()]).excess(p) > 0.0) return false;
  return polygon.size() >= 3;
}

double value_at(const std::vector<ValuedPolygon>& pieces, const Vec2& p) {
  double value = 0.0;
  for (const ValuedPolygon& piece : pieces)
    if (holds(piece.polygon, p)) value += piece.value;
  return value;
}

TEST(Overlay, ValuesAddWhereTwoOverlap) {
  Overlay overlay(1.0);
  overlay.insert(rectangle(0.0, 0.0, 2.0, 1.0), 0.5);
  overlay.insert(rectangle(1.0, 0.0, 3.0, 1.0), 0.25);
  const auto pieces = overlay.polygons();
  ASSERT_EQ(pieces.size(), 3U);
  EXPECT_EQ(value_at(pieces, {0.5, 0.5}), 0.5);
  EXPECT_EQ(value_at(pieces, {1.5, 0.5}), 0.75);
  EXPECT_EQ(value_at(pieces, {2.5, 0.5}), 0.25);
  EXPECT_DOUBLE_EQ(sum_of_areas(pieces), 3.0);
}

TEST(Overlay, EqualPolygonsUpToRoundingAreOne) {
  Overlay overlay(1.0);
  const double third = 1.0 / 3.0;
  overlay.insert(rectangle(0.0, 0.0, third, third), 1.0);
  overlay.insert(rectangle(1e-16, -1e-16, third + 1e-16, std::nextafter(third, 1.0)), 2.0);
  const auto pieces = overlay.polygons();
  ASSERT_EQ(pieces.size(), 1U);
  EXPECT_EQ(pieces[0].value, 3.0);
}

TEST(Overlay, PolygonsWithoutAreaAreNothing) {
  Overlay overlay(1.0);
  overlay.insert({}, 1.0);
  overlay.insert({{0.0, 0.0}, {1.0, 0.0}}, 1.0);
  overlay.insert({{0.0, 0.0}, {1.0, 0.0}, {0.5, 1e-14}}, 1.0);
  EXPECT_TRUE(overlay.polygons().empty());
}

// Random polygons are overlaid. The resulting fragments are disjoint, their values are the sums of the overlaid values,
// and area and value are conserved.
TEST(Overlay, RandomPolygonsKeepAreaAndValue) {
  std::mt19937 random(7);
  for (int round = 0; round < 40; ++round) {
    Overlay overlay(1.0);
    std::vector<ValuedPolygon> given;
    for (int k = 0; k < 40; ++k) {
      given.push_back({random_polygon(random, 0.3), 1.0 + static_cast<double>(random() % 8)});
      overlay.insert(given.back().polygon, given.back().value);
    }
    const auto pieces = overlay.polygons();
    EXPECT_NEAR(sum_of_values(pieces), sum_of_values(given), 1e-9);
    std::uniform_real_distribution<double> place(-0.3, 1.3);
    int covered = 0;
    for (int k = 0; k < 500; ++k) {
      const Vec2 p(place(random), place(random));
      const double value = value_at(given, p);
      EXPECT_EQ(value_at(pieces, p), value);
      covered += value > 0.0 ? 1 : 0;
    }
    EXPECT_GT(covered, 50);
    for (const ValuedPolygon& piece : pieces) EXPECT_GT(area(piece.polygon), 0.0);
  }
}

TEST(Overlay, ManySmallPolygonsTakeLittleTime) {
  std::mt19937 random(3);
  Overlay overlay(1.0);
  double given = 0.0;
  for (int k = 0; k < 20000; ++k) {
    const FlatPolygon polygon = random_polygon(random, 0.008);
    overlay.insert(polygon, 1.0);
    given += area(polygon);
  }
  EXPECT_NEAR(sum_of_values(overlay.polygons()), given, 1e-8);
}

TEST(Fused, TilesBecomeOne) {
  std::vector<ValuedPolygon> tiles;
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < 5; ++i) {
      const FlatPolygon whole = rectangle(0.1 * i, 0.1 * j, 0.1 * (i + 1), 0.1 * (j + 1));
      tiles.push_back({{whole[0], whole[1], whole[2]}, 0.5});
      tiles.push_back({{whole[0], whole[2], whole[3]}, 0.5});
    }
  const auto pieces = fused(tiles, 1.0, 1e-9);
  ASSERT_EQ(pieces.size(), 1U);
  EXPECT_EQ(pieces[0].polygon.size(), 4U);
  EXPECT_NEAR(area(pieces[0].polygon), 0.2, 1e-12);
}

TEST(Fused, OnlyEqualValuesAndConvexUnions) {
  EXPECT_EQ(fused({{rectangle(0, 0, 1, 1), 0.5}, {rectangle(1, 0, 2, 1), 0.6}}, 1.0, 1e-9).size(), 2U);
  EXPECT_EQ(fused({{rectangle(0, 0, 1, 1), 0.5}, {rectangle(1, 0.5, 2, 1), 0.5}}, 1.0, 1e-9).size(), 2U);
  EXPECT_EQ(fused({{rectangle(0, 0, 1, 1), 0.5}, {{{1, 0}, {2, -1}, {2, 2}, {1, 1}}, 0.5}}, 1.0, 1e-9).size(), 2U);
}

TEST(Fused, RandomOverlaysKeepAreaValueAndPlace) {
  std::mt19937 random(11);
  for (int round = 0; round < 20; ++round) {
    Overlay overlay(1.0);
    for (int k = 0; k < 12; ++k) overlay.insert(random_polygon(random, 0.4), 1.0);
    const auto before = overlay.polygons();
    const auto after = fused(before, 1.0, 1e-9);
    EXPECT_LT(after.size(), before.size());
    EXPECT_NEAR(sum_of_areas(after), sum_of_areas(before), 1e-9);
    EXPECT_NEAR(sum_of_values(after), sum_of_values(before), 1e-9);
    std::uniform_real_distribution<double> place(-0.3, 1.3);
    for (int k = 0; k < 300; ++k) {
      const Vec2 p(place(random), place(random));
      EXPECT_NEAR(value_at(after, p), value_at(before, p), 1e-12);
    }
  }
}

TEST(PointLookup, FindsWithinItsToleranceAndNotBeyond) {
  geometry::PointLookup<int> lookup(1e-9);
  const geometry::Vec3 p(0.3, -0.7, 8e-9);  // on the border between two cells of the lookup
  lookup.insert(p, 1);
  const auto count = [&](const geometry::Vec3& at) {
    int found = 0;
    lookup.visit(at, [&](int) { ++found; });
    return found;
  };
  for (const double step : {-0.9e-9, 0.0, 0.9e-9}) EXPECT_EQ(count(p + geometry::Vec3(step, -step, step)), 1);
  EXPECT_EQ(count(p + geometry::Vec3(0.0, 1.2e-9, 0.0)), 0);
}

}  // namespace
}  // namespace retrace::raytrace::overlay_test
