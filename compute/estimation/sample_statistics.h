#pragma once

// Statistics of samples: Sobol indices, yield and spread, with confidence intervals.

#include <cstddef>
#include <cstdint>
#include <vector>

namespace retrace::compute {

/// Estimated value with its confidence interval from `low` to `high`.
struct IntervalEstimate {
  double value = 0.0, low = 0.0, high = 0.0;
};

/// Fractions of a quantity's variance that one parameter causes.
struct SobolIndex {
  IntervalEstimate first_order;  ///< effect of the parameter without interactions
  IntervalEstimate total;        ///< effect including interactions with all other parameters
};

/// Values of a quantity at one row of sample points in the sampling scheme of Saltelli et al. (2010). The row consists
/// of two independent points A and B and, for each parameter, of a mixed point. The mixed point is equal to A, except
/// that the value of this parameter is that of B.
struct SaltelliRow {
  double a = 0.0, b = 0.0;
  std::vector<double> mixed;  ///< for each parameter: value at its mixed point
};

/// Returns the Sobol indices of the parameters. First-order indices follow Saltelli et al. (2010), and total indices
/// Jansen (1999). The confidence intervals are computed by resampling the rows (Efron's percentile bootstrap). The
/// result is empty if there are fewer than two rows, or if the quantity does not vary.
/// \param confidence probability that an interval contains the true value, in 0..1
/// \param seed seed of the resampling
/// \pre `mixed` has the same number of entries in all rows
std::vector<SobolIndex> sobol_indices(const std::vector<SaltelliRow>& rows, double confidence, std::uint32_t seed);

/// Returns the fraction of good parts with its Clopper-Pearson confidence interval (1934).
/// \param good number of good parts
/// \param parts number of all parts
/// \pre good <= parts, parts > 0
IntervalEstimate yield_of(std::size_t good, std::size_t parts, double confidence);

/// Spread (mean, deviation and extremes) of the values of a sample.
struct Spread {
  double mean = 0.0;
  IntervalEstimate mean_interval;  ///< confidence interval of the mean, from Student's t distribution
  double deviation = 0.0;          ///< standard deviation; 0 for a single value
  double min = 0.0, max = 0.0;
};
/// Returns the spread of values.
/// \param confidence probability that Spread::mean_interval contains the true mean, in 0..1
/// \pre `values` is not empty
Spread spread_of(const std::vector<double>& values, double confidence);

/// Returns a quantile of the values, with linear interpolation (type 7 of Hyndman and Fan 1996).
/// \param ascending values in ascending order
/// \param fraction fraction of the values that are below the quantile
/// \pre `ascending` is not empty, 0 <= fraction <= 1
double percentile(const std::vector<double>& ascending, double fraction);

}  // namespace retrace::compute
