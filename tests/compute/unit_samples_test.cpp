#include "compute/sampling/unit_samples.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace retrace::compute::unit_samples_test {
namespace {

using Kind = UnitSamples::Kind;

/// Expects the same number of points in each of `bins` equal parts of an axis.
void expect_even(const UnitSamples& samples, std::uint64_t count, std::size_t axis, std::uint64_t bins) {
  std::vector<std::uint64_t> hits(bins, 0);
  for (std::uint64_t k = 0; k < count; ++k) {
    const double u = samples.at(k)[axis];
    ASSERT_GT(u, 0.0);
    ASSERT_LT(u, 1.0);
    ++hits[static_cast<std::size_t>(u * static_cast<double>(bins))];
  }
  for (const std::uint64_t hit : hits) EXPECT_EQ(hit, count / bins) << "axis " << axis;
}

TEST(Sampling, EveryAxisIsFilledEvenly) {
  constexpr std::uint64_t count = 256;
  for (const Kind kind : {Kind::sobol, Kind::latin_hypercube}) {
    const UnitSamples samples(kind, 7, count, 1);
    for (std::size_t axis = 0; axis < 7; ++axis) expect_even(samples, count, axis, count);
  }
}

TEST(Sampling, IndependentPointsAreSpreadAsChanceHasIt) {
  constexpr std::uint64_t count = 4096;
  constexpr std::size_t bins = 16;
  const UnitSamples samples(Kind::monte_carlo, 3, count, 1);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::vector<double> hits(bins, 0.0);
    for (std::uint64_t k = 0; k < count; ++k) hits[static_cast<std::size_t>(bins * samples.at(k)[axis])] += 1.0;
    double chi_square = 0.0;
    const double expected = static_cast<double>(count) / bins;
    for (const double hit : hits) chi_square += (hit - expected) * (hit - expected) / expected;
    // Chi-squared has 15 degrees of freedom. The limits exclude 0.1 % on each side.
    EXPECT_LT(chi_square, 37.7);
    EXPECT_GT(chi_square, 3.5) << "too even for chance";
  }
}

TEST(Sampling, SobolFillsThePlaneEvenlyWhateverTheSeed) {
  for (const std::uint32_t seed : {1U, 2U, 77U}) {
    const UnitSamples samples(Kind::sobol, 2, 256, seed);
    std::set<std::pair<int, int>> cells;
    for (std::uint64_t k = 0; k < 256; ++k) {
      const auto u = samples.at(k);
      cells.emplace(static_cast<int>(16 * u[0]), static_cast<int>(16 * u[1]));
    }
    EXPECT_EQ(cells.size(), 256U);  // the points form a (0, 8, 2)-net
  }
}

TEST(Sampling, PointsAreToldByTheirNumberAndSeed) {
  for (const Kind kind : {Kind::sobol, Kind::latin_hypercube, Kind::monte_carlo}) {
    const UnitSamples samples(kind, 3, 64, 5);
    const auto late = samples.at(40);
    samples.at(3);
    EXPECT_EQ(samples.at(40), late);
    EXPECT_EQ(UnitSamples(kind, 3, 64, 5).at(40), late);
    EXPECT_NE(UnitSamples(kind, 3, 64, 6).at(40), late);
    EXPECT_NE(late[0], late[1]);
  }
}

TEST(Sampling, SobolIntegratesASmoothFunctionFarBetterThanChance) {
  constexpr std::uint64_t count = 4096;
  const UnitSamples samples(Kind::sobol, 4, count, 3);
  double sum = 0.0;
  for (std::uint64_t k = 0; k < count; ++k) {
    double product = 1.0;
    for (const double u : samples.at(k)) product *= 1.5 * std::sqrt(u);
    sum += product;
  }
  // The product has the mean 1 and the variance (9/8)^4 - 1. The mean of random points would have a standard error of
  // 0.012.
  EXPECT_NEAR(sum / count, 1.0, 1e-3);
}

}  // namespace
}  // namespace retrace::compute::unit_samples_test
