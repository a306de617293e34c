#pragma once

// Quadratic models of an objective and its limits near a point, fitted to observations with random errors. Internal to
// studies/optimise.

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

/// Value at a position, as input of a fit.
struct FittedValue {
  std::vector<double> at;
  Estimate estimate;
};

/// Quadratic polynomial that is fitted to values in a box by weighted least squares.
class LocalModel {
 public:
  /// Returns the number of coefficients of a quadratic polynomial.
  static std::size_t coefficients(std::size_t dimensions);
  /// Fits a polynomial. It is linear, or only a constant, if there are not enough values for more coefficients.
  /// \param values values inside the box; at least one
  LocalModel(const SearchBox& box, const std::vector<FittedValue>& values);

  double at(const std::vector<double>& position) const;
  /// Returns the standard deviation of the fitted values from the model, in standard errors of these values. It is
  /// about 1 if the model is accurate. It is infinite without degrees of freedom, or if a value has no error.
  double deviation() const { return deviation_; }

 private:
  std::vector<double> terms(const std::vector<double>& position, std::size_t count) const;

  SearchBox box_;
  std::vector<double> coefficients_;
  double deviation_ = 0.0;
};

/// Returns the position in the box at which a model is largest and all limits are at most 0. Returns nothing if the
/// search finds no such position.
/// \param limits models of the limits
/// \param from first position of the search
std::optional<std::vector<double>> model_maximum(const SearchBox& box, const LocalModel& model,
                                                 const std::vector<LocalModel>& limits,
                                                 const std::vector<double>& from);

}  // namespace retrace::studies
