#pragma once

// Quadratic polynomials that approximate an objective and its constraints near a point. They are fitted to observations
// with random errors. Internal to studies/optimise.

#include <cstddef>
#include <optional>
#include <vector>

#include "studies/optimise/searched_function.h"

namespace retrace::studies {

/// Box around a point, within the unit cube.
struct SearchBox {
  std::vector<double> centre;
  double radius = 0.0;  ///< half of the side length

  bool contains(const std::vector<double>& at) const;
};

/// Value of a function at a position, as input of a fit.
struct FittedValue {
  std::vector<double> at;
  Estimate estimate;
};

/// Quadratic polynomial that is fitted to values in a box by weighted least squares.
class LocalModel {
 public:
  /// Returns the number of coefficients of a quadratic polynomial.
  static std::size_t coefficients(std::size_t dimensions);
  /// Fits a polynomial. If there are not enough values for a quadratic polynomial, the polynomial is linear or
  /// constant.
  /// \param values values inside the box; at least one
  LocalModel(const SearchBox& box, const std::vector<FittedValue>& values);

  double at(const std::vector<double>& position) const;
  /// Returns the root mean square of the differences between values and model, each divided by the standard error of
  /// the value. The result is about 1 if the model is accurate. The result is infinite if there are no degrees of
  /// freedom or if a value has no error.
  double deviation() const { return deviation_; }

 private:
  std::vector<double> terms(const std::vector<double>& position, std::size_t count) const;

  SearchBox box_;
  std::vector<double> coefficients_;
  double deviation_ = 0.0;
};

/// Returns the position in the box at which `model` is largest and all models in `limits` are at most 0. Returns
/// nothing if the search finds no such position.
/// \param limits models of the amounts by which constrained quantities exceed their limits (Observation::excess)
/// \param from first position of the search
std::optional<std::vector<double>> model_maximum(const SearchBox& box, const LocalModel& model,
                                                 const std::vector<LocalModel>& limits,
                                                 const std::vector<double>& from);

}  // namespace retrace::studies
