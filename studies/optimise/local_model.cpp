#include "studies/optimise/local_model.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <new>
#include <nlopt.hpp>

namespace retrace::studies {
namespace {

constexpr double kRidge = 1e-10;
constexpr int kMaxModelEvaluations = 400;
constexpr double kModelStep = 1e-6;

/// Polynomial and box of a function that NLopt maximizes or constrains. NLopt passes a pointer to this data to the
/// function.
struct ModelOfBox {
  const LocalModel* model = nullptr;
};

double value_of_model(const std::vector<double>& position, std::vector<double>&, void* data) {
  return static_cast<const ModelOfBox*>(data)->model->at(position);
}

}  // namespace

bool SearchBox::contains(const std::vector<double>& at) const {
  constexpr double rounding = 1e-12;
  for (std::size_t k = 0; k < centre.size(); ++k)
    if (std::abs(at[k] - centre[k]) > radius + rounding) return false;
  return true;
}

std::size_t LocalModel::coefficients(std::size_t dimensions) {
  return (dimensions + 1) * (dimensions + 2) / 2;
}

std::vector<double> LocalModel::terms(const std::vector<double>& position, std::size_t count) const {
  const std::size_t dimensions = box_.centre.size();
  std::vector<double> u(dimensions);
  for (std::size_t k = 0; k < dimensions; ++k) u[k] = (position[k] - box_.centre[k]) / box_.radius;
  std::vector<double> terms = {1.0};
  if (count > 1) terms.insert(terms.end(), u.begin(), u.end());
  if (count > dimensions + 1)
    for (std::size_t i = 0; i < dimensions; ++i)
      for (std::size_t k = i; k < dimensions; ++k) terms.push_back(u[i] * u[k]);
  return terms;
}

LocalModel::LocalModel(const SearchBox& box, const std::vector<FittedValue>& values) : box_(box) {
  const std::size_t dimensions = box.centre.size();
  std::size_t count = coefficients(dimensions);
  if (values.size() < count) count = dimensions + 1;
  if (values.size() < count) count = 1;
  // Values without error estimates have equal weights. The weight of a very accurate value is limited, because the
  // polynomial itself deviates from the function.
  double max_error = 0.0;
  for (const FittedValue& value : values) max_error = std::max(max_error, value.estimate.std_error);
  const double floor = max_error > 0.0 ? 0.1 * max_error : 1.0;
  const auto rows = static_cast<Eigen::Index>(values.size());
  const auto columns = static_cast<Eigen::Index>(count);
  Eigen::MatrixXd matrix(rows, columns);
  Eigen::VectorXd target(rows);
  for (Eigen::Index row = 0; row < rows; ++row) {
    const FittedValue& value = values[static_cast<std::size_t>(row)];
    const double weight = floor / std::hypot(floor, value.estimate.std_error);
    const std::vector<double> of = terms(value.at, count);
    for (Eigen::Index column = 0; column < columns; ++column)
      matrix(row, column) = weight * of[static_cast<std::size_t>(column)];
    target(row) = weight * value.estimate.value;
  }
  const Eigen::MatrixXd normal = matrix.transpose() * matrix + kRidge * Eigen::MatrixXd::Identity(columns, columns);
  const Eigen::VectorXd solution = normal.ldlt().solve(matrix.transpose() * target);
  coefficients_.assign(solution.data(), solution.data() + solution.size());
  double squares = 0.0;
  for (const FittedValue& value : values)
    squares += std::pow((value.estimate.value - at(value.at)) / value.estimate.std_error, 2);
  deviation_ = values.size() > count && std::isfinite(squares)
                   ? std::sqrt(squares / static_cast<double>(values.size() - count))
                   : std::numeric_limits<double>::infinity();
}

double LocalModel::at(const std::vector<double>& position) const {
  const std::vector<double> of = terms(position, coefficients_.size());
  double sum = 0.0;
  for (std::size_t k = 0; k < of.size(); ++k) sum += coefficients_[k] * of[k];
  return sum;
}

std::optional<std::vector<double>> model_maximum(const SearchBox& box, const LocalModel& model,
                                                 const std::vector<LocalModel>& limits,
                                                 const std::vector<double>& from) {
  const std::size_t dimensions = box.centre.size();
  std::vector<double> lower(dimensions);
  std::vector<double> upper(dimensions);
  for (std::size_t k = 0; k < dimensions; ++k) {
    lower[k] = std::max(0.0, box.centre[k] - box.radius);
    upper[k] = std::min(1.0, box.centre[k] + box.radius);
  }
  ModelOfBox objective{&model};
  std::vector<ModelOfBox> bounds;
  for (const LocalModel& limit : limits) bounds.push_back({&limit});
  std::optional<std::vector<double>> best;
  double best_value = -std::numeric_limits<double>::infinity();
  const auto look_from = [&](std::vector<double> position) {
    for (std::size_t k = 0; k < dimensions; ++k) position[k] = std::clamp(position[k], lower[k], upper[k]);
    nlopt::opt optimiser(nlopt::LN_COBYLA, static_cast<unsigned>(dimensions));
    optimiser.set_lower_bounds(lower);
    optimiser.set_upper_bounds(upper);
    optimiser.set_max_objective(value_of_model, &objective);
    for (ModelOfBox& bound : bounds) optimiser.add_inequality_constraint(value_of_model, &bound, 0.0);
    optimiser.set_maxeval(kMaxModelEvaluations);
    optimiser.set_xtol_abs(kModelStep * box.radius);
    optimiser.set_initial_step(0.5 * box.radius);
    double value = 0.0;
    try {
      optimiser.optimize(position, value);
    } catch (const std::bad_alloc&) {
      throw;
    } catch (const std::exception&) {
      // NLopt throws this exception if rounding errors prevent progress. The last position of the search is then used.
    }
    for (std::size_t k = 0; k < dimensions; ++k) position[k] = std::clamp(position[k], lower[k], upper[k]);
    for (const LocalModel& limit : limits)
      if (limit.at(position) > 1e-9) return;
    if (model.at(position) <= best_value) return;
    best_value = model.at(position);
    best = position;
  };
  look_from(from);
  look_from(box.centre);
  // A quadratic polynomial can have several maxima on the border of the box. The search therefore starts from several
  // positions.
  for (std::size_t k = 0; k < dimensions; ++k)
    for (const double end : {lower[k], upper[k]}) {
      std::vector<double> position = box.centre;
      position[k] = end;
      look_from(position);
    }
  return best;
}

}  // namespace retrace::studies
