#include "fabrication/planing/check/phase_profile.h"

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>

#include "core/angle.h"

namespace retrace::fabrication {
namespace {

/// Returns the root of a function that has opposite signs at the two ends (G. E. Alefeld, F. A. Potra, Y. Shi, ACM TOMS
/// 21, 327, 1995).
template <class F>
double root_between(const F& f, double low, double high) {
  const double at_low = f(low);
  const double at_high = f(high);
  if (at_low == 0.0) return low;
  if (at_high == 0.0) return high;
  std::uintmax_t steps = 100;
  const auto [a, b] = boost::math::tools::toms748_solve(f, low, high, at_low, at_high,
                                                        boost::math::tools::eps_tolerance<double>(52), steps);
  return 0.5 * (a + b);
}

}  // namespace

PhaseProfile::PhaseProfile(const ZoneLens& lens)
    : lens_(lens), deepest_mm_(lens.wavelength_mm / (lens.refractive_index - 1.0)) {
  // At the maximum depth, the optical path increases with the distance from the centre. There is a wall wherever the
  // path difference is a whole number of wavelengths.
  const auto at_the_deepest = [&](double x) { return waves(x, deepest_mm_); };
  const double last = at_the_deepest(lens.half_width_mm);
  double from = 0.0;
  for (double order = 0.0; order < last; order += 1.0) {
    const double x =
        root_between([&](double place) { return at_the_deepest(place) - order; }, from, lens.half_width_mm);
    walls_.push_back({x, deepest_mm_, depth_of_order_mm(x, order + 1.0)});
    from = x;
  }
}

double PhaseProfile::waves(double x_mm, double depth_mm) const {
  const double to_lens = lens_.focal_length_mm + depth_mm;
  return (std::hypot(x_mm, to_lens) - lens_.focal_length_mm - lens_.refractive_index * depth_mm) / lens_.wavelength_mm;
}

double PhaseProfile::depth_of_order_mm(double x_mm, double order) const {
  return root_between([&](double depth) { return waves(x_mm, depth) - order; }, 0.0, deepest_mm_);
}

double PhaseProfile::depth_mm(double x_mm) const {
  // The optical path decreases with the depth. Use the lowest order that is reached at the maximum depth or at a
  // smaller depth.
  return depth_of_order_mm(x_mm, std::max(0.0, std::ceil(waves(x_mm, deepest_mm_))));
}

double PhaseProfile::slope(double x_mm, double depth_mm) const {
  // The optical path is constant along the profile. The slope follows from the derivatives of the path with respect to
  // position and depth.
  const double to_lens = lens_.focal_length_mm + depth_mm;
  const double way = std::hypot(x_mm, to_lens);
  return (x_mm / way) / (lens_.refractive_index - to_lens / way);
}

double flank_slope_of(const PhaseProfile& profile, double half_width_mm) {
  double steepest = profile.slope(half_width_mm, profile.depth_mm(half_width_mm));
  for (const Wall& wall : profile.walls()) steepest = std::max(steepest, profile.slope(wall.x_mm, wall.inner_depth_mm));
  constexpr double kStepsPerDegree = 2.0;
  const double deg = std::atan(steepest) / kRadPerDeg;
  return std::tan(std::ceil(kStepsPerDegree * deg) / kStepsPerDegree * kRadPerDeg);
}

}  // namespace retrace::fabrication
