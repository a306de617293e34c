// Tests of mixtures: comparison with closed forms, duality and exhaustive search.

#include "studies/compose/mixture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

namespace retrace::testing::mixture_test {
namespace {

using namespace studies;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Returns a cell whose goals are the values of a Gaussian lobe about `middle` at points on a line.
MixedCell lobe(double middle, const std::vector<double>& points) {
  MixedCell cell;
  for (const double p : points) cell.goals.push_back(std::exp(-std::pow(p - middle, 2.0)));
  return cell;
}

TEST(Mixture, OfTwoLobesHasSharesAndPricesOfTheClosedForm) {
  // Only the goals at the two outer points limit the minimum. With the fractions x and 1 - x, these two goals are
  // equal. f and g are the values of the lobes at these points.
  const std::vector<double> points = {-1.1, 0.1, 0.9};
  const std::vector<MixedCell> cells = {lobe(-0.8, points), lobe(0.7, points)};
  const double f0 = cells[0].goals[0], f2 = cells[0].goals[2], g0 = cells[1].goals[0], g2 = cells[1].goals[2];
  const double x = (g2 - g0) / (f0 - f2 + g2 - g0);
  // Price of the first goal at which both cells have the same value.
  const double price = (g2 - f2) / (f0 - g0 + g2 - f2);
  const Mixture mixture = best_mixture(cells, {});
  ASSERT_EQ(mixture.kind, Mixture::Kind::optimal);
  ASSERT_EQ(mixture.zones.size(), 2U);
  for (const ZoneFraction& zone : mixture.zones) EXPECT_NEAR(zone.fraction, zone.cell == 0 ? x : 1.0 - x, 1e-9);
  EXPECT_NEAR(mixture.prices.goals[0], price, 1e-9);
  EXPECT_NEAR(mixture.prices.goals[1], 0.0, 1e-9);
  EXPECT_NEAR(mixture.prices.goals[2], 1.0 - price, 1e-9);
  EXPECT_NEAR(mixture.min_goal, x * f0 + (1.0 - x) * g0, 1e-12);
  EXPECT_GT(mixture.goals[1], mixture.min_goal);
  EXPECT_EQ(mixture.bound, mixture.merit);
}

TEST(Mixture, PriceIsWhatAskingMoreCosts) {
  const std::vector<double> points = {-1.1, 0.1, 0.9};
  std::vector<MixedCell> cells = {lobe(-0.8, points), lobe(0.7, points)};
  const Mixture before = best_mixture(cells, {});
  for (std::size_t goal = 0; goal < points.size(); ++goal) {
    constexpr double kMore = 1e-4;
    std::vector<MixedCell> asked = cells;
    for (MixedCell& cell : asked) cell.goals[goal] -= kMore;
    EXPECT_NEAR((before.min_goal - best_mixture(asked, {}).min_goal) / kMore, before.prices.goals[goal], 1e-9);
  }
}

/// Returns cells with random coefficients. Some of the coefficients are large.
std::vector<MixedCell> random_cells(std::size_t count, std::size_t goals, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit;
  std::vector<MixedCell> cells(count);
  for (MixedCell& cell : cells) {
    for (std::size_t k = 0; k < goals; ++k) cell.goals.push_back(4.0 * std::pow(unit(random), 3.0));
    cell.means = {unit(random)};
    cell.cost = 0.1 * unit(random);
  }
  return cells;
}

TEST(Mixture, HoldsDuality) {
  for (std::uint32_t seed = 1; seed <= 20; ++seed) {
    const std::vector<MixedCell> cells = random_cells(40, 12, seed);
    const Mixture mixture = best_mixture(cells, {.means = {{.upper = 0.4}}, .max_fraction = 0.3});
    ASSERT_EQ(mixture.kind, Mixture::Kind::optimal);
    EXPECT_LE(mixture.means[0], 0.4 + 1e-9);
    double prices = 0.0, shares = 0.0;
    for (const double price : mixture.prices.goals) {
      EXPECT_GE(price, -1e-12);
      prices += price;
    }
    EXPECT_NEAR(prices, 1.0, 1e-9);
    // Cells in the mixture have a gain of 0, or a positive gain if they have the maximum fraction. Cells that are not
    // in the mixture have no positive gain.
    std::vector<double> share(cells.size(), 0.0);
    for (const ZoneFraction& zone : mixture.zones) shares += share[zone.cell] = zone.fraction;
    EXPECT_NEAR(shares, 1.0, 1e-9);
    double dual = mixture.prices.area + 0.4 * mixture.prices.means[0];
    for (std::size_t k = 0; k < cells.size(); ++k) {
      const double gained = gain(mixture.prices, cells[k]);
      if (share[k] < 0.3 - 1e-9) {
        EXPECT_LE(gained, 1e-9);
      }
      if (share[k] > 1e-9) {
        EXPECT_GE(gained, -1e-9);
      }
      dual += 0.3 * std::max(0.0, gained);
    }
    EXPECT_NEAR(dual, mixture.merit, 1e-9);
  }
}

/// Returns the merit of the best mixture of a few cells. The best mixture of every set of cells is computed.
double best_of_all_sets(const std::vector<MixedCell>& cells, const MixtureRules& rules) {
  MixtureRules of_set = rules;
  of_set.max_zones = cells.size();
  of_set.min_fraction = 0.0;
  double best = -kInfinity;
  for (std::size_t set = 1; set < (std::size_t{1} << cells.size()); ++set) {
    std::vector<MixedCell> chosen;
    for (std::size_t k = 0; k < cells.size(); ++k)
      if ((set >> k) % 2 == 1) chosen.push_back(cells[k]);
    if (chosen.size() > rules.max_zones || rules.min_fraction * static_cast<double>(chosen.size()) > 1.0) continue;
    // Each cell has its minimum fraction. Only the remaining area is divided freely.
    MixedCell given = chosen.front();
    for (std::size_t k = 0; k < given.goals.size(); ++k) {
      given.goals[k] = 0.0;
      for (const MixedCell& cell : chosen) given.goals[k] += rules.min_fraction * cell.goals[k];
    }
    const double rest = 1.0 - rules.min_fraction * static_cast<double>(chosen.size());
    double cost = 0.0;
    for (MixedCell& cell : chosen) {
      cost += rules.min_fraction * cell.cost;
      for (std::size_t k = 0; k < cell.goals.size(); ++k) cell.goals[k] = given.goals[k] + rest * cell.goals[k];
      cell.cost *= rest;
      cell.means.clear();
    }
    best = std::max(best, best_mixture(chosen, of_set).merit - cost);
  }
  return best;
}

TEST(Mixture, OfFewZonesIsTheBestOfAllSets) {
  for (std::uint32_t seed = 1; seed <= 12; ++seed) {
    std::vector<MixedCell> cells = random_cells(9, 7, 100 + seed);
    for (MixedCell& cell : cells) cell.means.clear();
    for (const std::size_t zones : {1U, 2U, 3U})
      for (const double least : {0.0, 0.2}) {
        const MixtureRules rules{.min_fraction = least, .max_zones = zones};
        const Mixture mixture = best_mixture(cells, rules);
        ASSERT_EQ(mixture.kind, Mixture::Kind::optimal);
        EXPECT_LE(mixture.zones.size(), zones);
        EXPECT_GE(mixture.zones.back().fraction, least - 1e-9);
        EXPECT_NEAR(mixture.merit, best_of_all_sets(cells, rules), 1e-9) << seed << " " << zones << " " << least;
        EXPECT_EQ(mixture.bound, mixture.merit);
      }
  }
}

TEST(Mixture, IsNeverWorseThanAnyOnAGrid) {
  const std::vector<MixedCell> cells = random_cells(25, 10, 7);
  const Mixture mixture = best_mixture(cells, {.means = {{.upper = 0.5}}, .max_zones = 3});
  ASSERT_EQ(mixture.kind, Mixture::Kind::optimal);
  constexpr int kParts = 10;
  double best = -kInfinity;
  const auto merit_of = [&](const std::array<std::size_t, 3>& set, const std::array<double, 3>& share) {
    double cost = 0.0, mean = 0.0, least = kInfinity;
    for (std::size_t z = 0; z < 3; ++z) cost += share[z] * cells[set[z]].cost;
    for (std::size_t z = 0; z < 3; ++z) mean += share[z] * cells[set[z]].means[0];
    for (std::size_t goal = 0; goal < cells[0].goals.size(); ++goal) {
      double value = 0.0;
      for (std::size_t z = 0; z < 3; ++z) value += share[z] * cells[set[z]].goals[goal];
      least = std::min(least, value);
    }
    return mean > 0.5 ? -kInfinity : least - cost;
  };
  for (std::size_t a = 0; a < cells.size(); ++a)
    for (std::size_t b = a + 1; b < cells.size(); ++b)
      for (std::size_t c = b + 1; c < cells.size(); ++c)
        for (int i = 0; i <= kParts; ++i)
          for (int j = 0; i + j <= kParts; ++j)
            best = std::max(best, merit_of({a, b, c}, {i / 10.0, j / 10.0, (kParts - i - j) / 10.0}));
  EXPECT_GE(mixture.merit, best);
  EXPECT_LT(mixture.merit, best + 0.1);
}

TEST(Mixture, SaysWhatItMayHaveMissedWhenItIsCutShort) {
  const std::vector<MixedCell> cells = random_cells(60, 20, 3);
  const MixtureRules rules{.means = {{}}, .max_zones = 3};
  const Mixture whole = best_mixture(cells, rules);
  const Mixture cut = best_mixture(cells, rules, nullptr, 20);
  ASSERT_EQ(whole.kind, Mixture::Kind::optimal);
  ASSERT_EQ(cut.kind, Mixture::Kind::best_found);
  EXPECT_LE(cut.merit, whole.merit + 1e-12);
  EXPECT_GE(cut.bound, whole.merit);
}

TEST(Mixture, OfBoundsThatNoCellHoldsIsInfeasible) {
  const std::vector<MixedCell> cells = random_cells(10, 4, 5);
  const Mixture mixture = best_mixture(cells, {.means = {{.upper = -0.1}}});
  EXPECT_EQ(mixture.kind, Mixture::Kind::infeasible);
  EXPECT_GT(std::abs(mixture.prices.means[0]), 0.1);
  // Ten cells with at most a twentieth of the area each cover only half of the part.
  EXPECT_EQ(best_mixture(cells, {.means = {{}}, .max_fraction = 0.05}).kind, Mixture::Kind::infeasible);
  EXPECT_EQ(best_mixture(cells, {.means = {{}}, .max_fraction = 0.3, .max_zones = 3}).kind, Mixture::Kind::infeasible);
  EXPECT_EQ(best_mixture(cells, {.means = {{}}, .max_fraction = 0.3, .max_zones = 4}).kind, Mixture::Kind::optimal);
}

}  // namespace
}  // namespace retrace::testing::mixture_test
