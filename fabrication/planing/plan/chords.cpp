#include "fabrication/planing/plan/chords.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "fabrication/planing/plan/zone_profile.h"

namespace retrace::fabrication {
namespace {

double distance_to_piece(const ProfilePoint& p, const ProfilePoint& a, const ProfilePoint& b) {
  const double dx = b.x_mm - a.x_mm;
  const double dz = b.z_mm - a.z_mm;
  const double along = ((p.x_mm - a.x_mm) * dx + (p.z_mm - a.z_mm) * dz) / (dx * dx + dz * dz);
  const double t = std::clamp(along, 0.0, 1.0);
  return std::hypot(p.x_mm - a.x_mm - t * dx, p.z_mm - a.z_mm - t * dz);
}

/// Calls visit(j) for every point j at which a chord from `start` may end. A chord must pass all points before its end
/// within the tolerance. The allowed directions of the chord form an interval, which becomes narrower with each point.
/// If the interval is empty, no later point can be reached.
template <class Visit>
void for_each_reached(const std::vector<ProfilePoint>& profile, std::size_t start, double tolerance_mm, Visit visit) {
  const ProfilePoint& from = profile[start];
  double reference = 0.0;
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  // Tolerance, so that rounding errors do not exclude a chord whose distance from a point is exactly `tolerance_mm`.
  constexpr double kRounding = 1e-12;
  double farthest = 0.0;  // maximum distance of the points so far from the start
  const auto all_beside = [&](std::size_t j) {
    for (std::size_t k = start + 1; k < j; ++k)
      if (distance_to_piece(profile[k], from, profile[j]) > tolerance_mm + kRounding) return false;
    return true;
  };
  for (std::size_t j = start + 1; j < profile.size(); ++j) {
    const double dx = profile[j].x_mm - from.x_mm;
    const double dz = profile[j].z_mm - from.z_mm;
    const double distance = std::hypot(dx, dz);
    if (j == start + 1) reference = std::atan2(dz, dx);
    const double turn = std::remainder(std::atan2(dz, dx) - reference, 2.0 * std::numbers::pi);
    // If the profile turns back, as at a step, points may be beyond the end of the chord. They are then checked one by
    // one.
    if (turn >= low - kRounding && turn <= high + kRounding && (distance >= farthest || all_beside(j))) visit(j);
    farthest = std::max(farthest, distance);
    if (distance <= tolerance_mm) continue;
    const double half = std::asin(tolerance_mm / distance);
    low = std::max(low, turn - half);
    high = std::min(high, turn + half);
    if (low > high + kRounding) return;
  }
}

}  // namespace

Chords longest_chords(const std::vector<ProfilePoint>& profile, double tolerance_mm) {
  Chords chords = {0};
  while (chords.back() + 1 < profile.size()) {
    std::size_t farthest = chords.back() + 1;
    for_each_reached(profile, chords.back(), tolerance_mm, [&](std::size_t j) { farthest = j; });
    chords.push_back(farthest);
  }
  return chords;
}

Chords fewest_chords(const std::vector<ProfilePoint>& profile, double tolerance_mm) {
  const std::size_t last = profile.size() - 1;
  // Minimum number of chords from each point to the end. It is computed from the end backwards.
  std::vector<std::size_t> count(profile.size(), 0);
  std::vector<std::size_t> next(profile.size(), last);
  for (std::size_t i = last; i-- > 0;) {
    std::size_t best = std::numeric_limits<std::size_t>::max();
    for_each_reached(profile, i, tolerance_mm, [&](std::size_t j) {
      if (count[j] + 1 > best) return;
      best = count[j] + 1;
      next[i] = j;
    });
    count[i] = best;
  }
  Chords chords = {0};
  while (chords.back() != last) chords.push_back(next[chords.back()]);
  return chords;
}

std::vector<ProfilePoint> points_of(const ZoneProfile& profile, double spacing_mm) {
  std::vector<ProfilePoint> points;
  for (std::size_t k = 0; k < profile.zones().size(); ++k) {
    const Zone& zone = profile.zones()[k];
    const auto pieces = static_cast<std::size_t>(std::ceil((zone.to_mm - zone.from_mm) / spacing_mm));
    for (std::size_t p = 0; p <= pieces; ++p) {
      const double x =
          zone.from_mm + (zone.to_mm - zone.from_mm) * static_cast<double>(p) / static_cast<double>(pieces);
      points.push_back({x, -profile.depth_in_zone_mm(k, x)});
    }
  }
  return points;
}

}  // namespace retrace::fabrication
