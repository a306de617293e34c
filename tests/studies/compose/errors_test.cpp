// Tests of angle errors in composed parts. Responses, yields and fractions for the worst parts are compared with closed
// forms and with grids.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <random>

#include "core/error.h"
#include "studies/compose/cell_errors.h"
#include "studies/compose/io/compose_reader.h"
#include "studies/compose/io/composition_files.h"
#include "studies/compose/part_yield.h"
#include "studies/quantity/io/study_reader.h"
#include "tests/support/analytic_study.h"
#include "tests/support/refusals.h"

namespace retrace::testing::errors_test {
namespace {

using namespace studies;
using Numbers = std::vector<double>;

/// Returns the response of a function. The function is evaluated at the errors that the response requires.
ErrorResponse response_to(std::size_t angles, double step, const std::function<Numbers(const Numbers&)>& goals) {
  std::vector<Numbers> computed;
  for (const Numbers& errors : ErrorResponse::errors_to_compute(angles, step)) computed.push_back(goals(errors));
  return {angles, step, computed};
}

TEST(ErrorResponse, IsExactOfTheSecondDegree) {
  const auto goals = [](const Numbers& e) {
    return Numbers{1.0 + 2.0 * e[0] - e[1] + 0.5 * e[0] * e[0] - e[1] * e[2] + 2.0 * e[2] * e[2], e[2] - e[0] * e[1]};
  };
  const ErrorResponse response = response_to(3, 0.3, goals);
  for (const Numbers& e : {Numbers{0, 0, 0}, Numbers{1, -2, 0.5}, Numbers{-0.7, 0.1, 3}})
    for (std::size_t g = 0; g < 2; ++g) EXPECT_NEAR(response.at(e)[g], goals(e)[g], 1e-12);
  EXPECT_NEAR(response.slope(0, 0), 2.0, 1e-12);
  EXPECT_NEAR(response.slope(2, 1), 1.0, 1e-12);
  // The mean of the square of an error is its variance. The mean of the product of two different errors is 0.
  EXPECT_NEAR(response.spread(0.4).at({0, 0, 0})[0], 1.0 + 0.16 * (0.5 + 2.0), 1e-12);
  EXPECT_NEAR(response.spread(0.4).at({0, 0, 0})[1], 0.0, 1e-12);
}

TEST(ErrorResponse, HasTheMeanOfALobe) {
  // The mean of exp(-e^2 / 2) over a Gaussian with the standard deviation s is 1 / sqrt(1 + s^2).
  const double sigma = 0.2;
  const ErrorResponse response =
      response_to(1, std::sqrt(3.0) * sigma, [](const Numbers& e) { return Numbers{std::exp(-0.5 * e[0] * e[0])}; });
  EXPECT_NEAR(response.spread(sigma).at({0.0})[0], 1.0 / std::sqrt(1.0 + sigma * sigma), 1e-5);
}

ErrorResponse linear(const Numbers& at_none, const Numbers& slopes) {
  return response_to(1, 1.0, [&](const Numbers& e) {
    Numbers goals = at_none;
    for (std::size_t g = 0; g < goals.size(); ++g) goals[g] += slopes[g] * e[0];
    return goals;
  });
}

TEST(PartYield, OfLinearGoalsIsThatOfTheNormalDistribution) {
  const RandomParts parts = random_parts({linear({1.0}, {1.0}), linear({1.0}, {-2.0})}, 0.5, 4096, 1);
  const Numbers leasts = min_goals_of(parts, {0.6, 0.4});
  const double sigma = 0.5 * std::hypot(0.6, 0.8);
  const auto above = [&](double limit) {
    return static_cast<double>(std::ranges::count_if(leasts, [&](double l) { return l >= limit; })) / 4096.0;
  };
  for (const double z : {-1.5, 0.0, 1.0})
    EXPECT_NEAR(above(1.0 + z * sigma), 0.5 * std::erfc(z / std::sqrt(2.0)), 5e-3) << z;
  // The mean of the worst 5 % is d / 0.05 = 2.0627 standard deviations below the mean of all values. d is the normal
  // probability density at the 5 % quantile.
  EXPECT_NEAR(mean_of_worst(leasts, 0.05), 1.0 - 2.0627 * sigma, 0.01);
}

TEST(PartYield, TakesPartOfAPart) {
  EXPECT_NEAR(mean_of_worst({4.0, 1.0, 3.0, 2.0}, 0.375), (1.0 + 0.5 * 2.0) / 1.5, 1e-12);
  EXPECT_NEAR(mean_of_worst({4.0, 1.0, 3.0, 2.0}, 1.0), 2.5, 1e-12);
  EXPECT_NEAR(mean_of_worst({4.0, 1.0, 3.0, 2.0}, 0.1), 1.0, 1e-12);
}

TEST(PartYield, SharesForTheWorstAreNeverWorseThanAGrid) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> number(0.0, 1.0);
  for (int trial = 0; trial < 4; ++trial) {
    std::vector<ErrorResponse> zones;
    for (int z = 0; z < 3; ++z)
      zones.push_back(linear({number(random), number(random), number(random)},
                             {number(random) - 0.5, number(random) - 0.5, number(random) - 0.5}));
    const RandomParts parts = random_parts(zones, 0.5, 64, 1);
    const auto worst = [&](const Numbers& shares) { return mean_of_worst(min_goals_of(parts, shares), 0.1); };
    const auto best = best_fractions(parts, 0.1, {0.05, 0.8}, nullptr);
    ASSERT_TRUE(best.has_value());
    double of_grid = -1e9;
    for (int i = 2; i <= 32; ++i)
      for (int j = 2; j <= 32 && i + j <= 38; ++j)
        if (40 - i - j <= 32) of_grid = std::max(of_grid, worst({i / 40.0, j / 40.0, (40 - i - j) / 40.0}));
    EXPECT_GE(worst(*best), of_grid - 1e-9);
    EXPECT_LE(worst(*best), of_grid + 0.05);
    for (const double share : *best) {
      EXPECT_GE(share, 0.05 - 1e-9);
      EXPECT_LE(share, 0.8 + 1e-9);
    }
  }
}

TEST(PartYield, SetsForTheWorstAreNeverWorseThanAGridOfEach) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> number(0.0, 1.0);
  for (int trial = 0; trial < 3; ++trial) {
    std::vector<ErrorResponse> cells;
    for (int z = 0; z < 4; ++z)
      cells.push_back(linear({number(random), number(random)}, {number(random) - 0.5, number(random) - 0.5}));
    const RandomParts parts = random_parts(cells, 0.5, 64, 1);
    const auto best = best_set(parts, 0.1, 2, {0.1, 1.0}, nullptr);
    ASSERT_TRUE(best.has_value());
    EXPECT_LE(best->size(), 2U);
    Numbers shares(4, 0.0);
    double all = 0.0;
    for (const auto& [cell, share] : *best) {
      EXPECT_GE(share, 0.1 - 1e-9);
      all += shares[cell] = share;
    }
    EXPECT_NEAR(all, 1.0, 1e-9);
    const auto worst = [&](const Numbers& of) { return mean_of_worst(min_goals_of(parts, of), 0.1); };
    double of_grid = -1e9;
    for (std::size_t a = 0; a < 4; ++a)
      for (std::size_t b = 0; b < 4; ++b)
        for (int k = 2; k <= 18; ++k) {
          Numbers of(4, 0.0);
          of[a] += k / 20.0;
          of[b] += 1.0 - k / 20.0;
          of_grid = std::max(of_grid, worst(of));
        }
    EXPECT_GE(worst(shares), of_grid - 1e-9);
    EXPECT_LE(worst(shares), of_grid + 0.05);
  }
}

/// A goal as a function of the angle error of a prism. The goals with side = 0.5 and side = -0.5 have the same value at
/// an error of one arcmin, where the smaller of the two is largest.
class Peak : public Quantity {
 public:
  explicit Peak(double side) : Quantity(side > 0.0 ? "g.1" : "g.2"), side_(side) {}
  std::optional<Measured> measure(const Candidate& candidate, const Cancellation*) const override {
    const double error = candidate.design().part().angle_errors.dihedral_error_arcmin[0];
    return Measured{2.0 + side_ * (error - 1.0) - std::pow(error - 1.0, 2.0), 0.0};
  }

 private:
  double side_;
};

Study study_of_peaks(const std::string& keys) {
  Study study = parse_study(
      "design = \"../rtp_brick_1mm.toml\"\n[[parameter]]\nkey = \"surface.dihedral_error_arcmin\"\nvalues = [0, 1, 2]\n"
      "[[quantity]]\nkind = \"elements_full\"\nname = \"g.1\"\n[[quantity]]\nkind = \"elements_full\"\nname = "
      "\"g.2\"\n[compose]\nmaximize = \"g\"\n" +
          keys,
      test::kStudies + "study.toml");
  study.quantities = {std::make_shared<Peak>(0.5), std::make_shared<Peak>(-0.5)};
  return study;
}

TEST(ComposeErrors, AreThoseOfTheClosedForm) {
  // The best cell has an angle error of 1 arcmin. If its zone has a further error e in arcmin, the minimum goal is
  // 2 - |e| / 2 - e^2, minus the variance of the errors from cell to cell.
  const Study study = study_of_peaks(
      "min_goal = 1.5\nmax_zones = 1\ncell_sigma_arcmin = 0.3\nzone_sigma_arcmin = 0.4\nparts = 4096\nworst_fraction = "
      "0.1\n");
  compute::ResultStore store("", compose_layout(study), compute::IfExists::refuse);
  const ComposeRequest request = read_compose(study);
  const Composition composition = compose(study, request, store, nullptr, nullptr);
  ASSERT_TRUE(composition.errors.has_value());
  const ErrorEffects& effects = *composition.errors;
  for (const double goal : effects.goals) EXPECT_NEAR(goal, 2.0 - 0.09, 1e-9);
  const double most = -0.25 + std::sqrt(0.0625 + 0.5 - 0.09);
  EXPECT_NEAR(static_cast<double>(*effects.yield.good) / 4096.0, std::erf(most / (0.4 * std::sqrt(2.0))), 5e-3);
  EXPECT_NEAR(effects.approximation_error, 0.0, 1e-9);
  // The derivatives of the two goals are 0.5 and -0.5. They are weighted by the prices of the goals, which add up to 1.
  const double price = composition.best->mixture.prices.goals[0];
  EXPECT_NEAR(effects.slopes.at(0).at(0), price * 0.5 - (1.0 - price) * 0.5, 1e-9);
  EXPECT_NEAR(effects.robust_part->zones.at(0).area_fraction, 1.0, 1e-12);
  const auto json = nlohmann::json::parse(composition_json(study, request, composition, 1.0)).at("errors_of_angle");
  EXPECT_EQ(json.at("yield").at("good"), *effects.yield.good);
  EXPECT_NE(composition_text(study, request, composition).find("of 4096 parts reach 1.5, 95 % of them reach"),
            std::string::npos);
}

TEST(ComposeErrors, AreAddedToThoseOfTheDesign) {
  // Angle errors are added to a cube corner, one for each of its three dihedral edges. The result must be the same as
  // with a design file that contains the sums.
  const std::string text =
      "design = \"../honeycomb_infinite.toml\"\n[[parameter]]\nkey = \"surface.dihedral_error_arcmin\"\nvalues = [5]\n"
      "[[quantity]]\nkind = \"rre\"\nincidence_deg = [0, 15]\nover_directions = \"each\"\n[compose]\nmaximize = "
      "\"rre\"\n";
  const Study study = parse_study(text, test::kStudies + "study.toml");
  EXPECT_EQ(angles_of(study, example_values(study)), 3U);
  const auto goals =
      goals_with_errors(study, read_compose(study), {0, example_values(study), {}}, {{0, 0, 0}, {3, 0, -2}}, nullptr);
  const auto measured = [&](const std::string& values) {
    std::string with = text;
    with.replace(with.find("[5]"), 3, values);
    const Study other = parse_study(with, test::kStudies + "study.toml");
    const Candidate candidate = make_candidate(other, example_values(other));
    Numbers all;
    for (const auto& quantity : other.quantities) all.push_back(*quantity->measure(candidate, nullptr)->value);
    return all;
  };
  EXPECT_EQ(goals[0], measured("[5]"));
  EXPECT_EQ(goals[1], measured("[[8, 5, 3]]"));
  EXPECT_NE(goals[0], goals[1]);
}

TEST(ComposeErrors, RefuseWhatMeansNothing) {
  const auto refusal = [](const std::string& keys) -> std::string {
    try {
      read_compose(study_of_peaks(keys));
    } catch (const InputError& error) {
      return recorded_place_of(error);
    }
    return {};
  };
  EXPECT_EQ(refusal("worst_fraction = 0.1\n"), "examples/studies/study.toml:13: compose.worst_fraction");
  EXPECT_EQ(refusal("zone_sigma_arcmin = -1\n"), "examples/studies/study.toml:13: compose.zone_sigma_arcmin");
  EXPECT_EQ(refusal("zone_sigma_arcmin = 1\nworst_fraction = 0\n"),
            "examples/studies/study.toml:14: compose.worst_fraction");
  EXPECT_EQ(refusal("parts = 3\n"), "examples/studies/study.toml:13: compose.parts");
  EXPECT_EQ(refusal("zone_sigma_arcmin = 0\n"), "");
}

}  // namespace
}  // namespace retrace::testing::errors_test
