// Tests of chords that approximate a profile within a tolerance. The chords of an arc are compared with a closed form.
// For random profiles, the number of chords is compared with the minimum over all sets of chords.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/random.h"
#include "fabrication/planing/plan/chords.h"

namespace retrace::fabrication::chords_test {
namespace {

std::vector<ProfilePoint> circle(double radius_mm, double spacing_mm, double length_mm) {
  std::vector<ProfilePoint> points;
  for (double way = 0.0; way <= length_mm; way += spacing_mm)
    points.push_back({radius_mm * std::sin(way / radius_mm), -radius_mm * (1.0 - std::cos(way / radius_mm))});
  return points;
}

double random(std::uint32_t seed, std::uint32_t k) {
  return unit_interval(philox({seed, 7}, k, 0)[0]);
}

/// Returns the distance of the point p from the line segment between a and b.
double off_piece(const ProfilePoint& a, const ProfilePoint& b, const ProfilePoint& p) {
  const double dx = b.x_mm - a.x_mm;
  const double dz = b.z_mm - a.z_mm;
  const double t = std::clamp(((p.x_mm - a.x_mm) * dx + (p.z_mm - a.z_mm) * dz) / (dx * dx + dz * dz), 0.0, 1.0);
  return std::hypot(p.x_mm - a.x_mm - t * dx, p.z_mm - a.z_mm - t * dz);
}

bool fits(const std::vector<ProfilePoint>& points, std::size_t i, std::size_t j, double tolerance_mm) {
  for (std::size_t k = i + 1; k < j; ++k)
    if (off_piece(points[i], points[j], points[k]) > tolerance_mm + 1e-12) return false;
  return true;
}

/// Returns the minimum number of chords, by dynamic programming over all pairs of points.
std::size_t fewest_by_all_pairs(const std::vector<ProfilePoint>& points, double tolerance_mm) {
  std::vector<std::size_t> count(points.size(), std::numeric_limits<std::size_t>::max());
  count[0] = 0;
  for (std::size_t j = 1; j < points.size(); ++j)
    for (std::size_t i = 0; i < j; ++i)
      if (fits(points, i, j, tolerance_mm)) count[j] = std::min(count[j], count[i] + 1);
  return count.back();
}

void expect_in_tube(const std::vector<ProfilePoint>& points, const Chords& chords, double tolerance_mm) {
  ASSERT_EQ(chords.front(), 0U);
  ASSERT_EQ(chords.back(), points.size() - 1);
  for (std::size_t k = 0; k + 1 < chords.size(); ++k) {
    ASSERT_LT(chords[k], chords[k + 1]);
    EXPECT_TRUE(fits(points, chords[k], chords[k + 1], tolerance_mm));
  }
}

/// Returns a profile whose slope changes at random from point to point.
std::vector<ProfilePoint> wandering(std::uint32_t seed) {
  std::vector<ProfilePoint> points;
  double slope = 0.0;
  double height = 0.0;
  for (std::uint32_t k = 0; k < 70; ++k) {
    points.push_back({0.1 * k, height});
    slope += 0.6 * (random(seed, k) - 0.5);
    height += 0.1 * slope;
  }
  return points;
}

/// Returns a convex profile, whose slope only increases.
std::vector<ProfilePoint> convex(std::uint32_t seed) {
  std::vector<ProfilePoint> points;
  double slope = -1.0;
  double height = 0.0;
  for (std::uint32_t k = 0; k < 70; ++k) {
    points.push_back({0.1 * k, height});
    slope += 0.08 * random(seed, k);
    height += 0.1 * slope;
  }
  return points;
}

TEST(Chords, OfACircle) {
  // The square of half the chord is R^2 - (R - t)^2. The chord is 0.894 mm long at R = 10 mm and t = 0.01 mm.
  const double chord_mm = 2.0 * std::sqrt(2.0 * 10.0 * 0.01 - 0.01 * 0.01);
  EXPECT_NEAR(chord_mm, 0.894, 5e-4);
  const double spacing_mm = 1e-3;
  const auto points = circle(10.0, spacing_mm, 6.0);
  for (const Chords& chords : {longest_chords(points, 0.01), fewest_chords(points, 0.01)}) {
    const ProfilePoint& end = points[chords[1]];
    EXPECT_NEAR(std::hypot(end.x_mm, end.z_mm), chord_mm, 2.0 * spacing_mm);
    EXPECT_EQ(chords.size() - 1, 7U);  // on an arc of 6 mm
    expect_in_tube(points, chords, 0.01);
  }
}

TEST(Chords, NoFewerArePossible) {
  for (std::uint32_t seed = 1; seed <= 40; ++seed)
    for (const double tolerance_mm : {0.0, 0.002, 0.01, 0.05}) {
      const auto points = wandering(seed);
      const Chords chords = fewest_chords(points, tolerance_mm);
      expect_in_tube(points, chords, tolerance_mm);
      EXPECT_EQ(chords.size() - 1, fewest_by_all_pairs(points, tolerance_mm)) << seed << ' ' << tolerance_mm;
    }
}

TEST(Chords, LongestAreTheFewestOfConvexProfiles) {
  for (std::uint32_t seed = 1; seed <= 40; ++seed)
    for (const double tolerance_mm : {0.002, 0.01, 0.05}) {
      const auto points = convex(seed);
      const Chords chords = longest_chords(points, tolerance_mm);
      expect_in_tube(points, chords, tolerance_mm);
      EXPECT_EQ(chords.size() - 1, fewest_by_all_pairs(points, tolerance_mm)) << seed << ' ' << tolerance_mm;
    }
}

TEST(Chords, LongestAreNotAlwaysTheFewest) {
  // The longest first chord ends at the high point 2. From there, no chord reaches the end, because it would be too far
  // from the low point 3. From point 1, one chord reaches the end.
  const std::vector<ProfilePoint> points = {{0.0, 0.0}, {1.0, 0.0}, {2.0, 0.9}, {3.0, -0.9}, {4.0, 0.0}, {9.0, 0.0}};
  const std::size_t longest = longest_chords(points, 1.0).size() - 1;
  EXPECT_LE(fewest_chords(points, 1.0).size() - 1, longest);
  bool found = false;
  for (std::uint32_t seed = 1; seed <= 60 && !found; ++seed)
    for (const double tolerance_mm : {0.01, 0.02, 0.05}) {
      const auto wild = wandering(seed);
      found = found || fewest_chords(wild, tolerance_mm).size() < longest_chords(wild, tolerance_mm).size();
    }
  EXPECT_TRUE(found) << "profiles that bend both ways have fewer chords than the longest ones";
}

}  // namespace
}  // namespace retrace::fabrication::chords_test
