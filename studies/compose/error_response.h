#pragma once

// Response of a cell's goals to errors of the angles between its facets, as a polynomial of the second degree.

#include <cstddef>
#include <vector>

namespace retrace::studies {

/// Goals of a cell as a function of errors of its angles, in minutes of arc. A cube corner has three such angles, at
/// its dihedral edges. A prism has one, at its apex.
class ErrorResponse {
 public:
  /// \param goals goals for the errors of errors_to_compute(), in the same order
  ErrorResponse(std::size_t angles, double step_arcmin, const std::vector<std::vector<double>>& goals);

  /// Returns the sets of errors for which goals are needed: no error, plus and minus one step for each angle, and plus
  /// one step for both angles of each pair.
  static std::vector<std::vector<double>> errors_to_compute(std::size_t angles, double step_arcmin);

  std::size_t angles() const { return slopes_.size(); }
  /// Returns the goals for given errors.
  std::vector<double> at(const std::vector<double>& errors_arcmin) const;
  /// Returns the derivative of a goal with respect to the error of an angle, per minute of arc.
  double slope(std::size_t angle, std::size_t goal) const { return slopes_[angle][goal]; }
  /// Returns the mean response of many cells that have additional random errors. These errors are independent and
  /// Gaussian with the given standard deviation.
  ErrorResponse spread(double sigma_arcmin) const;

 private:
  std::vector<double> nominal_;
  std::vector<std::vector<double>> slopes_;                   ///< first derivatives, indexed by angle and goal
  std::vector<std::vector<std::vector<double>>> curvatures_;  ///< second derivatives, indexed by two angles and by goal
};

}  // namespace retrace::studies
