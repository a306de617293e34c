#pragma once

// Computes the height parameters of a surface texture (Sa, Sq, Sz, Ssk, Sku), and the mean and standard deviation of
// repeated measurements.

#include <cstddef>
#include <span>
#include <vector>

namespace retrace::surface_models {

/// Height parameters of ISO 25178-2 (ISO 21920-2 for a profile), computed from deviations from the mean height.
struct HeightParameters {
  double sa_nm = 0.0;  ///< arithmetical mean height
  double sq_nm = 0.0;  ///< root mean square height
  double sz_nm = 0.0;  ///< maximum height: highest minus lowest point
  double ssk = 0.0;    ///< skewness; 0 for a symmetric surface and for a flat surface
  double sku = 0.0;    ///< kurtosis; 3 for Gaussian heights, 0 for a flat surface
};

/// Returns the parameters of the finite values in `heights_nm`.
/// \pre there is at least one finite value
HeightParameters height_parameters(std::span<const double> heights_nm);

/// Returns the median. For an even number of values, the larger of the two central values is returned.
/// \pre there is at least one value
double median(std::vector<double> values);

/// Statistics of repeated measurements of one quantity.
struct Summary {
  std::size_t count = 0;
  double mean = 0.0;
  /// standard deviation of a single measurement, with the divisor n - 1; 0 if there is only one measurement
  double standard_deviation = 0.0;
  double median = 0.0;
};

/// Returns the statistics of the finite values. All members are 0 if there are no finite values.
Summary summarise(std::span<const double> values);

}  // namespace retrace::surface_models
