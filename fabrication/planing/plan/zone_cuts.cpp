#include "fabrication/planing/plan/zone_cuts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/angle.h"
#include "core/error.h"
#include "core/number_format.h"

namespace retrace::fabrication {

double flank_slope_of(const ZoneProfile& profile) {
  constexpr double kStepsPerDegree = 2.0;
  const double deg = Angle::from_rad(std::atan(profile.steepest_slope())).deg();
  return std::tan(Angle::from_deg(std::ceil(kStepsPerDegree * deg) / kStepsPerDegree).rad());
}

ZoneCutter::ZoneCutter(const ZoneProfile& profile, double grid_mm, double tolerance_mm)
    : profile_(profile), grid_mm_(grid_mm), tolerance_mm_(tolerance_mm), flank_slope_(flank_slope_of(profile)) {}

std::int64_t ZoneCutter::first_grid_index(std::size_t zone) const {
  return static_cast<std::int64_t>(std::ceil(profile_.zones()[zone].from_mm / grid_mm_));
}

std::int64_t ZoneCutter::last_grid_index(std::size_t zone) const {
  return std::llround(profile_.zones()[zone].to_mm / grid_mm_);
}

ZoneCut ZoneCutter::cut_at(std::size_t zone, std::int64_t x) const {
  const double depth =
      profile_.depth_in_zone_mm(zone, std::min(static_cast<double>(x) * grid_mm_, profile_.zones()[zone].to_mm));
  return {zone, x, std::llround(depth / grid_mm_)};
}

double ZoneCutter::cusp_height_mm(std::size_t zone, const ZoneCut* before, const ZoneCut& cut) const {
  const double x = static_cast<double>(cut.x) * grid_mm_;
  const double depth = static_cast<double>(cut.depth) * grid_mm_;
  const double from = before != nullptr ? static_cast<double>(before->x) * grid_mm_ : profile_.zones()[zone].from_mm;
  // The flank is steeper than the profile. The remaining material is therefore highest directly outside of the previous
  // cut, or at the point where the flank leaves the blank.
  const double worst = std::min(x, std::max(from, x - depth / flank_slope_));
  return profile_.depth_in_zone_mm(zone, worst) - std::max(0.0, depth - flank_slope_ * (x - worst));
}

std::optional<ZoneCut> ZoneCutter::at_depth(std::size_t zone, std::int64_t depth, std::int64_t next_depth,
                                            const ZoneCut* before) const {
  const double middle = static_cast<double>(depth) * grid_mm_;
  const auto place = [&](double depth_mm) {
    return profile_.position_in_zone_mm(zone, std::max(depth_mm, 0.0)) / grid_mm_;
  };
  const std::int64_t last = last_grid_index(zone);
  const std::int64_t low =
      std::max(first_grid_index(zone), static_cast<std::int64_t>(std::ceil(place(middle - 0.5 * grid_mm_))));
  const std::int64_t high = std::min(last, static_cast<std::int64_t>(std::floor(place(middle + 0.5 * grid_mm_))));
  if (low == high) return ZoneCut{zone, low, depth};  // exactly one grid point is at this depth
  if (low < high) {
    // Several grid points are at this depth. Use the outermost one that leaves no more material than the tolerance.
    std::int64_t fits = low;
    std::int64_t beyond = high + 1;
    while (beyond - fits > 1) {
      const std::int64_t probe = fits + (beyond - fits) / 2;
      (cusp_height_mm(zone, before, {zone, probe, depth}) <= tolerance_mm_ ? fits : beyond) = probe;
    }
    return ZoneCut{zone, fits, depth};
  }
  // No grid point is at this depth. Cut at the nearest one only if a cut at the next depth would leave more than the
  // tolerance.
  const std::int64_t nearest = std::clamp<std::int64_t>(std::llround(place(middle)), first_grid_index(zone), last);
  const auto next =
      std::min(last, static_cast<std::int64_t>(std::llround(place(static_cast<double>(next_depth) * grid_mm_))));
  if (next <= nearest || cusp_height_mm(zone, before, cut_at(zone, next)) <= tolerance_mm_) return std::nullopt;
  return cut_at(zone, nearest);
}

std::optional<std::vector<ZoneCut>> ZoneCutter::cuts_at_depths(std::size_t zone, std::int64_t quantum) const {
  const Zone& range = profile_.zones()[zone];
  const double shallowest = profile_.depth_in_zone_mm(zone, range.from_mm);
  const ZoneCut deepest = cut_at(zone, last_grid_index(zone));
  std::vector<ZoneCut> cuts;
  const auto before = [&]() { return cuts.empty() ? nullptr : &cuts.back(); };
  for (std::int64_t depth = quantum; depth < deepest.depth; depth += quantum) {
    if (static_cast<double>(depth) * grid_mm_ < shallowest) continue;
    const auto cut = at_depth(zone, depth, std::min(depth + quantum, deepest.depth), before());
    if (!cut || (before() != nullptr && cut->x <= before()->x)) continue;
    if (cusp_height_mm(zone, before(), *cut) > tolerance_mm_) return std::nullopt;
    cuts.push_back(*cut);
  }
  if (cusp_height_mm(zone, before(), deepest) > tolerance_mm_) return std::nullopt;
  if (before() == nullptr || before()->x < deepest.x) cuts.push_back(deepest);
  return cuts;
}

std::vector<ZoneCut> ZoneCutter::sequential_cuts(std::size_t zone) const {
  std::vector<ZoneCut> cuts;
  const std::int64_t last = last_grid_index(zone);
  std::int64_t at = first_grid_index(zone) - 1;
  while (at < last) {
    const ZoneCut* const before = cuts.empty() ? nullptr : &cuts.back();
    std::int64_t fits = at;
    std::int64_t beyond = last + 1;
    while (beyond - fits > 1) {
      const std::int64_t probe = fits + (beyond - fits) / 2;
      (cusp_height_mm(zone, before, cut_at(zone, probe)) <= tolerance_mm_ ? fits : beyond) = probe;
    }
    if (fits == at)
      throw InputError(fmt::format("neighbouring cuts on a grid of {} mm leave more material than {} mm",
                                   shortest(grid_mm_), shortest(tolerance_mm_)));
    cuts.push_back(cut_at(zone, fits));
    at = fits;
  }
  return cuts;
}

}  // namespace retrace::fabrication
