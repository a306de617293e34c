#include "compute/estimation/sample_statistics.h"

#include <gtest/gtest.h>

#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "compute/sampling/unit_samples.h"

namespace retrace::compute::sample_statistics_test {
namespace {

using Function = std::function<double(const std::vector<double>&)>;

/// Returns the values of a function at the sample points of the scheme of Saltelli et al. (SaltelliRow). The function
/// has `parameters` arguments, each from 0 to 1.
std::vector<SaltelliRow> rows_of(const Function& f, std::size_t parameters, std::uint64_t rows, UnitSamples::Kind kind,
                                 std::uint32_t seed) {
  const UnitSamples samples(kind, 2 * parameters, rows, seed);
  std::vector<SaltelliRow> design;
  for (std::uint64_t row = 0; row < rows; ++row) {
    const std::vector<double> both = samples.at(row);
    const auto half = both.begin() + static_cast<std::ptrdiff_t>(parameters);
    const std::vector<double> a(both.begin(), half);
    SaltelliRow values{f(a), f({half, both.end()}), {}};
    for (std::size_t k = 0; k < parameters; ++k) {
      std::vector<double> mixed = a;
      mixed[k] = both[parameters + k];
      values.mixed.push_back(f(mixed));
    }
    design.push_back(values);
  }
  return design;
}

double normal(double share) {
  return boost::math::quantile(boost::math::normal_distribution<double>(), share);
}

void expect_estimate(const IntervalEstimate& estimate, double exact, double tolerance) {
  EXPECT_NEAR(estimate.value, exact, tolerance);
  EXPECT_LE(estimate.low, estimate.value);
  EXPECT_GE(estimate.high, estimate.value);
  EXPECT_LE(estimate.low - tolerance, exact);
  EXPECT_GE(estimate.high + tolerance, exact);
}

/// For a sum of independent terms, the first-order index and the total index of each term both equal its fraction of
/// the variance.
TEST(SobolIndices, OfAnAdditiveModelAreTheSharesOfItsVariance) {
  const std::vector<double> c = {3.0, 2.0, 1.0, 0.0};
  const Function f = [&](const std::vector<double>& u) {
    double sum = 100.0;  // a constant offset, which must not affect the indices
    for (std::size_t k = 0; k < c.size(); ++k) sum += c[k] * normal(u[k]);
    return sum;
  };
  const auto indices = sobol_indices(rows_of(f, 4, 4096, UnitSamples::Kind::sobol, 1), 0.95, 1);
  ASSERT_EQ(indices.size(), 4U);
  for (std::size_t k = 0; k < 4; ++k) {
    SCOPED_TRACE(k);
    expect_estimate(indices[k].first_order, c[k] * c[k] / 14.0, 0.01);
    expect_estimate(indices[k].total, c[k] * c[k] / 14.0, 0.01);
  }
  EXPECT_EQ(indices[3].total.value, 0.0) << "what does nothing has no part in it";
  EXPECT_EQ(indices[3].first_order.value, 0.0);
}

/// The function of Ishigami and Homma (1990) is sin x + a sin^2 y + b z^4 sin x with a = 7, b = 0.1 and arguments from
/// -pi to pi. Its indices are known in closed form.
TEST(SobolIndices, OfTheIshigamiFunctionAreItsClosedForms) {
  constexpr double pi = std::numbers::pi;
  constexpr double a = 7.0;
  constexpr double b = 0.1;
  const Function f = [](const std::vector<double>& u) {
    const double x = pi * (2.0 * u[0] - 1.0);
    const double y = pi * (2.0 * u[1] - 1.0);
    const double z = pi * (2.0 * u[2] - 1.0);
    return std::sin(x) + a * std::pow(std::sin(y), 2) + b * std::pow(z, 4) * std::sin(x);
  };
  const double pi4 = std::pow(pi, 4);
  const double v1 = 0.5 * std::pow(1.0 + b * pi4 / 5.0, 2);
  const double v2 = a * a / 8.0;
  const double v13 = b * b * pi4 * pi4 * (1.0 / 18.0 - 1.0 / 50.0);
  const double v = v1 + v2 + v13;
  const auto indices = sobol_indices(rows_of(f, 3, 8192, UnitSamples::Kind::sobol, 1), 0.95, 1);
  ASSERT_EQ(indices.size(), 3U);
  expect_estimate(indices[0].first_order, v1 / v, 0.01);
  expect_estimate(indices[1].first_order, v2 / v, 0.01);
  expect_estimate(indices[2].first_order, 0.0, 0.01);
  expect_estimate(indices[0].total, (v1 + v13) / v, 0.01);
  expect_estimate(indices[1].total, v2 / v, 0.01);
  expect_estimate(indices[2].total, v13 / v, 0.01);
}

/// A product of two independent factors with mean 0 varies only by interaction: the first-order indices are 0, and the
/// total indices are 1.
TEST(SobolIndices, OfAProductAreAllInteraction) {
  const Function f = [](const std::vector<double>& u) { return normal(u[0]) * normal(u[1]); };
  const auto indices = sobol_indices(rows_of(f, 2, 8192, UnitSamples::Kind::sobol, 3), 0.95, 1);
  for (const SobolIndex& index : indices) {
    EXPECT_NEAR(index.first_order.value, 0.0, 0.03);
    EXPECT_NEAR(index.total.value, 1.0, 0.03);
  }
}

/// Confidence intervals of 90 % must contain the true value in about 90 % of 300 studies with 200 rows each. The limits
/// of 84 % and 96 % allow for random variation.
TEST(SobolIndices, IntervalsHoldTheTruthAsOftenAsTheySay) {
  const Function f = [](const std::vector<double>& u) { return 2.0 * normal(u[0]) + normal(u[1]); };
  constexpr int studies = 300;
  int first = 0;
  int total = 0;
  for (int study = 0; study < studies; ++study) {
    const auto seed = static_cast<std::uint32_t>(study + 1);
    const auto indices = sobol_indices(rows_of(f, 2, 200, UnitSamples::Kind::monte_carlo, seed), 0.9, seed);
    const auto holds = [](const IntervalEstimate& e, double exact) {
      return e.low <= exact && exact <= e.high ? 1 : 0;
    };
    first += holds(indices[0].first_order, 0.8);
    total += holds(indices[1].total, 0.2);
  }
  for (const int hits : {first, total}) {
    EXPECT_GE(hits, 300 * 0.84);
    EXPECT_LE(hits, 300 * 0.96);
  }
}

TEST(SobolIndices, WhatDoesNotVaryHasNone) {
  const Function f = [](const std::vector<double>&) { return 0.7; };
  EXPECT_TRUE(sobol_indices(rows_of(f, 2, 64, UnitSamples::Kind::sobol, 1), 0.95, 1).empty());
  EXPECT_TRUE(sobol_indices({}, 0.95, 1).empty());
}

TEST(Yield, IntervalsAreThoseOfClopperAndPearson) {
  EXPECT_EQ(yield_of(0, 10, 0.95).low, 0.0);
  EXPECT_NEAR(yield_of(0, 10, 0.95).high, 1.0 - std::pow(0.025, 0.1), 1e-9);
  EXPECT_NEAR(yield_of(10, 10, 0.95).low, std::pow(0.025, 0.1), 1e-9);
  EXPECT_EQ(yield_of(10, 10, 0.95).high, 1.0);
  EXPECT_EQ(yield_of(8, 10, 0.95).value, 0.8);
  EXPECT_NEAR(yield_of(8, 10, 0.95).low, 0.4439, 1e-4);
  EXPECT_NEAR(yield_of(8, 10, 0.95).high, 0.9748, 1e-4);
}

/// For every true yield, the probability that the 95 % interval contains the true yield must be at least 95 %.
TEST(Yield, IntervalsHoldTheTruthAtLeastAsOftenAsTheySay) {
  constexpr std::size_t parts = 30;
  for (const double truth : {0.01, 0.2, 0.5, 0.83, 0.99}) {
    const boost::math::binomial_distribution<double> outcomes(static_cast<double>(parts), truth);
    double held = 0.0;
    for (std::size_t good = 0; good <= parts; ++good) {
      const IntervalEstimate yield = yield_of(good, parts, 0.95);
      if (yield.low <= truth && truth <= yield.high) held += boost::math::pdf(outcomes, static_cast<double>(good));
    }
    EXPECT_GE(held, 0.95) << truth;
    EXPECT_LT(held, 1.0 - 1e-9 + 1e-6) << truth;
  }
}

TEST(Spread, OfFiveValues) {
  const Spread spread = spread_of({5.0, 1.0, 2.0, 4.0, 3.0}, 0.95);
  EXPECT_EQ(spread.mean, 3.0);
  EXPECT_NEAR(spread.deviation, std::sqrt(2.5), 1e-12);
  EXPECT_EQ(spread.min, 1.0);
  EXPECT_EQ(spread.max, 5.0);
  // According to tables, the 97.5 % quantile of Student's t distribution with four degrees of freedom is 2.7764.
  EXPECT_NEAR(spread.mean_interval.high - 3.0, 2.7764 * std::sqrt(2.5 / 5.0), 1e-4);
  EXPECT_NEAR(3.0 - spread.mean_interval.low, 2.7764 * std::sqrt(2.5 / 5.0), 1e-4);
  EXPECT_EQ(spread_of({7.0}, 0.95).deviation, 0.0);
}

TEST(Percentile, LiesBetweenNeighbours) {
  const std::vector<double> values = {10.0, 20.0, 40.0};
  EXPECT_EQ(percentile(values, 0.0), 10.0);
  EXPECT_EQ(percentile(values, 0.25), 15.0);
  EXPECT_EQ(percentile(values, 0.5), 20.0);
  EXPECT_EQ(percentile(values, 0.75), 30.0);
  EXPECT_EQ(percentile(values, 1.0), 40.0);
  EXPECT_EQ(percentile({3.0}, 0.3), 3.0);
}

}  // namespace
}  // namespace retrace::compute::sample_statistics_test
