#pragma once

// Weighted linear least squares for observations that may not determine all unknowns.

#include <Eigen/Core>

namespace retrace::compute {

/// Result of a least-squares estimate. Let r be the observations. Let A be their derivatives with respect to the
/// unknowns x, and B their derivatives with respect to the nuisance unknowns y. r, A and B are divided by the standard
/// uncertainties of the observations. The estimate is the x of minimum norm for which |r - A x - B y| is minimal over x
/// and y. A linear combination of unknowns is observable if the observations determine it with a sufficiently small
/// uncertainty.
struct LeastSquaresEstimate {
  Eigen::VectorXd value;         ///< estimated values of the unknowns
  Eigen::MatrixXd covariance;    ///< covariance matrix of the observable part of the unknowns
  Eigen::MatrixXd observable;    ///< observable combinations as orthonormal columns; `value` is a combination of them
  Eigen::MatrixXd unobservable;  ///< unobservable combinations as orthonormal columns
  Eigen::VectorXd residual;      ///< residuals of the observations, divided by their standard uncertainties
  /// Leverages of the observations: derivative of the fitted value of an observation with respect to the observed
  /// value. If the leverage is 1, no other observation checks this observation.
  Eigen::VectorXd leverage;

  /// Returns true if the observations determine an unknown, independently of all other unknowns.
  bool is_observable(Eigen::Index unknown) const;
};

/// Computes the estimate. The vector and both matrices are divided by the standard uncertainties of the observations.
/// \param nuisance_derivatives derivatives with respect to the nuisance unknowns; no columns if there are none
/// \param max_uncertainty standard uncertainty above which a combination with norm 1 counts as unobservable
/// \pre `derivatives`, `nuisance_derivatives` and `observations` have the same number of rows; max_uncertainty > 0
LeastSquaresEstimate estimate(const Eigen::MatrixXd& derivatives, const Eigen::MatrixXd& nuisance_derivatives,
                              const Eigen::VectorXd& observations, double max_uncertainty);

/// Returns combinations that span the same space as the given ones, in a form that is easy to read. Each column has a
/// pivot element 1, in a row where all other columns are 0. Small elements are set to 0.
Eigen::MatrixXd reduced_combinations(const Eigen::MatrixXd& combinations);

}  // namespace retrace::compute
