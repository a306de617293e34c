// Tests of distributions and intervals of parameters.
#include <gtest/gtest.h>

#include <cmath>

#include "studies/quantity/study.h"

namespace retrace::studies::distribution_test {
namespace {

TEST(Distribution, QuantilesOfKnownDistributions) {
  Distribution normal{Distribution::Kind::normal, 10.0, 2.0, {}};
  EXPECT_NEAR(normal.quantile(0.5), 10.0, 1e-12);
  EXPECT_NEAR(normal.quantile(0.975), 10.0 + 2.0 * 1.959963984540054, 1e-9);
  normal.range = Interval{9.0, 11.0, false};
  EXPECT_NEAR(normal.quantile(0.5), 10.0, 1e-12);
  EXPECT_NEAR(normal.quantile(1e-12), 9.0, 1e-6);
  const Distribution uniform{Distribution::Kind::uniform, 0.0, 0.0, Interval{-1.0, 3.0, false}};
  EXPECT_DOUBLE_EQ(uniform.quantile(0.25), 0.0);
  const Distribution triangular{Distribution::Kind::triangular, 1.0, 0.0, Interval{0.0, 4.0, false}};
  EXPECT_DOUBLE_EQ(triangular.quantile(0.25), 1.0);
  EXPECT_NEAR(triangular.quantile(0.5), 4.0 - std::sqrt(0.5 * 4.0 * 3.0), 1e-12);
}

TEST(Interval, LogarithmicStepsAreEqualRatios) {
  const Interval interval{0.1, 10.0, true};
  EXPECT_NEAR(interval.at(0.5), 1.0, 1e-12);
  EXPECT_EQ(interval.at(0.0), 0.1);
  EXPECT_EQ(interval.at(1.0), 10.0);
}

}  // namespace
}  // namespace retrace::studies::distribution_test
