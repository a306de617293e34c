#pragma once

// Numerical derivatives with an error estimate, for functions whose values carry noise, such as ray-traced
// efficiencies.

#include <cmath>
#include <functional>
#include <limits>

namespace retrace {

/// The value of a function that is computed with an error, such as that of leaving out what is small.
struct Sample {
  double value = 0.0;
  double noise = 0.0;  ///< bound on the error of `value` that has nothing to do with its neighbours'; >= 0
};

/// Where a function may be evaluated to find its derivative, in units of its argument.
struct DifferenceRange {
  double first_step = 0.0;  ///< over which the function is expected to be smooth; > 0
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
};

struct Derivative {
  double value = 0.0;
  double error = std::numeric_limits<double>::infinity();  ///< estimated bound on the error of `value`, noise included
  double noise = 0.0;                                      ///< share of `error` that noise has

  bool converged() const { return error <= 1e-3 * std::abs(value) + 1e-6; }
};

/// The derivative of `f` at `x` by central differences with steps halved from `range.first_step`, extrapolated to step
/// 0 in a Neville tableau whose entries are compared to estimate the error (Ridders, Adv. Eng. Software 4, 75, 1982).
/// Differences to one side alone are extrapolated as well: where they disagree by more than their errors `f` has a
/// kink, and half their distance is the error. Where `range` leaves no room on one side, the other serves alone.
///
/// A kink or jump as near as the least step, 1/2048 of the first, is not resolved: the result has not converged then.
/// \pre range.lower <= x <= range.upper. `f` is called for values within the range only, at most 25 times.
Derivative differentiate(const std::function<Sample(double)>& f, double x, const DifferenceRange& range);

}  // namespace retrace
