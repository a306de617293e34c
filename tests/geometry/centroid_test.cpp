// Tests of the centroids of polygons: closed forms, additivity, and invariance when corners are inserted on sides.
#include "geometry/centroid.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/random.h"
#include "geometry/polygon.h"

namespace retrace::geometry::centroid_test {
namespace {

Vec2 centroid_of(const Polygon& polygon) {
  return centroid(std::span<const Vec2>(polygon));
}

/// Generator of random numbers that are uniformly distributed from 0 to 1.
class Draws {
 public:
  explicit Draws(std::uint32_t seed) : seed_(seed) {}
  double operator()() { return unit_interval(philox({seed_, 0}, count_++, 0, 0)[0]); }

 private:
  std::uint32_t seed_;
  std::uint32_t count_ = 0;
};

/// Returns a polygon whose corners are on an ellipse in counter-clockwise order, with a random position and shape.
Polygon convex_polygon(Draws& draw) {
  Polygon polygon;
  const Vec2 centre(20.0 * draw() - 10.0, 20.0 * draw() - 10.0);
  const double flatness = std::pow(10.0, -6.0 * draw());
  const auto corners = static_cast<int>(3.0 + 6.0 * draw());
  for (int k = 0; k < corners; ++k) {
    const double angle = 2.0 * std::numbers::pi * (k + 0.9 * draw()) / corners;
    polygon.emplace_back(centre + Vec2(std::cos(angle), flatness * std::sin(angle)));
  }
  return polygon;
}

/// Returns the centroid of a polygon, computed as the area-weighted mean of the centroids of a fan of triangles.
Vec2 centroid_by_triangles(const Polygon& polygon) {
  Vec2 moment = Vec2::Zero();
  double area_mm2 = 0.0;
  for (std::size_t k = 2; k < polygon.size(); ++k) {
    const Polygon triangle = {polygon[0], polygon[k - 1], polygon[k]};
    moment += area(triangle) * (triangle[0] + triangle[1] + triangle[2]) / 3.0;
    area_mm2 += area(triangle);
  }
  return moment / area_mm2;
}

TEST(Centroid, ClosedForms) {
  EXPECT_NEAR((centroid_of({{0, 0}, {3, 0}, {0, 6}}) - Vec2(1, 2)).norm(), 0.0, 1e-15);
  // The centroid of a trapezoid with the parallel sides a and b and the height h is h (a + 2 b) / (3 (a + b)) above a.
  EXPECT_NEAR((centroid_of({{-3, 0}, {3, 0}, {1, 4}, {-1, 4}}) - Vec2(0, 4.0 * (6 + 2 * 2) / (3.0 * 8))).norm(), 0.0,
              1e-15);
  // The centroid of half a disc of radius 1 is 4 / (3 pi) above its straight side.
  Polygon half;
  for (int k = 0; k <= 20000; ++k)
    half.emplace_back(std::cos(std::numbers::pi * k / 20000), std::sin(std::numbers::pi * k / 20000));
  EXPECT_NEAR((centroid_of(half) - Vec2(0, 4.0 / (3.0 * std::numbers::pi))).norm(), 0.0, 1e-8);
}

// An additional corner on an edge does not move the centroid, however close it is to another corner.
TEST(Centroid, ExtraCornersMoveNothing) {
  Draws draw(1);
  for (int trial = 0; trial < 500; ++trial) {
    const Polygon polygon = convex_polygon(draw);
    const Vec2 before = centroid_of(polygon);
    EXPECT_NEAR((before - centroid_by_triangles(polygon)).norm(), 0.0, 1e-7);
    const double distance = std::pow(10.0, -9.0 - 7.0 * draw());
    for (const double share : {distance, 1.0 - distance, draw(), 0.0}) {
      Polygon more = polygon;
      const auto k = static_cast<std::size_t>(draw() * static_cast<double>(polygon.size()));
      const Vec2 extra = polygon[k] + share * (polygon[(k + 1) % polygon.size()] - polygon[k]);
      more.insert(more.begin() + static_cast<std::ptrdiff_t>(k) + 1, extra);
      EXPECT_NEAR((centroid_of(more) - before).norm(), 0.0, 1e-8) << "trial " << trial << ", share " << share;
    }
  }
}

// If a line divides a polygon, the area-weighted mean of the centroids of both parts is the centroid of the polygon.
TEST(Centroid, IsAdditive) {
  Draws draw(2);
  for (int trial = 0; trial < 200; ++trial) {
    const Polygon polygon = convex_polygon(draw);
    const Rectangle box = bounding_box(polygon);
    Rectangle left = box, right = box;
    left.upper.x() = right.lower.x() = std::lerp(box.lower.x(), box.upper.x(), draw());
    Vec2 moment = Vec2::Zero();
    for (const Rectangle& half : {left, right})
      if (const Polygon part = clip(polygon, half, 0.0); !part.empty()) moment += area(part) * centroid_of(part);
    EXPECT_NEAR((moment / area(polygon) - centroid_of(polygon)).norm(), 0.0, 1e-7);
  }
}

// A polygon without area has the centroid of its border. No centroid is outside the bounding box of the corners.
TEST(Centroid, DegeneratePolygons) {
  EXPECT_EQ(centroid_of({{1, 2}}), Vec2(1, 2));
  EXPECT_EQ(centroid_of({{1, 2}, {1, 2}, {1, 2}}), Vec2(1, 2));
  EXPECT_NEAR((centroid_of({{0, 0}, {1, 1}, {4, 4}}) - Vec2(2, 2)).norm(), 0.0, 1e-14);
  EXPECT_NEAR((centroid_of({{0, 0}, {0, 0}, {4, 4}}) - Vec2(2, 2)).norm(), 0.0, 1e-14);
  Draws draw(3);
  for (int trial = 0; trial < 1000; ++trial) {
    const double width = std::pow(10.0, -20.0 * draw());
    const Vec2 at(1e3 * draw(), 1e3 * draw()), along = Vec2(draw() - 0.5, draw() - 0.5).normalized();
    const Vec2 across(-along.y(), along.x());
    const Polygon sliver = {at, at + along, at + along + width * across, at + 0.4 * along + width * across};
    const Rectangle box = bounding_box(sliver);
    const Vec2 middle = centroid_of(sliver);
    ASSERT_TRUE((middle.array() >= box.lower.array()).all() && (middle.array() <= box.upper.array()).all());
    EXPECT_LT(std::abs((middle - at).dot(across)), width + 1e-12);
  }
}

TEST(Centroid, OfAPolygonInSpaceIsThatOfItsPlane) {
  Draws draw(4);
  for (int trial = 0; trial < 100; ++trial) {
    const Polygon polygon = convex_polygon(draw);
    const Eigen::Quaterniond turn =
        Eigen::Quaterniond(draw() - 0.5, draw() - 0.5, draw() - 0.5, draw() - 0.5).normalized();
    const auto in_space = [&](const Vec2& p) { return Vec3(turn * Vec3(p.x(), p.y(), 2.0)); };
    std::vector<Vec3> corners;
    std::vector<std::uint32_t> ring;
    for (const Vec2& p : polygon) {
      ring.push_back(static_cast<std::uint32_t>(corners.size()));
      corners.push_back(in_space(p));
    }
    EXPECT_NEAR((ring_centroid(corners, ring) - in_space(centroid_of(polygon))).norm(), 0.0, 1e-8);
  }
}

}  // namespace
}  // namespace retrace::geometry::centroid_test
