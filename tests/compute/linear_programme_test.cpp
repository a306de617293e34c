// Tests of linear programmes with known optima, prices and Farkas multipliers.
#include "compute/linear/linear_programme.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace retrace::compute::linear_programme_test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(LinearProgramme, FindsTheOptimumAndItsPrices) {
  // Maximise 3 a + 5 b with a <= 4, 2 b <= 12 and 3 a + 2 b <= 18 (Hillier and Lieberman, Introduction to Operations
  // Research, section 3.1).
  LinearProgramme programme;
  const std::size_t a = programme.add_column({.lower = 0.0}, 3.0);
  const std::size_t b = programme.add_column({.lower = 0.0}, 5.0);
  programme.add_row({-kInfinity, 4.0}, {{a, 1.0}});
  programme.add_row({-kInfinity, 12.0}, {{b, 2.0}});
  programme.add_row({-kInfinity, 18.0}, {{a, 3.0}, {b, 2.0}});
  const LinearOptimum optimum = solve(programme);
  ASSERT_EQ(optimum.kind, LinearOptimum::Kind::optimal);
  EXPECT_NEAR(optimum.objective, 36.0, 1e-12);
  EXPECT_NEAR(optimum.values[a], 2.0, 1e-12);
  EXPECT_NEAR(optimum.values[b], 6.0, 1e-12);
  EXPECT_NEAR(optimum.prices[0], 0.0, 1e-12);
  EXPECT_NEAR(optimum.prices[1], 1.5, 1e-12);
  EXPECT_NEAR(optimum.prices[2], 1.0, 1e-12);
}

TEST(LinearProgramme, SaysWhichRowsExcludeEachOther) {
  // With x <= 2, the row x + y >= 3 requires y >= 1, and the row x - y >= 2 requires y <= 0.
  LinearProgramme programme;
  const std::size_t x = programme.add_column({0.0, 2.0}, 1.0);
  const std::size_t y = programme.add_column({0.0, 1.0}, 0.0);
  programme.add_row({.lower = 3.0}, {{x, 1.0}, {y, 1.0}});
  programme.add_row({.lower = 2.0}, {{x, 1.0}, {y, -1.0}});
  programme.add_row({.lower = -5.0}, {{x, 1.0}});
  const LinearOptimum optimum = solve(programme);
  ASSERT_EQ(optimum.kind, LinearOptimum::Kind::infeasible);
  // The bounds of the columns cannot satisfy the sum of the rows, each multiplied by its Farkas multiplier.
  const std::vector<double>& m = optimum.prices;
  EXPECT_NEAR(std::abs(m[0]) + std::abs(m[1]) + std::abs(m[2]), 1.0, 1e-12);
  EXPECT_LE(*std::ranges::max_element(m), 0.0);
  const double asked = 3.0 * -m[0] + 2.0 * -m[1] - 5.0 * -m[2];
  const double most = 2.0 * std::max(0.0, -m[0] - m[1] - m[2]) + std::max(0.0, -m[0] + m[1]);
  EXPECT_GT(asked, most + 0.1);
  EXPECT_EQ(m[2], 0.0);
}

TEST(LinearProgramme, TellsTheUnboundedAndTheInterrupted) {
  LinearProgramme programme;
  const std::size_t x = programme.add_column({.lower = 0.0}, 1.0);
  programme.add_row({.lower = 1.0}, {{x, 1.0}});
  EXPECT_EQ(solve(programme).kind, LinearOptimum::Kind::unbounded);
  Cancellation cancel;
  cancel.request();
  EXPECT_EQ(solve(programme, &cancel).kind, LinearOptimum::Kind::interrupted);
}

}  // namespace
}  // namespace retrace::compute::linear_programme_test
