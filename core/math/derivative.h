#pragma once

// Numerical derivatives with an error estimate, for functions whose values contain noise, such as ray-traced
// efficiencies.

#include <cmath>
#include <functional>
#include <limits>

namespace retrace {

/// Value of a function with a bound on its error, such as the error of neglecting small terms.
struct Sample {
  double value = 0.0;
  double noise = 0.0;  ///< bound on the part of the error that is independent of errors at neighbouring arguments; >= 0
};

/// Range in which a function may be evaluated to compute its derivative, in units of its argument.
struct DifferenceRange {
  double first_step = 0.0;  ///< distance over which the function is expected to be smooth; > 0
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
};

struct Derivative {
  double value = 0.0;
  double error = std::numeric_limits<double>::infinity();  ///< estimated bound on the error, including `noise`
  double noise = 0.0;                                      ///< part of `error` due to the noise of the samples

  bool converged() const { return error <= 1e-3 * std::abs(value) + 1e-6; }
};

/// Computes the derivative of `f` at `x` by central differences. The steps are halved, beginning with
/// `range.first_step`, and the differences are extrapolated to step 0 in a Neville tableau. The error is estimated by
/// comparing entries of the tableau (Ridders, Adv. Eng. Software 4, 75, 1982). One-sided differences on both sides of x
/// are extrapolated as well. If the left and the right slope differ by more than their errors, `f` has a kink at x, and
/// half of the difference is reported as the error. If `range` has too little room on one side of x, only the
/// differences on the other side are used.
///
/// A kink or jump that is closer to x than the smallest step, 1/2048 of the first, is not resolved. The result has not
/// converged in that case.
/// \pre range.lower <= x <= range.upper
/// \pre `f` can be called for all values within the range; it is called at most 25 times
Derivative differentiate(const std::function<Sample(double)>& f, double x, const DifferenceRange& range);

}  // namespace retrace
