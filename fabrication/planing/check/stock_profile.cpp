#include "fabrication/planing/check/stock_profile.h"

#include <algorithm>
#include <cmath>

namespace retrace::fabrication {
namespace {

/// Maximum extent along X, in mm, of line segments that are considered vertical.
constexpr double kUprightMm = 1e-9;

}  // namespace

StockProfile::StockProfile(double end_mm, double spacing_mm, double nose_mm) : nose_(nose_mm) {
  const auto pieces = static_cast<std::size_t>(std::ceil(end_mm / spacing_mm));
  spacing_ = end_mm / static_cast<double>(pieces);
  heights_.assign(pieces + 1, 0.0);
  who_.assign(pieces + 1, -1);
}

double StockProfile::cut(const SectionPoint& from, const SectionPoint& to, std::int32_t who) {
  double most = cut_side(from, to, who);
  if (std::min(from.x_mm, to.x_mm) < nose_)
    most = std::max(most, cut_side({-from.x_mm, from.z_mm}, {-to.x_mm, to.z_mm}, who));
  return most;
}

template <class Height>
double StockProfile::lower(double from_mm, double to_mm, std::int32_t who, const Height& height) {
  constexpr double kHitMm = 1e-9;
  double most = 0.0;
  const auto last = static_cast<double>(heights_.size() - 1);
  const double first = std::clamp(std::ceil((from_mm - kHitMm) / spacing_), 0.0, last + 1.0);
  const double end = std::floor((to_mm + kHitMm) / spacing_);
  for (auto i = static_cast<std::size_t>(first); i < heights_.size() && static_cast<double>(i) <= end; ++i) {
    const double z = height(position_mm(i));
    if (!(z < heights_[i])) continue;
    most = std::max(most, heights_[i] - z);
    heights_[i] = z;
    who_[i] = who;
  }
  return most;
}

double StockProfile::cut_side(const SectionPoint& from, const SectionPoint& to, std::int32_t who) {
  const SectionPoint& a = from.x_mm <= to.x_mm ? from : to;
  const SectionPoint& b = from.x_mm <= to.x_mm ? to : from;
  const double dx = b.x_mm - a.x_mm;
  const double dz = b.z_mm - a.z_mm;
  double most = 0.0;
  if (nose_ == 0.0) {
    if (dx < kUprightMm)
      return lower(a.x_mm - 0.5 * spacing_, a.x_mm + 0.5 * spacing_, who,
                   [&](double) { return std::min(a.z_mm, b.z_mm); });
    return lower(a.x_mm, b.x_mm, who, [&](double x) { return a.z_mm + (x - a.x_mm) * dz / dx; });
  }
  for (const SectionPoint& end : {a, b})
    most = std::max(most, lower(end.x_mm - nose_, end.x_mm + nose_, who, [&](double x) {
                      const double aside = x - end.x_mm;
                      return end.z_mm + nose_ - std::sqrt(std::max(0.0, nose_ * nose_ - aside * aside));
                    }));
  if (dx < kUprightMm) return most;
  // Between the discs at its ends, a move produces the line that touches both discs from below.
  const double length = std::hypot(dx, dz);
  const double start = a.x_mm + nose_ * dz / length;
  const double z = a.z_mm + nose_ * (1.0 - dx / length);
  return std::max(most, lower(start, start + dx, who, [&](double x) { return z + (x - start) * dz / dx; }));
}

}  // namespace retrace::fabrication
