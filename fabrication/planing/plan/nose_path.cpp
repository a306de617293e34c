#include "fabrication/planing/plan/nose_path.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace retrace::fabrication {
namespace {

/// Returns the centre of the nose that touches the surface of a zone at a point.
ProfilePoint middle_over(const ZoneProfile& profile, std::size_t zone, double x_mm, double nose_mm) {
  const double slope = profile.slope_in_zone(zone, x_mm);
  const double length = std::sqrt(1.0 + slope * slope);
  return {x_mm + nose_mm * slope / length, -profile.depth_in_zone_mm(zone, x_mm) + nose_mm / length};
}

bool has_wall(const ZoneProfile& profile, std::size_t zone) {
  return zone + 1 < profile.zones().size();
}

/// Returns the position at which the nose touches a zone while it also touches the wall at the end of the zone.
double last_touch_mm(const ZoneProfile& profile, std::size_t zone, double nose_mm) {
  const Zone& range = profile.zones()[zone];
  if (!has_wall(profile, zone)) return range.to_mm;
  double low = range.from_mm;
  double high = range.to_mm;
  while (high - low > 1e-14 * range.to_mm) {
    const double middle = 0.5 * (low + high);
    if (middle <= low || middle >= high) break;
    (middle_over(profile, zone, middle, nose_mm).x_mm < range.to_mm - nose_mm ? low : high) = middle;
  }
  return low;
}

/// Adds the path up along the wall at the beginning of a zone, and around the upper end of the wall.
void add_wall(const ZoneProfile& profile, std::size_t zone, double nose_mm, double step_rad,
              std::vector<ProfilePoint>& middles) {
  const double x = profile.zones()[zone].from_mm;
  const double z = -profile.depth_in_zone_mm(zone, x);
  const double last = 0.5 * std::numbers::pi - std::atan(profile.slope_in_zone(zone, x));
  const int steps = static_cast<int>(std::ceil((std::numbers::pi - last) / step_rad));
  for (int k = 0; k < steps; ++k) {
    const double angle = std::numbers::pi + (last - std::numbers::pi) * k / steps;
    middles.push_back({x + nose_mm * std::cos(angle), z + nose_mm * std::sin(angle)});
  }
}

}  // namespace

bool nose_fits(const ZoneProfile& profile, double nose_mm) {
  for (std::size_t zone = 0; has_wall(profile, zone); ++zone) {
    const Zone& range = profile.zones()[zone];
    const double at_wall = range.to_mm - nose_mm;
    if (!(middle_over(profile, zone, range.from_mm, nose_mm).x_mm <= at_wall)) return false;
    const double height = middle_over(profile, zone, last_touch_mm(profile, zone, nose_mm), nose_mm).z_mm;
    if (!(height <= -profile.depth_in_zone_mm(zone + 1, range.to_mm))) return false;
  }
  return true;
}

double largest_nose_mm(const ZoneProfile& profile) {
  double low = 0.0;
  double high = profile.lens().half_width_mm;
  while (high - low > 1e-4 * high) {
    const double middle = 0.5 * (low + high);
    (nose_fits(profile, middle) ? low : high) = middle;
  }
  return low;
}

double path_tolerance_mm(const ZoneProfile& profile, double nose_mm, double tolerance_mm) {
  if (nose_mm == 0.0) return tolerance_mm;
  // The angle between the two flanks of an edge is 90 degrees - a, where a is the angle of the steepest slope. If both
  // flanks are displaced by t, the edge is displaced by t / sin(45 degrees - a / 2).
  return tolerance_mm * std::sin(0.25 * std::numbers::pi - 0.5 * std::atan(profile.steepest_slope()));
}

std::vector<ProfilePoint> nose_points(const ZoneProfile& profile, double nose_mm, double spacing_mm,
                                      double tolerance_mm) {
  if (nose_mm == 0.0) return points_of(profile, spacing_mm);
  const double step_rad = std::min({spacing_mm / nose_mm, std::sqrt(8e-3 * tolerance_mm / nose_mm), 0.2});
  std::vector<ProfilePoint> middles;
  for (std::size_t zone = 0; zone < profile.zones().size(); ++zone) {
    if (zone > 0) add_wall(profile, zone, nose_mm, step_rad, middles);
    const double from = profile.zones()[zone].from_mm;
    const double to = last_touch_mm(profile, zone, nose_mm);
    const auto pieces = static_cast<std::size_t>(std::max(1.0, std::ceil((to - from) / spacing_mm)));
    for (std::size_t p = 0; p <= pieces; ++p)
      middles.push_back(middle_over(
          profile, zone, from + (to - from) * static_cast<double>(p) / static_cast<double>(pieces), nose_mm));
  }
  for (ProfilePoint& p : middles) p.z_mm -= nose_mm;
  return middles;
}

}  // namespace retrace::fabrication
