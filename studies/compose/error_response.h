#pragma once

// How the goals of a cell respond to errors of the angles between its facets, as a polynomial of the second degree.

#include <cstddef>
#include <vector>

namespace retrace::studies {

/// Goals of a cell over errors of its angles, in minutes of arc: of a cube corner at its three dihedral edges, of a
/// prism at its apex.
class ErrorResponse {
 public:
  /// \param goals at those of errors_to_compute(), in its order
  ErrorResponse(std::size_t angles, double step_arcmin, const std::vector<std::vector<double>>& goals);

  /// The errors at which goals are needed: none, each angle by a step either way, and each two of them by a step.
  static std::vector<std::vector<double>> errors_to_compute(std::size_t angles, double step_arcmin);

  std::size_t angles() const { return slopes_.size(); }
  /// Goals at these errors.
  std::vector<double> at(const std::vector<double>& errors_arcmin) const;
  /// Change of a goal per minute of arc of one angle.
  double slope(std::size_t angle, std::size_t goal) const { return slopes_[angle][goal]; }
  /// The mean of cells each of which has errors of its own of that standard deviation besides, independent and
  /// Gaussian.
  ErrorResponse spread(double sigma_arcmin) const;

 private:
  std::vector<double> nominal_;
  std::vector<std::vector<double>> slopes_;                   ///< by angle
  std::vector<std::vector<std::vector<double>>> curvatures_;  ///< second derivatives, by two angles
};

}  // namespace retrace::studies
