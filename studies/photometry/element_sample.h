#pragma once

// Selects a sample of the elements of a part behind a curved entrance surface, and of the wavelengths. Estimates sums
// over all elements and wavelengths from the readings of this sample.

#include <cstddef>
#include <vector>

#include "raytrace/observers/element_light.h"

namespace retrace::studies {

/// Pair of an element and a wavelength that is traced, and the weight of its reading in the sum over all pairs.
struct SampledElement {
  std::size_t element = 0;
  std::size_t wavelength = 0;
  double weight = 0.0;
};

/// Estimated sum over all elements and wavelengths, and its standard error.
struct SampledSum {
  double value = 0.0;
  double std_error = 0.0;
};

/// Sample of the pairs of an element and a wavelength. All pairs are selected if there are few of them.
///
/// Otherwise, polynomials of position and wavelength are fitted to the readings by least squares. Elements near the
/// border of the part are sampled and fitted separately. The sum of the polynomials over all pairs is a weighted sum of
/// the readings. Its standard error is computed from the residuals of the fit.
class ElementSample {
 public:
  /// \param portions portions of light of all elements
  /// \param weights weights of the wavelengths
  /// \param max_count maximum number of samples, >= 16
  ElementSample(const std::vector<raytrace::ElementPortion>& portions, const std::vector<double>& weights,
                std::size_t max_count);

  const std::vector<SampledElement>& samples() const { return samples_; }
  /// Estimates the sum of portion * weight * reading over all elements and wavelengths.
  /// \param readings readings of the samples, divided by the incident light on the portion of the element
  SampledSum sum(const std::vector<double>& readings) const;

 private:
  /// Samples of one group of elements: either those near the border or all others.
  struct Stratum {
    std::size_t first = 0;  ///< index of the first sample
    std::size_t count = 0;
    /// Matrix of the least-squares fit, with a row for each sample and a column for each term of the polynomial. Each
    /// row is multiplied by the sample's value in `fractions`. Empty if all elements are selected.
    Eigen::MatrixXd powers;
    Eigen::MatrixXd inverse;    ///< pseudo-inverse of `powers`
    Eigen::VectorXd fractions;  ///< portions of the samples, divided by the largest portion
    /// Variance of the sum that is caused by deviations of individual elements from the polynomial, divided by the
    /// variance of a weighted residual of the fit.
    double deviations = 0.0;
  };
  void add_stratum(const std::vector<raytrace::ElementPortion>& portions, const std::vector<double>& weights,
                   const std::vector<std::size_t>& elements, std::size_t max_count);

  std::vector<SampledElement> samples_;
  std::vector<Stratum> strata_;
};

}  // namespace retrace::studies
