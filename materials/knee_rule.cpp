#include "materials/knee_rule.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/error.h"

namespace retrace::materials {
namespace {

/// Spacing in nm of grid points for the trapezium rule. They are used in addition to the wavelengths of the lamp's
/// table.
constexpr double kTableStepNm = 5.0;
/// Distance in nm from a knee to the first grid point of the trapezium rule. A knee is a wavelength near which an
/// integrated property of the part varies as the square root of the difference from this wavelength. Grid point j is at
/// j^2 times this distance from the knee.
constexpr double kFirstStepNm = 0.05;
constexpr int kStepsAtKnee = 10;

/// Range of wavelengths between two knees, or between a knee and an end of the lamp's spectrum.
struct Interval {
  double low_nm = 0.0;
  double high_nm = 0.0;
  bool has_knee_at_low = false;
  bool has_knee_at_high = false;

  /// Converts a wavelength to the integration variable of the Gauss rule. As a function of this variable, the square
  /// root of the difference from a knee is smooth. The variable increases with the wavelength.
  double coordinate(double wavelength_nm) const {
    const double share = std::clamp((wavelength_nm - low_nm) / (high_nm - low_nm), 0.0, 1.0);
    if (has_knee_at_low && has_knee_at_high) return std::asin(std::sqrt(share));
    if (has_knee_at_low) return std::sqrt(share);
    return has_knee_at_high ? -std::sqrt(1.0 - share) : share;
  }
  double wavelength_nm(double coordinate) const {
    double share = coordinate;
    if (has_knee_at_low && has_knee_at_high)
      share = std::pow(std::sin(coordinate), 2.0);
    else if (has_knee_at_low)
      share = coordinate * coordinate;
    else if (has_knee_at_high)
      share = 1.0 - coordinate * coordinate;
    return std::lerp(low_nm, high_nm, share);
  }
};

std::vector<Interval> intervals_of(const SpectralCurve& power, const std::vector<double>& knees_nm) {
  std::vector<Interval> intervals = {{power.wavelengths_nm.front(), power.wavelengths_nm.back()}};
  for (const double knee : knees_nm) {
    Interval& last = intervals.back();
    if (!(knee > last.low_nm && knee < last.high_nm)) continue;
    const Interval above{knee, last.high_nm, true, false};
    last.high_nm = knee;
    last.has_knee_at_high = true;
    intervals.push_back(above);
  }
  return intervals;
}

/// Returns the wavelengths of the trapezium rule over an interval, ascending, in nm.
std::vector<double> grid_of(const SpectralCurve& power, const Interval& interval) {
  std::vector<double> grid = {interval.low_nm, interval.high_nm};
  const auto add = [&](double w) {
    if (w > interval.low_nm && w < interval.high_nm) grid.push_back(w);
  };
  std::for_each(power.wavelengths_nm.begin(), power.wavelengths_nm.end(), add);
  for (double w = kTableStepNm * std::ceil(interval.low_nm / kTableStepNm); w < interval.high_nm; w += kTableStepNm)
    add(w);
  for (int j = 1; j <= kStepsAtKnee; ++j) {
    if (interval.has_knee_at_low) add(interval.low_nm + kFirstStepNm * j * j);
    if (interval.has_knee_at_high) add(interval.high_nm - kFirstStepNm * j * j);
  }
  std::sort(grid.begin(), grid.end());
  grid.erase(std::unique(grid.begin(), grid.end()), grid.end());
  return grid;
}

/// Returns the grid points of an interval with their fluxes as weights. The weights do not add to 1. The member
/// `wavelengths_nm` of the result contains the values of Interval::coordinate() instead of wavelengths.
Spectrum flux_over(const SpectralCurve& power, const SpectralCurve& efficiency, const Interval& interval) {
  const std::vector<double> grid = grid_of(power, interval);
  Spectrum flux;
  for (std::size_t k = 0; k < grid.size(); ++k) {
    const double width_nm = 0.5 * (grid[std::min(k + 1, grid.size() - 1)] - grid[k > 0 ? k - 1 : 0]);
    const double share = width_nm * power.at(grid[k]) * efficiency.at(grid[k]);
    if (!(share > 0.0)) continue;
    flux.wavelengths_nm.push_back(interval.coordinate(grid[k]));
    flux.weights.push_back(share);
  }
  return flux;
}

}  // namespace

Spectrum knee_rule(const SpectralCurve& power, const SpectralCurve& efficiency, std::size_t parts,
                   const std::vector<double>& knees_nm) {
  const std::vector<Interval> intervals = intervals_of(power, knees_nm);
  std::vector<Spectrum> fluxes;
  std::vector<double> sums;
  for (const Interval& interval : intervals) {
    fluxes.push_back(flux_over(power, efficiency, interval));
    sums.push_back(std::accumulate(fluxes.back().weights.begin(), fluxes.back().weights.end(), 0.0));
  }
  const double whole = std::accumulate(sums.begin(), sums.end(), 0.0);
  if (!(whole > 0.0)) throw InputError("the lamp has no power at wavelengths to which the receiver responds");
  Spectrum rule;
  for (std::size_t i = 0; i < intervals.size(); ++i) {
    const double share = sums[i] / whole;
    if (!(share > 1e-15)) continue;
    for (double& weight : fluxes[i].weights) weight /= sums[i];
    const auto own = static_cast<std::size_t>(std::lround(share * static_cast<double>(parts)));
    const Spectrum nodes = traced_spectrum(fluxes[i], std::max<std::size_t>(1, own));
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      rule.wavelengths_nm.push_back(intervals[i].wavelength_nm(nodes.wavelengths_nm[k]));
      rule.weights.push_back(share * nodes.weights[k]);
    }
  }
  return rule;
}

}  // namespace retrace::materials
