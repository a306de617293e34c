#pragma once

// Weighted linear least squares for observations that may not determine all unknowns.

#include <Eigen/Core>

namespace retrace::compute {

/// Result of a least-squares estimate. Let A be the derivatives and r the observations, both divided by the standard
/// uncertainties of the observations. The estimate is the shortest x that minimizes |r - A x|, where nuisance unknowns
/// may have any value. A combination of unknowns is observable if the observations determine it.
struct LeastSquaresEstimate {
  Eigen::VectorXd value;       ///< estimated values of the unknowns
  Eigen::MatrixXd covariance;  ///< covariance matrix of the observable part of the unknowns
  Eigen::MatrixXd told;        ///< observable combinations as orthonormal columns; `value` is a combination of them
  Eigen::MatrixXd untold;      ///< unobservable combinations as orthonormal columns
  Eigen::VectorXd residual;    ///< residuals of the observations, in their standard uncertainties
  /// Leverages of the observations: derivative of the fitted value of an observation with respect to the observed
  /// value. If it is 1, no other observation checks the observation.
  Eigen::VectorXd leverage;

  /// Returns true if the observations determine an unknown, independently of all other unknowns.
  bool is_told(Eigen::Index unknown) const;
};

/// Computes the estimate.
/// \param most_uncertain standard uncertainty above which a combination of length 1 counts as unobservable
/// \pre all three matrices have the same number of rows; most_uncertain > 0
LeastSquaresEstimate estimate(const Eigen::MatrixXd& derivatives, const Eigen::MatrixXd& of_nuisance,
                              const Eigen::VectorXd& observations, double most_uncertain);

/// Returns combinations that span the same space as the given ones, in a form that is easy to read. Each column has an
/// element 1 where all other columns have 0. Small elements are set to 0.
Eigen::MatrixXd reduced_combinations(const Eigen::MatrixXd& untold);

}  // namespace retrace::compute
