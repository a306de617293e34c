// Tests of compositions, which mix cells so that the smallest of several goals becomes as large as possible. The cells
// are analytic functions. Results are compared with closed forms, exhaustive search and `optimise`. Reading, messages
// and storage are also tested.

#include "studies/compose/compose.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "studies/compose/io/compose_reader.h"
#include "studies/compose/io/composition_files.h"
#include "studies/optimise/io/optimise_reader.h"
#include "studies/quantity/io/study_reader.h"
#include "tests/support/analytic_study.h"
#include "tests/support/killed_runs.h"
#include "tests/support/refusals.h"

namespace retrace::testing::compose_test {
namespace {

using namespace studies;
using test::Analytic, test::analytic_study, test::Functions, test::kIntervals;

/// Returns a function of the center x and the sharpness y of a lobe: the value of the lobe at the given point. The lobe
/// is narrower and higher for larger y.
Analytic::Function lobe_at(double point) {
  return [point](double x, double y) { return y * std::exp(-std::pow(y * (x - point), 2.0)); };
}
const Functions kThreePoints = {{"g.1", lobe_at(0.8)}, {"g.2", lobe_at(1.6)}, {"g.3", lobe_at(2.7)}};

struct Composed {
  Study study;
  ComposeRequest request;
  Composition composition;
};

Composed composed(const Study& study) {
  compute::ResultStore store("", compose_layout(study), compute::IfExists::refuse);
  const ComposeRequest request = read_compose(study);
  return {study, request, compose(study, request, store, nullptr, nullptr)};
}

double number(const ParameterValue& value) {
  return std::get<double>(value.shown);
}

constexpr const char* kMaximize = "[compose]\nmaximize = \"g\"\n";

TEST(Compose, OfTwoLobesHasTheSharesAndPricesOfTheClosedForm) {
  // There are two cells and three goals. Only the first and the last goal limit the minimum goal of a mixture.
  const Study study = analytic_study(kMaximize, kThreePoints,
                                     "[[parameter]]\nkey = \"body.thickness_mm\"\nname = \"x\"\nvalues = [1.1, 2.1]\n");
  const Composition composition = composed(study).composition;
  ASSERT_TRUE(composition.best.has_value());
  const auto at = [&](double x, std::size_t goal) { return kThreePoints[goal].second(x, 1.0); };
  const double f0 = at(1.1, 0), f2 = at(1.1, 2), g0 = at(2.1, 0), g2 = at(2.1, 2);
  const double share = (g2 - g0) / (f0 - f2 + g2 - g0);
  const double price = (g2 - f2) / (f0 - g0 + g2 - f2);
  ASSERT_EQ(composition.best->zones.size(), 2U);
  for (const Zone& zone : composition.best->zones)
    EXPECT_NEAR(zone.area_fraction, number(zone.cell.values[0]) == 1.1 ? share : 1.0 - share, 1e-9);
  EXPECT_NEAR(composition.best->mixture.prices.goals[0], price, 1e-9);
  EXPECT_NEAR(composition.best->mixture.prices.goals[1], 0.0, 1e-9);
  EXPECT_NEAR(composition.best->mixture.prices.goals[2], 1.0 - price, 1e-9);
  EXPECT_EQ(composition.proof, Proof::family);
}

TEST(Compose, IsNeverWorseThanThreeZonesOnAGrid) {
  const Composition composition =
      composed(analytic_study(std::string(kMaximize) + "max_zones = 3\n", kThreePoints)).composition;
  ASSERT_TRUE(composition.best.has_value());
  EXPECT_LE(composition.best->zones.size(), 3U);
  std::vector<std::array<double, 3>> cells;
  for (double x = 0.5; x <= 3.0; x += 0.25)
    for (double y = 1.0; y <= 3.0; y += 0.5)
      cells.push_back({kThreePoints[0].second(x, y), kThreePoints[1].second(x, y), kThreePoints[2].second(x, y)});
  double best = 0.0;
  for (std::size_t a = 0; a < cells.size(); ++a)
    for (std::size_t b = a + 1; b < cells.size(); ++b)
      for (std::size_t c = b + 1; c < cells.size(); ++c)
        for (int i = 0; i <= 20; ++i)
          for (int j = 0; i + j <= 20; ++j) {
            double least = 1e9;
            for (std::size_t goal = 0; goal < 3; ++goal)
              least = std::min(least, (i * cells[a][goal] + j * cells[b][goal] + (20 - i - j) * cells[c][goal]) / 20.0);
            best = std::max(best, least);
          }
  EXPECT_GE(composition.best->mixture.min_goal, best);
}

TEST(Compose, FindsTheBestOfAContinuousFamily) {
  // The distances of the three points are large compared with the widths of the lobes. The best composition has one
  // narrow lobe at each point, with equal fractions. Each goal is then a third of the height of a lobe, plus small
  // contributions of the other lobes.
  const Functions far = {{"g.1", lobe_at(0.5)}, {"g.2", lobe_at(1.75)}, {"g.3", lobe_at(3.0)}};
  const Composition composition = composed(analytic_study(kMaximize, far)).composition;
  ASSERT_TRUE(composition.best.has_value());
  const auto top = [&](double between) { return std::exp(-std::pow(3.0 * between, 2.0)); };
  EXPECT_NEAR(composition.best->mixture.min_goal, 1.0 + top(1.25), 1e-3);
  EXPECT_TRUE(composition.has_converged);
  EXPECT_EQ(composition.proof, Proof::catalogue);
}

TEST(Compose, WithOneZoneFindsWhatOptimiseFinds) {
  const Functions functions = {{"g.1", lobe_at(1.2)}, {"g.2", lobe_at(1.9)}, {"least", [](double x, double y) {
                                                                                return std::min(lobe_at(1.2)(x, y),
                                                                                                lobe_at(1.9)(x, y));
                                                                              }}};
  const Study study =
      analytic_study("[optimize]\nmaximize = \"least\"\n[compose]\nmaximize = \"g\"\nmax_zones = 1\n", functions);
  compute::ResultStore store("", optimise_layout(study), compute::IfExists::refuse);
  const Optimum optimum = optimise(study, read_optimise(study), store, nullptr, nullptr);
  const Composition composition = composed(study).composition;
  ASSERT_TRUE(composition.best && optimum.best);
  ASSERT_EQ(composition.best->zones.size(), 1U);
  EXPECT_EQ(composition.best->zones[0].area_fraction, 1.0);
  EXPECT_GE(composition.best->mixture.min_goal, *optimum.best->objective);
  // The minimum of two functions has a kink at its maximum. An optimizer without derivatives only approximates this
  // maximum.
  EXPECT_NEAR(composition.best->mixture.min_goal, *optimum.best->objective, 2e-3);
  ASSERT_TRUE(composition.single.has_value());
  EXPECT_EQ(std::min(composition.single->mixed.goals[0], composition.single->mixed.goals[1]), *optimum.best->objective);
}

TEST(Compose, HoldsConstraintsOverCellsAndThePart) {
  Functions functions = kThreePoints;
  functions.emplace_back("thickness", [](double x, double) { return x; });
  functions.emplace_back("index", [](double, double y) { return y; });
  const Composition composition =
      composed(analytic_study("[compose]\nmaximize = \"g\"\nmin_area_fraction = 0.1\nmax_area_fraction = 0.5\n"
                              "[[constraint]]\nquantity = \"index\"\nmax = 2\n"
                              "[[constraint]]\nquantity = \"thickness\"\nmax = 1.5\nover = \"part\"\n",
                              functions))
          .composition;
  ASSERT_TRUE(composition.best.has_value());
  double thickness = 0.0;
  for (const Zone& zone : composition.best->zones) {
    EXPECT_LE(number(zone.cell.values[1]), 2.0);
    EXPECT_GE(zone.area_fraction, 0.1 - 1e-9);
    EXPECT_LE(zone.area_fraction, 0.5 + 1e-9);
    thickness += zone.area_fraction * number(zone.cell.values[0]);
  }
  EXPECT_LE(thickness, 1.5 + 1e-9);
  EXPECT_GT(composition.best->mixture.prices.means[0], 0.0);
}

TEST(Compose, PaysWhatIsAskedAndDrawsTheFront) {
  Functions functions = kThreePoints;
  functions.emplace_back("hours", [](double, double y) { return y; });
  const auto with_price = [&](const std::string& price) {
    return composed(analytic_study(
                        "[compose]\nmaximize = \"g\"\nfront = {hours = \"min\"}\nprice = {hours = " + price + "}\n",
                        functions))
        .composition;
  };
  const Composition free = with_price("0");
  const Composition dear = with_price("0.2");
  ASSERT_TRUE(free.best && dear.best);
  EXPECT_LT(dear.best->mixture.means.back(), free.best->mixture.means.back());
  EXPECT_LT(dear.best->mixture.min_goal, free.best->mixture.min_goal);
  EXPECT_NEAR(dear.best->mixture.merit, dear.best->mixture.min_goal - 0.2 * dear.best->mixture.means.back(), 1e-12);
  ASSERT_EQ(free.front.size(), 9U);
  for (std::size_t k = 1; k < free.front.size(); ++k) {
    EXPECT_GE(free.front[k].mean, free.front[k - 1].mean - 1e-9);
    EXPECT_GE(free.front[k].min_goal, free.front[k - 1].min_goal - 1e-9);
  }
  EXPECT_NEAR(free.front.back().min_goal, free.best->mixture.min_goal, 1e-9);
}

TEST(Compose, SaysWhatOneZoneMoreIsWorth) {
  const Composition composition =
      composed(analytic_study(std::string(kMaximize) + "max_zones = 2\n", kThreePoints)).composition;
  ASSERT_TRUE(composition.best.has_value());
  ASSERT_EQ(composition.by_zones.size(), 3U);
  for (std::size_t k = 1; k < 3; ++k)
    EXPECT_GE(composition.by_zones[k].mixture.min_goal, composition.by_zones[k - 1].mixture.min_goal);
  EXPECT_NEAR(composition.by_zones[1].mixture.min_goal, composition.best->mixture.min_goal, 1e-12);
  EXPECT_GE(composition.unlimited_merit, composition.by_zones[2].mixture.min_goal - 1e-12);
}

TEST(Compose, GoesOnWithWhatTheStoreHas) {
  const Study study = analytic_study(kMaximize, kThreePoints);
  const ComposeRequest request = read_compose(study);
  compute::ResultStore store("", compose_layout(study), compute::IfExists::refuse);
  const Composition first = compose(study, request, store, nullptr, nullptr);
  Cancellation cancel;
  cancel.request();
  const Composition cut = compose(study, request, store, nullptr, &cancel);
  EXPECT_FALSE(cut.complete);
  EXPECT_GT(cut.evaluations, 0U);
  EXPECT_LE(cut.evaluations, first.evaluations);
  const Composition again = compose(study, request, store, nullptr, nullptr);
  EXPECT_EQ(composition_json(study, request, again, 0.0), composition_json(study, request, first, 0.0));
  EXPECT_EQ(store.finished().size(), first.evaluations);
}

TEST(Compose, IsTheSameWhateverAKilledRunLeft) {
  const Study study = analytic_study(std::string(kMaximize) + "max_zones = 2\nscan = 17\n", kThreePoints);
  const ComposeRequest request = read_compose(study);
  compute::ResultStore whole("", compose_layout(study), compute::IfExists::refuse);
  const std::string expected = composition_json(study, request, compose(study, request, whole, nullptr, nullptr), 0.0);
  const std::vector<compute::StoredPoint> points = whole.points();
  ASSERT_GT(points.size(), 40U);
  for_each_killed_run(points, compose_layout(study), [&](compute::ResultStore& left) {
    EXPECT_EQ(composition_json(study, request, compose(study, request, left, nullptr, nullptr), 0.0), expected);
  });
}

TEST(Compose, IsTheSameWhateverOtherRunsLeft) {
  const auto zones_of = [](const Composition& composition) {
    std::vector<std::pair<double, double>> zones;
    for (const Zone& zone : composition.best->zones)
      zones.emplace_back(number(zone.cell.values[0]), zone.area_fraction);
    return zones;
  };
  const Study other = analytic_study(std::string(kMaximize) + "max_zones = 3\nscan = 33\n", kThreePoints);
  const Study study = analytic_study(std::string(kMaximize) + "max_zones = 2\nscan = 17\n", kThreePoints);
  compute::ResultStore store("", compose_layout(other), compute::IfExists::refuse);
  compose(other, read_compose(other), store, nullptr, nullptr);
  const Composition after = compose(study, read_compose(study), store, nullptr, nullptr);
  const Composition alone = composed(study).composition;
  EXPECT_EQ(zones_of(after), zones_of(alone));
  EXPECT_EQ(after.evaluations, alone.evaluations);
}

TEST(Compose, ReportsTheBoundsThatExcludeAllMixtures) {
  const Composed low = composed(analytic_study(std::string(kMaximize) + "min_goal = 5\n", kThreePoints));
  ASSERT_TRUE(low.composition.best);
  const Mixture& mixture = low.composition.best->mixture;
  EXPECT_LT(mixture.min_goal, *low.request.min_goal);
  EXPECT_GT(mixture.prices.goals[0], 0.0);
  EXPECT_TRUE(low.composition.infeasible_bounds.empty());
  record_message(why_not_reached(low.study, low.request, low.composition));
  Functions functions = kThreePoints;
  functions.emplace_back("thickness", [](double x, double) { return x; });
  const Composed none = composed(analytic_study(
      std::string(kMaximize) + "[[constraint]]\nquantity = \"thickness\"\nmax = 0.1\nover = \"part\"\n", functions));
  EXPECT_FALSE(none.composition.best.has_value());
  EXPECT_EQ(none.composition.infeasible_bounds, (std::vector<std::size_t>{0}));
  record_message(why_not_reached(none.study, none.request, none.composition));
}

TEST(Compose, DocumentsHoldWhatWasFound) {
  const Composed made = composed(analytic_study(kMaximize, kThreePoints));
  const auto json = nlohmann::json::parse(composition_json(made.study, made.request, made.composition, 1.0));
  EXPECT_EQ(json.at("schema"), "retrace.composition/2");
  double shares = 0.0, prices = 0.0;
  for (const auto& zone : json.at("zones")) shares += zone.at("area_fraction").get<double>();
  for (const auto& goal : json.at("goals")) {
    prices += goal.at("price").get<double>();
    double given = 0.0;
    for (const auto& part : goal.at("given_by_zones")) given += part.get<double>();
    EXPECT_NEAR(given, goal.at("value").get<double>(), 1e-12);
  }
  EXPECT_NEAR(shares, 1.0, 1e-9);
  EXPECT_NEAR(prices, 1.0, 1e-9);
  const std::string csv = composition_csv(made.study, made.request, made.composition);
  EXPECT_EQ(std::ranges::count(csv, '\n'), 4);
  EXPECT_NE(composition_text(made.study, made.request, made.composition).find("binding: "), std::string::npos);
}

/// Returns the message with which a study with these keys is refused.
std::string refusal(const std::string& keys, const std::string& parameters = kIntervals) {
  try {
    read_compose(analytic_study(keys, kThreePoints, parameters));
  } catch (const InputError& error) {
    return recorded_place_of(error);
  }
  return {};
}

TEST(Compose, ReadsItsExample) {
  const std::string file = test::kStudies + "compose_reflector.toml";
  EXPECT_NO_THROW(read_compose(read_study(file, {})));
}

TEST(Compose, ReadsFormerNamesOfItsKeys) {
  const ComposeRequest request = read_compose(analytic_study(
      "[compose]\nmaximize = \"g\"\nleast = 0.3\nmost_zones = 3\nleast_share = 0.1\nmost_share = 0.6\nlooks = 7\n"
      "front = {\"g.1\" = \"least\"}\n",
      kThreePoints));
  EXPECT_EQ(request.min_goal, 0.3);
  EXPECT_EQ(request.max_zones, 3U);
  EXPECT_EQ(request.min_area_fraction, 0.1);
  EXPECT_EQ(request.max_area_fraction, 0.6);
  EXPECT_EQ(request.evaluations_per_start, 7);
  ASSERT_TRUE(request.front.has_value());
  EXPECT_FALSE(request.front->is_maximized);
}

TEST(Compose, RefusesWhatMeansNothing) {
  expect_refusals(
      [](const std::string& keys) { return refusal(keys); },
      {{"", "examples/studies/study.toml: compose"},
       {"[compose]\nmaximize = \"h\"\n", "examples/studies/study.toml:22: compose.maximize"},
       {"[compose]\nmaximize = [\"g\", \"g.1\"]\n", "examples/studies/study.toml:22: compose.maximize"},
       {"[compose]\nmaximize = \"g\"\nmin_area_fraction = 0.6\nmax_area_fraction = 0.5\n",
        "examples/studies/study.toml:23: compose.min_area_fraction"},
       {"[compose]\nmaximize = \"g\"\nmax_zones = 2\nmax_area_fraction = 0.4\n",
        "examples/studies/study.toml:24: compose.max_area_fraction"},
       {"[compose]\nmaximize = \"g\"\nprice = {h = 1}\n", "examples/studies/study.toml:23: compose.price.h"},
       {"[compose]\nmaximize = \"g\"\nfront = {g = \"max\", h = \"min\"}\n",
        "examples/studies/study.toml:23: compose.front"},
       {"[compose]\nmaximize = \"g\"\nmin_area_fraction = 2\n",
        "examples/studies/study.toml:23: compose.min_area_fraction"}});
  EXPECT_EQ(refusal(kMaximize,
                    "[[parameter]]\nkey = \"body.thickness_mm\"\ndistribution = \"normal\"\nmean = 1\nsigma = 0.1\n"),
            "examples/studies/study.toml:2: parameter[1]");
}

}  // namespace
}  // namespace retrace::testing::compose_test
