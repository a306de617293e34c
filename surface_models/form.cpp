#include "surface_models/form.h"

#include <Eigen/Dense>
#include <cmath>

#include "core/length_units.h"

namespace retrace::surface_models {
namespace {

/// Returns the Legendre polynomials P_0..P_degree at `count` points of an axis that is scaled to -1..1. They are nearly
/// orthogonal on the grid, so that the normal equations stay accurate.
Eigen::MatrixXd legendre(std::size_t count, int degree) {
  Eigen::MatrixXd p(static_cast<Eigen::Index>(count), degree + 1);
  for (Eigen::Index i = 0; i < p.rows(); ++i) {
    const double t = count > 1 ? 2.0 * static_cast<double>(i) / static_cast<double>(count - 1) - 1.0 : 0.0;
    p(i, 0) = 1.0;
    if (degree > 0) p(i, 1) = t;
    for (int n = 2; n <= degree; ++n) p(i, n) = ((2.0 * n - 1.0) * t * p(i, n - 1) - (n - 1.0) * p(i, n - 2)) / n;
  }
  return p;
}

/// Products P_a(x) P_b(y) with a + b <= degree over the grid.
class Basis {
 public:
  Basis(const HeightMap& map, int degree)
      : x_(legendre(map.columns, degree)), y_(legendre(map.rows, map.is_profile() ? 0 : degree)) {
    for (int b = 0; b < y_.cols(); ++b)
      for (int a = 0; a + b <= degree; ++a) powers_.push_back({a, b});
  }

  const std::vector<std::pair<int, int>>& powers() const { return powers_; }
  Eigen::Index size() const { return static_cast<Eigen::Index>(powers_.size()); }

  void at(std::size_t column, std::size_t row, Eigen::VectorXd& values) const {
    const auto i = static_cast<Eigen::Index>(column);
    const auto j = static_cast<Eigen::Index>(row);
    for (std::size_t k = 0; k < powers_.size(); ++k)
      values[static_cast<Eigen::Index>(k)] = x_(i, powers_[k].first) * y_(j, powers_[k].second);
  }

 private:
  Eigen::MatrixXd x_;
  Eigen::MatrixXd y_;
  std::vector<std::pair<int, int>> powers_;
};

Eigen::VectorXd fitted_coefficients(const HeightMap& map, const Basis& basis) {
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(basis.size(), basis.size());
  Eigen::VectorXd right = Eigen::VectorXd::Zero(basis.size());
  Eigen::VectorXd values(basis.size());
  for (std::size_t row = 0; row < map.rows; ++row)
    for (std::size_t column = 0; column < map.columns; ++column) {
      const double z = map.at(column, row);
      if (!std::isfinite(z)) continue;
      basis.at(column, row, values);
      normal.selfadjointView<Eigen::Lower>().rankUpdate(values);
      right += z * values;
    }
  const Eigen::MatrixXd full = normal.selfadjointView<Eigen::Lower>();
  return full.completeOrthogonalDecomposition().solve(right);
}

/// Returns the coefficients of the powers of x in P_0..P_degree, one polynomial per row.
Eigen::MatrixXd legendre_powers(int degree) {
  Eigen::MatrixXd p = Eigen::MatrixXd::Zero(degree + 1, degree + 1);
  p(0, 0) = 1.0;
  if (degree > 0) p(1, 1) = 1.0;
  for (int n = 2; n <= degree; ++n) {
    p.row(n) = -(n - 1.0) / n * p.row(n - 2);
    p.row(n).tail(degree) += (2.0 * n - 1.0) / n * p.row(n - 1).head(degree);
  }
  return p;
}

}  // namespace

FacetForm fitted_form(const HeightMap& map, int degree) {
  const Basis basis(map, degree);
  const Eigen::VectorXd coefficients = kMmPerNm * fitted_coefficients(map, basis);
  const Eigen::MatrixXd powers = legendre_powers(degree);
  const double half_x_mm = 0.5 * kMmPerUm * map.x_pixel_um * static_cast<double>(map.columns - 1);
  const double half_y_mm = 0.5 * kMmPerUm * map.y_pixel_um * static_cast<double>(map.rows - 1);
  FacetForm form;
  for (Eigen::Index k = 0; k < basis.size(); ++k) {
    const auto [a, b] = basis.powers()[static_cast<std::size_t>(k)];
    for (int i = 0; i <= a; ++i)
      for (int j = 0; j <= b; ++j)
        form.add(i, j, coefficients[k] * powers(a, i) * powers(b, j) / std::pow(half_x_mm, i) / std::pow(half_y_mm, j));
  }
  return form;
}

HeightMap without_form(const HeightMap& map, int degree) {
  const Basis basis(map, degree);
  const Eigen::VectorXd coefficients = fitted_coefficients(map, basis);
  HeightMap residual = map;
  Eigen::VectorXd values(basis.size());
  for (std::size_t row = 0; row < map.rows; ++row)
    for (std::size_t column = 0; column < map.columns; ++column) {
      basis.at(column, row, values);
      residual.at(column, row) -= coefficients.dot(values);
    }
  return residual;
}

}  // namespace retrace::surface_models
