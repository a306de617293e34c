#pragma once

// Statistics of tolerance studies: Sobol indices, yield and spread, with confidence intervals.

#include <cstddef>
#include <cstdint>
#include <vector>

namespace retrace::studies {

/// An estimate with a confidence interval.
struct Estimate {
  double value = 0.0, low = 0.0, high = 0.0;
};

/// Shares of the variance of a quantity that one parameter causes.
struct SobolIndex {
  Estimate first_order;  ///< by itself
  Estimate total;        ///< together with all others
};

/// A quantity at one row of the design of Saltelli et al. (2010): at two independent points A and B, and at A with one
/// coordinate after the other from B.
struct SaltelliRow {
  double a = 0.0, b = 0.0;
  std::vector<double> mixed;  ///< by parameter
};

/// Indices of the parameters, first order by Saltelli et al. (2010), total by Jansen (1999), with intervals that
/// resample the rows (Efron's percentile bootstrap). Empty if there are fewer than two rows or nothing varies.
/// \param confidence share of intervals that hold the true value, in 0..1 \param seed of the resampling
/// \pre all rows have as many entries in `mixed`
std::vector<SobolIndex> sobol_indices(const std::vector<SaltelliRow>& rows, double confidence, std::uint32_t seed);

/// The share of parts that are good, of which `good` of `parts` were, with the interval of Clopper and Pearson (1934).
/// \pre good <= parts, parts > 0
Estimate yield_of(std::size_t good, std::size_t parts, double confidence);

/// How values are spread.
struct Spread {
  double mean = 0.0;
  Estimate mean_interval;  ///< of the mean, by Student's t
  double deviation = 0.0;  ///< standard deviation; 0 for a single value
  double least = 0.0, most = 0.0;
};
/// \pre values is not empty
Spread spread_of(const std::vector<double>& values, double confidence);

/// The value below which a share of the values lies, between neighbours in proportion (type 7 of Hyndman and Fan 1996).
/// \pre values is ascending and not empty, 0 <= share <= 1
double percentile(const std::vector<double>& ascending, double share);

}  // namespace retrace::studies
