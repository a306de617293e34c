#include "compute/estimation/least_squares.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <random>

// Tests of least squares: comparison with the normal equations, and unknowns that the observations do not determine.

namespace retrace::compute::least_squares_test {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

MatrixXd random_matrix(Index rows, Index columns, std::uint32_t seed) {
  std::mt19937 bits(seed);
  std::normal_distribution<double> normal;
  return MatrixXd::NullaryExpr(rows, columns, [&] { return normal(bits); });
}

/// The estimate must equal the solution of the normal equations for all unknowns, including the nuisance unknowns. A
/// nuisance unknown is fitted, but its value is not returned.
TEST(Estimate, IsThatOfTheNormalEquations) {
  for (std::uint32_t seed = 1; seed <= 20; ++seed) {
    const MatrixXd a = random_matrix(12, 4, seed);
    const MatrixXd nuisance = random_matrix(12, 3, seed + 100);
    const VectorXd r = random_matrix(12, 1, seed + 200);
    MatrixXd all(12, 7);
    all << a, nuisance;
    const MatrixXd inverse = (all.transpose() * all).inverse();
    const VectorXd expected = inverse * all.transpose() * r;
    const LeastSquaresEstimate found = estimate(a, nuisance, r, 1e6);
    EXPECT_EQ(found.observable.cols(), 4);
    EXPECT_LT((found.value - expected.head(4)).norm(), 1e-10);
    EXPECT_LT((found.covariance - inverse.topLeftCorner(4, 4)).norm(), 1e-9);
    EXPECT_LT((found.residual - (r - all * expected)).norm(), 1e-10);
    const VectorXd hat = (all * inverse * all.transpose()).diagonal();
    EXPECT_LT((found.leverage - hat).norm(), 1e-10);
  }
}

/// The observations depend only on the sum of the first two unknowns. They depend on the third unknown only in
/// combination with a nuisance unknown. These three unknowns are therefore not observable.
TEST(Estimate, SaysWhatIsNotTold) {
  MatrixXd a(4, 4);
  a << 1, 1, 0, 0, 2, 2, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0;
  MatrixXd nuisance(4, 1);
  nuisance << 0, 0, 2, 2;
  const VectorXd r = a * VectorXd::LinSpaced(4, 3.0, 3.0) + 5.0 * nuisance.col(0);
  const LeastSquaresEstimate found = estimate(a, nuisance, r, 1e6);
  EXPECT_EQ(found.observable.cols(), 2);
  EXPECT_FALSE(found.is_observable(0));
  EXPECT_FALSE(found.is_observable(1));
  EXPECT_FALSE(found.is_observable(2));
  EXPECT_TRUE(found.is_observable(3));
  EXPECT_NEAR(found.value[3], 3.0, 1e-10);
  EXPECT_NEAR(found.value[0], 3.0, 1e-10) << "the shortest: shared";
  EXPECT_NEAR(found.value[2], 0.0, 1e-10);
  const MatrixXd words = reduced_combinations(found.unobservable);
  ASSERT_EQ(words.cols(), 2);
  EXPECT_LT((a * words - nuisance * (nuisance.transpose() * a * words) / 8.0).norm(), 1e-12);
  for (Index k = 0; k < 2; ++k) EXPECT_NEAR(words.col(k).cwiseAbs().maxCoeff(), 1.0, 1e-12);
}

TEST(Estimate, WhatIsTooUncertainIsNotTold) {
  const MatrixXd a = Eigen::Vector2d(1.0, 1e-3).asDiagonal();
  const LeastSquaresEstimate found = estimate(a, MatrixXd(2, 0), VectorXd::Ones(2), 500.0);
  EXPECT_TRUE(found.is_observable(0));
  EXPECT_FALSE(found.is_observable(1));
  EXPECT_EQ(found.value[1], 0.0);
}

}  // namespace
}  // namespace retrace::compute::least_squares_test
