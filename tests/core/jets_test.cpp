#include "core/math/jets.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/math/partials.h"

// Tests of automatic differentiation: the results are compared with identities and with each other.

namespace retrace::jets::jets_test {
namespace {

Series<double> line(double x, double slope, int order = kMaxOrder) {
  return line_series(x, slope, order);
}

void expect_series(const Series<double>& a, const Series<double>& b, double tolerance) {
  ASSERT_EQ(a.order, b.order);
  for (int k = 0; k <= a.order; ++k) EXPECT_NEAR(a[k], b[k], tolerance * (1.0 + std::abs(b[k]))) << "order " << k;
}

TEST(Jet, IdentitiesHoldToEveryOrder) {
  const Series<double> x = line(1.7, 0.6) + line(0.0, 1.0) * line(0.2, -0.4);
  expect_series(sin(x) * sin(x) + cos(x) * cos(x), constant_like(x, 1.0), 1e-14);
  expect_series(exp(log(x)), x, 1e-13);
  expect_series(sqrt(x) * sqrt(x), x, 1e-14);
  expect_series((x * x) / x, x, 1e-14);
  expect_series(atan2(sin(x), cos(x)), x, 1e-13);
  expect_series(power(x, 5), x * x * x * x * x, 1e-13);
}

TEST(Jet, ExponentialHasInverseFactorials) {
  const Series<double> e = exp(line(0.0, 1.0));
  double factorial = 1.0;
  for (int k = 0; k <= kMaxOrder; ++k) {
    if (k > 0) factorial *= k;
    EXPECT_NEAR(e[k], 1.0 / factorial, 1e-16);
  }
}

/// Returns an expression that contains the elementary operations of formulas.
template <class T>
T mixture(const T& x, const T& y) {
  return atan2(y * x, exp(x) + y) / sqrt(2.0 + x * x) - log(y + 3.0) * sin(x * 0.5) + cos(1.0 - y) * (x - 2.0) / 3.0;
}

TEST(Jet, ShortSeriesAreTheStartOfLongOnes) {
  const Series<double> whole = mixture(line(0.7, 0.6, 4), line(-0.2, 1.1, 4));
  const Jet2 second = mixture(Jet2(0.7, 0.6, 0.0), Jet2(-0.2, 1.1, 0.0));
  EXPECT_NEAR(second[0], whole[0], 1e-15);
  EXPECT_NEAR(second[1], whole[1], 1e-15);
  EXPECT_NEAR(second[2], whole[2], 1e-14);
  const Partials<2> partials = mixture(Partials<2>{0.7, 1.0}, Partials<2>{-0.2, 0.0, 1.0});
  EXPECT_NEAR(partials.value, whole[0], 1e-15);
  EXPECT_NEAR(0.6 * partials.x + 1.1 * partials.y, whole[1], 1e-15);
  EXPECT_NEAR(0.18 * partials.xx + 0.66 * partials.xy + 0.605 * partials.yy, whole[2], 1e-14);
  const Series<double, 3> fixed = mixture(line_series<double, 3>(0.7, 0.6, 3), line_series<double, 3>(-0.2, 1.1, 3));
  for (int k = 0; k <= 3; ++k) EXPECT_EQ(fixed[k], whole[k]) << k;
}

}  // namespace
}  // namespace retrace::jets::jets_test
