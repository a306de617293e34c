// Tests of interrupted compositions and of rounded area fractions.

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/error.h"
#include "studies/compose/compose.h"
#include "studies/compose/io/compose_reader.h"
#include "studies/compose/io/composition_files.h"
#include "studies/compose/mixture.h"
#include "studies/quantity/machining_limits.h"
#include "tests/support/analytic_study.h"
#include "tests/support/refusals.h"

namespace retrace::testing::best_so_far_test {
namespace {

using namespace studies;
using test::Analytic, test::analytic_study, test::Functions;

Analytic::Function lobe_at(double point) {
  return [point](double x, double y) { return y * std::exp(-std::pow(y * (x - point), 2.0)); };
}

/// Returns a study with two goals. `computed` counts the designs for which the first goal was computed.
Study lobes(const std::string& keys, std::atomic<int>* computed, Cancellation* cancel, int end) {
  const Functions functions = {{"g.1",
                                [=](double x, double y) {
                                  if (computed != nullptr && ++*computed == end) cancel->request();
                                  return lobe_at(0.8)(x, y);
                                }},
                               {"g.2", lobe_at(2.2)}};
  return analytic_study("[compose]\nmaximize = [\"g.1\", \"g.2\"]\nscan = 20\n" + keys, functions);
}

TEST(BestSoFar, AnInterruptedCompositionHasThePartOfTheFinishedCells) {
  for (const int end : {3, 11, 24, 40}) {
    SCOPED_TRACE(end);
    Cancellation cancel;
    std::atomic<int> computed = 0;
    const Study study = lobes("", &computed, &cancel, end);
    const ComposeRequest request = read_compose(study);
    compute::ResultStore store("", compose_layout(study), compute::IfExists::refuse);
    Composition composition = compose(study, request, store, nullptr, &cancel);
    EXPECT_FALSE(composition.complete);
    choose_best_so_far(study, request, store, composition);
    ASSERT_TRUE(composition.best.has_value());
    EXPECT_EQ(composition.proof, Proof::none);
    EXPECT_EQ(composition.evaluations, store.finished().size()) << "no finished cell is lost";
    double fraction = 0.0;
    for (const Zone& zone : composition.best->zones) fraction += zone.area_fraction;
    EXPECT_NEAR(fraction, 1.0, 1e-9);
    // The part must be at least as good as a part that consists of the best single cell.
    double single = 0.0;
    for (const FamilyCell& cell : composition.catalogue)
      single = std::max(single, *std::ranges::min_element(cell.mixed.goals));
    EXPECT_GE(composition.best->mixture.min_goal, single - 1e-9);
    EXPECT_FALSE(composition_text(study, request, composition).empty());
    // The next run continues with the stored cells. Its result must be equal to the result of an uninterrupted run.
    const Study whole = lobes("", nullptr, nullptr, 0);
    compute::ResultStore fresh("", compose_layout(whole), compute::IfExists::refuse);
    const Composition resumed = compose(whole, request, store, nullptr, nullptr);
    const Composition expected = compose(whole, request, fresh, nullptr, nullptr);
    EXPECT_TRUE(resumed.complete);
    EXPECT_EQ(resumed.evaluations, expected.evaluations);
    ASSERT_EQ(resumed.best->zones.size(), expected.best->zones.size());
    for (std::size_t zone = 0; zone < expected.best->zones.size(); ++zone) {
      EXPECT_EQ(resumed.best->zones[zone].cell.point, expected.best->zones[zone].cell.point);
      EXPECT_NEAR(resumed.best->zones[zone].area_fraction, expected.best->zones[zone].area_fraction, 1e-9);
    }
  }
}

TEST(BestSoFar, FractionsAreMultiplesOfTheStep) {
  const Study study = lobes("area_fraction_step = 0.05\n", nullptr, nullptr, 0);
  const ComposeRequest request = read_compose(study);
  EXPECT_EQ(request.area_steps, std::optional<std::size_t>(20));
  compute::ResultStore store("", compose_layout(study), compute::IfExists::refuse);
  const Composition composition = compose(study, request, store, nullptr, nullptr);
  ASSERT_TRUE(composition.best.has_value());
  double sum = 0.0;
  for (const Zone& zone : composition.best->zones) {
    EXPECT_NEAR(20.0 * zone.area_fraction, std::round(20.0 * zone.area_fraction), 1e-9);
    sum += zone.area_fraction;
  }
  EXPECT_NEAR(sum, 1.0, 1e-12);
  EXPECT_LE(composition.best->mixture.merit, composition.unlimited_merit + 1e-12);
}

/// Quantity with a given standard error.
class Uncertain : public Quantity {
 public:
  Uncertain(std::shared_ptr<const Quantity> exact, double std_error)
      : Quantity(exact->name()), exact_(std::move(exact)), std_error_(std_error) {}
  std::optional<Measured> measure(const Candidate& candidate, const Cancellation* cancel) const override {
    std::optional<Measured> measured = exact_->measure(candidate, cancel);
    if (measured) measured->std_error = std_error_;
    return measured;
  }

 private:
  std::shared_ptr<const Quantity> exact_;
  double std_error_;
};

/// Composes the study of two goals whose values have a standard error.
Composition composed_with_error(double std_error) {
  Study study = lobes("", nullptr, nullptr, 0);
  for (auto& quantity : study.quantities) quantity = std::make_shared<Uncertain>(quantity, std_error);
  compute::ResultStore store("", compose_layout(study), compute::IfExists::refuse);
  return compose(study, read_compose(study), store, nullptr, nullptr);
}

/// Returns the smallest number of equal steps of which all area fractions are multiples, or 0 if there is none.
int steps_of(const Composition& composition) {
  for (const int steps : {10, 20, 50, 100, 200, 500, 1000}) {
    const auto is_multiple = [&](const Zone& zone) {
      return std::abs(steps * zone.area_fraction - std::round(steps * zone.area_fraction)) < 1e-9;
    };
    if (std::ranges::all_of(composition.best->zones, is_multiple)) return steps;
  }
  return 0;
}

TEST(BestSoFar, TheErrorOfTheGoalsDeterminesTheStepOfFractions) {
  const Composition exact = composed_with_error(0.0);
  ASSERT_TRUE(exact.best.has_value());
  int steps_before = 1'000'000;
  for (const double error : {1e-3, 1e-2, 1e-1}) {
    SCOPED_TRACE(error);
    const Composition rounded = composed_with_error(error);
    ASSERT_TRUE(rounded.best.has_value());
    const int steps = steps_of(rounded);
    EXPECT_GT(steps, 0);
    EXPECT_LE(steps, steps_before);
    EXPECT_GE(rounded.best->mixture.merit, exact.best->mixture.merit - error);
    steps_before = steps;
  }
  EXPECT_EQ(steps_before, 10);
}

TEST(BestSoFar, CellsRespectTheWidthOfTheTool) {
  const Functions functions = {{"g.1", lobe_at(0.8)}};
  const std::string keys = "[compose]\nmaximize = [\"g.1\"]\n[machining]\ntool_width_mm = 2\n";
  const ComposeRequest request = read_compose(with_machining_limits(analytic_study(keys, functions)));
  ASSERT_EQ(request.cell_constraints.size(), 1U);
  EXPECT_EQ(request.cell_constraints.front().quantity, "tool_fit_mm");
  EXPECT_EQ(request.cell_constraints.front().min, 0.0);
  EXPECT_TRUE(read_compose(analytic_study(keys, functions)).cell_constraints.empty()) << "not computed by the study";
}

/// The test compares the result with all neighbouring multiples of the step, for three cells.
TEST(BestSoFar, TheRoundedMixtureIsTheBestOfItsNeighbours) {
  const std::vector<MixedCell> cells = {
      {{1.0, 0.2, 0.3}, {0.5}, 0.0}, {{0.1, 0.9, 0.4}, {1.5}, 0.1}, {{0.3, 0.2, 1.1}, {2.5}, 0.0}};
  MixtureRules rules;
  rules.means = {{0.0, 1.6}};
  const Mixture mixture = best_mixture(cells, rules);
  ASSERT_TRUE(mixture.is_feasible());
  constexpr int steps = 10;
  const Mixture rounded = rounded_mixture(cells, rules, mixture, steps);
  std::vector<double> fractions(cells.size(), 0.0);
  for (const ZoneFraction& zone : mixture.zones) fractions[zone.cell] = zone.fraction;
  double best = -1e9;
  for (int a = 0; a <= steps; ++a)
    for (int b = 0; a + b <= steps; ++b) {
      const double parts[] = {a / 10.0, b / 10.0, (steps - a - b) / 10.0};
      double goals[3] = {};
      double mean = 0.0;
      bool is_near = true;
      for (std::size_t k = 0; k < cells.size(); ++k) {
        for (std::size_t goal = 0; goal < 3; ++goal) goals[goal] += parts[k] * cells[k].goals[goal];
        mean += parts[k] * cells[k].means[0];
        is_near = is_near && std::abs(parts[k] - fractions[k]) < 0.1;
      }
      if (is_near && mean <= 1.6 + 1e-12)
        best = std::max(best, std::min({goals[0], goals[1], goals[2]}) - parts[1] * cells[1].cost);
    }
  EXPECT_NEAR(rounded.merit, best, 1e-12);
  EXPECT_LE(rounded.merit, mixture.merit + 1e-12);
}

TEST(BestSoFar, TheStepOfFractionsIsChecked) {
  const auto place = [](const std::string& step) {
    return refusal_of([&] { read_compose(lobes("area_fraction_step = " + step + "\n", nullptr, nullptr, 0)); }, "read");
  };
  EXPECT_EQ(place("0.01"), "read");
  for (const char* const step : {"0", "0.7", "0.3", "\"small\""})
    EXPECT_EQ(place(step), "examples/studies/study.toml:21: compose.area_fraction_step") << step;
}

}  // namespace
}  // namespace retrace::testing::best_so_far_test
