#include "fabrication/planing/plan/zone_profile.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/number_format.h"

namespace retrace::fabrication {
namespace {

constexpr std::size_t kMaxZones = 10000;

}  // namespace

ZoneProfile::ZoneProfile(const ZoneLens& lens) : lens_(lens) {
  step_mm_ = lens.wavelength_mm / (lens.refractive_index - 1.0);
  double from = 0.0;
  while (from < lens.half_width_mm) {
    const std::size_t zone = zones_.size();
    if (zone >= kMaxZones) throw InputError(fmt::format("the lens has more than {} zones", kMaxZones));
    if (!(vertex_distance_mm(zone) > 0.0))
      throw InputError(
          fmt::format("the lens has more zones than its focal length allows: zone {} would begin beyond the "
                      "focus; each zone is offset by wavelength_mm / (refractive_index - 1) = {} mm",
                      zone + 1, fixed(step_mm_, 6)));
    const double to = position_in_zone_mm(zone, step_mm_);
    zones_.push_back({from, std::min(to, lens.half_width_mm)});
    from = to;
  }
}

double ZoneProfile::vertex_distance_mm(std::size_t zone) const {
  return lens_.focal_length_mm - static_cast<double>(zone) * step_mm_;
}

std::size_t ZoneProfile::zone_of(double x_mm) const {
  const auto after =
      std::upper_bound(zones_.begin(), zones_.end(), x_mm, [](double x, const Zone& zone) { return x < zone.from_mm; });
  return static_cast<std::size_t>(after - zones_.begin()) - 1;
}

double ZoneProfile::depth_in_zone_mm(std::size_t zone, double x_mm) const {
  const double n = lens_.refractive_index;
  const double near = (n - 1.0) * vertex_distance_mm(zone);
  // Solve x^2 = 2 (n - 1) F z' + (n^2 - 1) z'^2 for z' without cancellation.
  const double beyond_vertex = x_mm * x_mm / (near + std::sqrt(near * near + (n * n - 1.0) * x_mm * x_mm));
  return beyond_vertex - static_cast<double>(zone) * step_mm_;
}

double ZoneProfile::slope_in_zone(std::size_t zone, double x_mm) const {
  const double n = lens_.refractive_index;
  const double near = (n - 1.0) * vertex_distance_mm(zone);
  return x_mm / std::sqrt(near * near + (n * n - 1.0) * x_mm * x_mm);
}

double ZoneProfile::position_in_zone_mm(std::size_t zone, double depth_mm) const {
  const double n = lens_.refractive_index;
  const double z = depth_mm + static_cast<double>(zone) * step_mm_;
  return std::sqrt(2.0 * (n - 1.0) * vertex_distance_mm(zone) * z + (n * n - 1.0) * z * z);
}

double ZoneProfile::steepest_slope() const {
  double steepest = 0.0;
  for (std::size_t zone = 0; zone < zones_.size(); ++zone)
    steepest = std::max(steepest, slope_in_zone(zone, zones_[zone].to_mm));
  return steepest;
}

}  // namespace retrace::fabrication
