#pragma once

// Weighted linear least squares where observations may not tell all unknowns apart.

#include <Eigen/Core>

namespace retrace::studies {

/// What observations say of unknowns. With A the derivatives and r the observations, both divided by the observations'
/// standard uncertainties: the shortest x that makes |r - A x| least, nuisance unknowns free.
struct Estimate {
  Eigen::VectorXd value;       ///< of the unknowns
  Eigen::MatrixXd covariance;  ///< of what is told of them
  Eigen::MatrixXd told;        ///< columns, orthonormal: combinations that are told, x is one of them
  Eigen::MatrixXd untold;      ///< all others, likewise
  Eigen::VectorXd residual;    ///< of the observations, in their standard uncertainties
  /// Of the observations: the share of one that the unknowns take up. 1: nothing checks it.
  Eigen::VectorXd leverage;

  /// Whether the observations tell an unknown whatever the others are.
  bool is_told(Eigen::Index unknown) const;
};

/// A combination of length 1 counts as untold if its standard uncertainty is above `most_uncertain`.
/// \pre rows of all three are as many; most_uncertain > 0
Estimate estimate(const Eigen::MatrixXd& derivatives, const Eigen::MatrixXd& of_nuisance,
                  const Eigen::VectorXd& observations, double most_uncertain);

/// The same combinations in words that people read: each column has a 1 where the others have 0, and small shares are
/// 0.
Eigen::MatrixXd reduced_combinations(const Eigen::MatrixXd& untold);

}  // namespace retrace::studies
