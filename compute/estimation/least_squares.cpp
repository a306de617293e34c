#include "compute/estimation/least_squares.h"

#include <Eigen/QR>
#include <Eigen/SVD>
#include <cmath>

namespace retrace::compute {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

/// An unknown counts as observable if the norm of its components in the unobservable combinations is below this value.
constexpr double kMaxUnobservableNorm = 1e-3;
/// Absolute value below which a component of a reduced combination is set to 0. The pivot component of each combination
/// is 1.
constexpr double kMinShownComponent = 0.02;

/// Returns orthonormal columns that span the column space of a matrix.
MatrixXd span_of(const MatrixXd& columns) {
  if (columns.cols() == 0 || columns.isZero(0.0)) return MatrixXd(columns.rows(), 0);
  const Eigen::ColPivHouseholderQR<MatrixXd> qr(columns);
  return MatrixXd(qr.householderQ() * MatrixXd::Identity(columns.rows(), qr.rank()));
}

}  // namespace

bool LeastSquaresEstimate::is_observable(Index unknown) const {
  return unobservable.cols() == 0 || unobservable.row(unknown).norm() < kMaxUnobservableNorm;
}

LeastSquaresEstimate estimate(const MatrixXd& derivatives, const MatrixXd& nuisance_derivatives,
                              const VectorXd& observations, double max_uncertainty) {
  const MatrixXd nuisance = span_of(nuisance_derivatives);
  const MatrixXd a = derivatives - nuisance * (nuisance.transpose() * derivatives);
  const VectorXd r = observations - nuisance * (nuisance.transpose() * observations);
  const Eigen::JacobiSVD<MatrixXd> svd(a, Eigen::ComputeThinU | Eigen::ComputeFullV);
  Index told = 0;
  while (told < svd.singularValues().size() && svd.singularValues()[told] * max_uncertainty > 1.0) ++told;
  const MatrixXd u = svd.matrixU().leftCols(told);
  const VectorXd deviation = svd.singularValues().head(told).cwiseInverse();
  LeastSquaresEstimate result;
  result.observable = svd.matrixV().leftCols(told);
  result.unobservable = svd.matrixV().rightCols(svd.matrixV().cols() - told);
  result.value = result.observable * deviation.asDiagonal() * (u.transpose() * r);
  result.covariance = result.observable * deviation.cwiseAbs2().asDiagonal() * result.observable.transpose();
  result.residual = r - a * result.value;
  result.leverage = nuisance.rowwise().squaredNorm() + u.rowwise().squaredNorm();
  return result;
}

MatrixXd reduced_combinations(const MatrixXd& combinations) {
  MatrixXd rows = combinations.transpose();
  // Gauss-Jordan elimination with full pivoting.
  for (Index k = 0; k < rows.rows(); ++k) {
    Index row = 0;
    Index column = 0;
    rows.bottomRows(rows.rows() - k).cwiseAbs().maxCoeff(&row, &column);
    rows.row(k).swap(rows.row(k + row));
    rows.row(k) /= rows(k, column);
    for (Index other = 0; other < rows.rows(); ++other)
      if (other != k) rows.row(other) -= rows(other, column) * rows.row(k);
  }
  return rows.unaryExpr([](double share) { return std::abs(share) < kMinShownComponent ? 0.0 : share; }).transpose();
}

}  // namespace retrace::compute
