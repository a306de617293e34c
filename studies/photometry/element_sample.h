#pragma once

// Selects elements and wavelengths that represent all elements of a part behind a curved entrance surface, and
// estimates sums over all of them.

#include <cstddef>
#include <vector>

#include "raytrace/observers/element_light.h"

namespace retrace::studies {

/// An element and a wavelength that are traced, with the weight of its reading in the sum over all elements and
/// wavelengths.
struct SampledElement {
  std::size_t element = 0;
  std::size_t wavelength = 0;
  double weight = 0.0;
};

/// Sum over all elements and its standard error.
struct SampledSum {
  double value = 0.0;
  double std_error = 0.0;
};

/// Sample of the elements of a part and of the traced wavelengths. If there are few of them, all are selected.
///
/// Otherwise, the readings are described by polynomials of position and wavelength, which are fitted by least squares.
/// Elements near the border of the part are sampled and fitted separately. The sum of the polynomials over all elements
/// is a weighted sum of the readings. Its standard error follows from the differences between readings and polynomials.
class ElementSample {
 public:
  /// \param portions portions of all elements
  /// \param weights weights of the wavelengths
  /// \param max_count maximum number of samples, >= 16
  ElementSample(const std::vector<raytrace::ElementPortion>& portions, const std::vector<double>& weights,
                std::size_t max_count);

  const std::vector<SampledElement>& samples() const { return samples_; }
  /// Estimates the sum of portion * weight * reading over all elements and wavelengths.
  /// \param readings readings of the samples, per incident light on the portion of the element
  SampledSum sum(const std::vector<double>& readings) const;

 private:
  /// Samples of either the elements near the border or all other elements.
  struct Stratum {
    std::size_t first = 0;  ///< index of the first sample
    std::size_t count = 0;
    /// Values of the polynomials' terms at the samples, times the portion of the element divided by the largest
    /// portion; empty if all elements are selected.
    Eigen::MatrixXd powers;
    Eigen::MatrixXd inverse;    ///< pseudo-inverse of `powers`
    Eigen::VectorXd fractions;  ///< portions of the samples divided by the largest portion
    /// Variance of the sum over the single deviations of all elements from the polynomials, relative to the variance of
    /// `fractions` times a deviation.
    double deviations = 0.0;
  };
  void add_stratum(const std::vector<raytrace::ElementPortion>& portions, const std::vector<double>& weights,
                   const std::vector<std::size_t>& elements, std::size_t max_count);

  std::vector<SampledElement> samples_;
  std::vector<Stratum> strata_;
};

}  // namespace retrace::studies
