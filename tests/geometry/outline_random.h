#pragma once

// Outlines for tests: polygons with rounded corners, and random star-shaped outlines with arcs, rounded corners and
// holes. The random outlines may be convex or not convex.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <optional>
#include <random>
#include <vector>

#include "geometry/outline/plan_region.h"

namespace retrace::geometry {

/// Returns a loop from its corners and the bulges of its sides. Without bulges, all sides are straight.
inline OutlineLoop polygon_of_corners(const std::vector<Vec2>& corners, const std::vector<double>& bulges = {}) {
  OutlineLoop loop;
  for (std::size_t k = 0; k < corners.size(); ++k)
    loop.push_back({corners[k], corners[(k + 1) % corners.size()], bulges.empty() ? 0.0 : bulges[k]});
  return loop;
}

/// Returns a loop whose corners are all rounded with one radius.
inline OutlineLoop rounded(const OutlineLoop& loop, double radius_mm) {
  std::optional<CornerFault> fault;
  OutlineLoop result = with_rounded_corners(loop, std::vector<double>(loop.size(), radius_mm), fault);
  EXPECT_FALSE(fault);
  return result;
}

/// Returns a random outline of about 2 `radius_mm` in size that fault_of_outline() allows.
inline Outline random_outline(std::mt19937& random, double radius_mm) {
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  while (true) {
    const int corners = std::uniform_int_distribution<int>(3, 9)(random);
    std::vector<Vec2> points;
    std::vector<double> bulges;
    std::vector<double> radii;
    for (int k = 0; k < corners; ++k) {
      const double rad = 2.0 * std::numbers::pi * (k + between(-0.3, 0.3)) / corners;
      const double r = radius_mm * between(0.45, 1.0);
      points.emplace_back(r * std::cos(rad), r * std::sin(rad));
      bulges.push_back(between(0.0, 1.0) < 0.4 ? between(-0.3, 0.5) : 0.0);
      radii.push_back(between(0.0, 1.0) < 0.6 ? radius_mm * between(0.01, 0.12) : 0.0);
    }
    std::optional<CornerFault> corner;
    const OutlineLoop outer = with_rounded_corners(polygon_of_corners(points, bulges), radii, corner);
    if (corner) continue;
    std::vector<OutlineLoop> loops = {outer};
    if (between(0.0, 1.0) < 0.3)
      loops.push_back(
          circle({radius_mm * between(-0.1, 0.1), radius_mm * between(-0.1, 0.1)}, radius_mm * between(0.04, 0.15)));
    const Outline outline = oriented(std::move(loops));
    std::optional<OutlineFault> fault;
    plan_region(outline, 0.0, 1e-3 * radius_mm, fault);
    if (!fault) return outline;
  }
}

}  // namespace retrace::geometry
