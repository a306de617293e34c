#pragma once

// Height parameters of surface texture (Sa, Sq, Sz, Ssk, Sku), and mean and spread of repeated measurements.

#include <cstddef>
#include <span>
#include <vector>

namespace retrace::surface_models {

/// Height parameters of ISO 25178-2 (of ISO 21920-2 for a profile), of deviations from the mean height.
struct HeightParameters {
  double sa_nm = 0.0;  ///< arithmetical mean height
  double sq_nm = 0.0;  ///< root mean square height
  double sz_nm = 0.0;  ///< maximum height: highest minus lowest point
  double ssk = 0.0;    ///< skewness; 0 for a surface without height, as for a symmetric one
  double sku = 0.0;    ///< kurtosis; 3 for Gaussian heights, 0 for a surface without height
};

/// The parameters of the finite values of `heights_nm`. \pre there is one
HeightParameters height_parameters(std::span<const double> heights_nm);

/// The middle one of some values, of an even number the upper of two. \pre there is one
double median(std::vector<double> values);

/// Repeated measurements of one quantity.
struct Summary {
  std::size_t count = 0;
  double mean = 0.0;
  double standard_deviation = 0.0;  ///< of one measurement (n - 1); 0 for a single one
  double median = 0.0;
};

/// Summary of the finite values; all zero if there is none.
Summary summarise(std::span<const double> values);

}  // namespace retrace::surface_models
