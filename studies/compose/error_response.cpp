#include "studies/compose/error_response.h"

#include <initializer_list>
#include <utility>

namespace retrace::studies {

std::vector<std::vector<double>> ErrorResponse::errors_to_compute(std::size_t angles, double step_arcmin) {
  std::vector<std::vector<double>> errors = {std::vector<double>(angles, 0.0)};
  const auto add = [&](std::initializer_list<std::pair<std::size_t, double>> steps) {
    std::vector<double> at(angles, 0.0);
    for (const auto& [angle, sign] : steps) at[angle] += sign * step_arcmin;
    errors.push_back(at);
  };
  for (std::size_t k = 0; k < angles; ++k) {
    add({{k, 1.0}});
    add({{k, -1.0}});
  }
  for (std::size_t k = 0; k < angles; ++k)
    for (std::size_t j = 0; j < k; ++j) add({{j, 1.0}, {k, 1.0}});
  return errors;
}

ErrorResponse::ErrorResponse(std::size_t angles, double step, const std::vector<std::vector<double>>& goals)
    : nominal_(goals[0]), slopes_(angles, std::vector<double>(goals[0].size())), curvatures_(angles, slopes_) {
  for (std::size_t k = 0; k < angles; ++k) {
    const std::vector<double>& up = goals[1 + 2 * k];
    const std::vector<double>& down = goals[2 + 2 * k];
    for (std::size_t g = 0; g < nominal_.size(); ++g) {
      slopes_[k][g] = (up[g] - down[g]) / (2.0 * step);
      curvatures_[k][k][g] = (up[g] - 2.0 * nominal_[g] + down[g]) / (step * step);
    }
  }
  std::size_t mixed = 1 + 2 * angles;
  for (std::size_t k = 0; k < angles; ++k)
    for (std::size_t j = 0; j < k; ++j, ++mixed)
      for (std::size_t g = 0; g < nominal_.size(); ++g) {
        const double without = nominal_[g] + step * (slopes_[j][g] + slopes_[k][g]) +
                               0.5 * step * step * (curvatures_[j][j][g] + curvatures_[k][k][g]);
        curvatures_[j][k][g] = curvatures_[k][j][g] = (goals[mixed][g] - without) / (step * step);
      }
}

std::vector<double> ErrorResponse::at(const std::vector<double>& errors) const {
  std::vector<double> goals = nominal_;
  for (std::size_t k = 0; k < angles(); ++k)
    for (std::size_t g = 0; g < goals.size(); ++g) {
      double slope = slopes_[k][g];
      for (std::size_t j = 0; j < angles(); ++j) slope += 0.5 * curvatures_[k][j][g] * errors[j];
      goals[g] += errors[k] * slope;
    }
  return goals;
}

/// Independent random errors change the mean of a quadratic polynomial by half the variance times the sum of the
/// curvatures.
ErrorResponse ErrorResponse::spread(double sigma_arcmin) const {
  ErrorResponse mean = *this;
  for (std::size_t k = 0; k < angles(); ++k)
    for (std::size_t g = 0; g < nominal_.size(); ++g)
      mean.nominal_[g] += 0.5 * sigma_arcmin * sigma_arcmin * curvatures_[k][k][g];
  return mean;
}

}  // namespace retrace::studies
