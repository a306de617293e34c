#pragma once

// Quadratic polynomials that approximate an objective and its constraints near a point. They are fitted to observations
// with random errors. Internal to studies/optimise.

#include <cstddef>
#include <optional>
#include <vector>

#include "studies/optimise/searched_function.h"

namespace retrace::studies {

/// Cube around a point, clipped to the unit cube. Each coordinate is the position of a parameter in its interval.
struct SearchBox {
  std::vector<double> centre;
  double radius = 0.0;  ///< half of the edge length

  bool contains(const std::vector<double>& at) const;
};

/// Value of a function at one position, used as data of a fit.
struct FittedValue {
  std::vector<double> at;
  Estimate estimate;
};

/// Quadratic polynomial, fitted to the values inside a box by weighted least squares.
class LocalModel {
 public:
  /// Returns the number of coefficients of a quadratic polynomial with the given number of variables.
  static std::size_t coefficients(std::size_t dimensions);
  /// Fits a polynomial. With too few values for a quadratic polynomial, the polynomial is linear or constant.
  /// \param values values inside the box; at least one
  LocalModel(const SearchBox& box, const std::vector<FittedValue>& values);

  double at(const std::vector<double>& position) const;
  /// Returns the root mean square of the residuals, each divided by the standard error of the fitted value. An accurate
  /// model has a deviation of about 1. The deviation is infinite if there are no degrees of freedom or if a value has
  /// no error.
  double deviation() const { return deviation_; }

 private:
  std::vector<double> terms(const std::vector<double>& position, std::size_t count) const;

  SearchBox box_;
  std::vector<double> coefficients_;
  double deviation_ = 0.0;
};

/// Returns the position in the box at which `model` is largest and every model in `limits` is at most 0. Returns
/// nothing if no such position is found.
/// \param limits models of the excess over each limit (Observation::excess)
/// \param from position at which the search starts
std::optional<std::vector<double>> model_maximum(const SearchBox& box, const LocalModel& model,
                                                 const std::vector<LocalModel>& limits,
                                                 const std::vector<double>& from);

}  // namespace retrace::studies
