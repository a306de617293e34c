// Tests of numerical differentiation. The reported error must bound the true error. For functions without a derivative,
// no derivative may be reported.
#include "core/math/derivative.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

namespace retrace::derivative_test {
namespace {

constexpr double kRounding = 1e-15;

struct Known {
  std::string name;
  std::function<double(double)> f;
  std::function<double(double)> slope;
};

/// Returns smooth functions with a parameter c of order 1, and their derivatives.
std::vector<Known> smooth_functions(double c) {
  return {{"sin", [=](double x) { return std::sin(c * x); }, [=](double x) { return c * std::cos(c * x); }},
          {"exp", [=](double x) { return std::exp(-c * x); }, [=](double x) { return -c * std::exp(-c * x); }},
          {"power", [=](double x) { return std::pow(x, c); }, [=](double x) { return c * std::pow(x, c - 1.0); }},
          {"pole", [=](double x) { return 1.0 / (c + x); }, [=](double x) { return -1.0 / ((c + x) * (c + x)); }},
          {"log", [=](double x) { return std::log(c + x); }, [=](double x) { return 1.0 / (c + x); }},
          {"square", [=](double x) { return c * x * x; }, [=](double x) { return 2.0 * c * x; }}};
}

/// Returns positive or negative noise that depends only on x.
double noise_at(double x, double amplitude) {
  std::seed_seq seed{std::hash<double>{}(x)};
  std::mt19937 engine(seed);
  return std::uniform_real_distribution<double>(-amplitude, amplitude)(engine);
}

Derivative differentiate_with(const std::function<double(double)>& f, double noise, double x,
                              const DifferenceRange& range) {
  return differentiate(
      [&](double at) {
        return Sample{f(at) + (noise > 0.0 ? noise_at(at, noise) : 0.0), noise + kRounding * std::abs(f(at))};
      },
      x, range);
}

struct Outcome {
  int cases = 0;
  int covered = 0;     ///< number of cases whose true error is within the estimate
  double worst = 0.0;  ///< maximum ratio of the true error to the estimate
  double worst_error = 0.0;
};

/// Differentiates many functions at many points, with many sizes of the first step.
Outcome try_many(double noise, bool one_sided) {
  std::mt19937 engine(7);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  Outcome outcome;
  for (int k = 0; k < 500; ++k) {
    const double c = 0.5 + 2.0 * unit(engine);
    const double x = 0.5 + unit(engine);
    DifferenceRange range{std::pow(10.0, -2.5 + 2.0 * unit(engine))};
    if (one_sided) (k % 2 == 0 ? range.lower : range.upper) = x;
    for (const Known& known : smooth_functions(c)) {
      const Derivative found = differentiate_with(known.f, noise, x, range);
      const double error = std::abs(found.value - known.slope(x));
      ++outcome.cases;
      if (error <= found.error) ++outcome.covered;
      outcome.worst = std::max(outcome.worst, error / found.error);
      outcome.worst_error = std::max(outcome.worst_error, found.error);
    }
  }
  return outcome;
}

void expect_covered(const Outcome& outcome, double worst_error) {
  EXPECT_EQ(outcome.cases, 3000);
  EXPECT_GE(outcome.covered, 2970) << "of 3000";
  EXPECT_LE(outcome.worst, 3.0);
  EXPECT_LE(outcome.worst_error, worst_error);
}

TEST(Differentiate, ErrorEstimateCoversTheErrorOfSmoothFunctions) {
  expect_covered(try_many(0.0, false), 5e-5);
}

TEST(Differentiate, ErrorEstimateCoversNoise) {
  expect_covered(try_many(1e-10, false), 5e-5);
  expect_covered(try_many(1e-7, false), 1e-3);
}

TEST(Differentiate, ErrorEstimateCoversTheErrorOnOneSide) {
  expect_covered(try_many(0.0, true), 1e-4);
  expect_covered(try_many(1e-10, true), 1e-4);
}

TEST(Differentiate, StaysWithinItsRange) {
  const auto check = [](double x, const DifferenceRange& range) {
    int calls = 0;
    const Derivative found = differentiate(
        [&](double at) {
          ++calls;
          EXPECT_GE(at, range.lower);
          EXPECT_LE(at, range.upper);
          return Sample{std::sqrt(at), 1e-16};
        },
        x, range);
    EXPECT_LE(calls, 25);
    EXPECT_TRUE(found.converged());
    EXPECT_NEAR(found.value, 0.5 / std::sqrt(x), 1e-6);
  };
  check(1.0, {0.1, 1.0, 2.0});
  check(1.0, {0.1, 0.95, 2.0});
  check(1.0, {0.1, 0.999, 2.0});
  check(1.0, {0.1, 0.0, 1.0});
  check(1.0, {0.1, 0.0, 1.0 + 1e-12});
  EXPECT_FALSE(differentiate([](double) { return Sample{}; }, 1.0, {0.1, 1.0, 1.0}).converged());
}

/// Functions without a derivative at 0 must not converge.
TEST(Differentiate, KinksAndJumpsDoNotConverge) {
  const auto converges = [](const std::function<double(double)>& f) {
    return differentiate_with(f, 1e-12, 0.0, {0.1}).converged();
  };
  EXPECT_FALSE(converges([](double x) { return std::abs(x); })) << "central differences agree on 0";
  EXPECT_FALSE(converges([](double x) { return std::max(0.0, x); }));
  EXPECT_FALSE(converges([](double x) { return std::exp(x) + 0.01 * std::abs(x); }));
  EXPECT_FALSE(converges([](double x) { return std::sqrt(std::abs(x)); }));
  EXPECT_FALSE(converges([](double x) { return x > 0.0 ? std::sqrt(x) : 0.0; }));
  EXPECT_FALSE(converges([](double x) { return x > 0.0 ? 1e-3 : 0.0; }));
  EXPECT_FALSE(converges([](double x) { return x >= 0.0 ? 1e-3 : 0.0; }));
  EXPECT_FALSE(converges([](double x) { return std::max(0.0, x - 1e-6); })) << "nearer than the least step";
}

TEST(Differentiate, KinksAndJumpsWithinTheFirstStepAreLeftBehind) {
  std::mt19937 engine(3);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (int k = 0; k < 200; ++k) {
    const double there = (k % 2 == 0 ? 1.0 : -1.0) * (0.005 + 0.1 * unit(engine));
    for (const double jump : {0.0, 0.1}) {
      const auto f = [&](double x) { return std::sin(x) + std::abs(x - there) + (x > there ? jump : 0.0); };
      const Derivative found = differentiate_with(f, 1e-12, 0.0, {0.1});
      const double slope = 1.0 - std::copysign(1.0, there);
      EXPECT_TRUE(found.converged()) << there;
      EXPECT_LE(std::abs(found.value - slope), 3.0 * found.error) << there;
    }
  }
}

TEST(Differentiate, NoiseThatHidesTheSlopeIsSaid) {
  const Derivative found = differentiate_with([](double x) { return std::sin(x); }, 1e-2, 0.3, {0.1});
  EXPECT_FALSE(found.converged());
  EXPECT_GT(found.noise, 0.5 * found.error);
}

}  // namespace
}  // namespace retrace::derivative_test
