#include "studies/optimise/optimise.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <memory>
#include <utility>

#include "core/error.h"
#include "studies/optimise/io/optimise_reader.h"
#include "studies/optimise/io/optimum_files.h"
#include "studies/quantity/io/study_reader.h"
#include "tests/support/analytic_study.h"
#include "tests/support/killed_runs.h"
#include "tests/support/refusals.h"

namespace retrace::studies::optimise_test {
namespace {

using test::Analytic, test::analytic_study, test::kStudies;

Optimum optimum_of(const Study& study) {
  compute::ResultStore store("", optimise_layout(study), compute::IfExists::refuse);
  return optimise(study, read_optimise(study), store, nullptr, nullptr);
}

double number(const ParameterValue& value) {
  return std::get<double>(value.shown);
}

TEST(Optimise, ReachesTheTopOfAParaboloid) {
  const Study study = analytic_study(
      "[optimize]\nmaximize = \"f\"\n",
      {{"f", [](double x, double y) { return 1.0 - std::pow(x - 1.7, 2) - 2.0 * std::pow(y - 2.2, 2); }}});
  const Optimum optimum = optimum_of(study);
  ASSERT_TRUE(optimum.best.has_value());
  EXPECT_NEAR(number(optimum.best->values[0]), 1.7, 2e-3);
  EXPECT_NEAR(number(optimum.best->values[1]), 2.2, 2e-3);
  EXPECT_NEAR(*optimum.best->objective, 1.0, 2e-6);
}

/// Records the groups of designs that an optimization computes.
class Groups : public OptimiseObserver {
 public:
  void at(std::size_t) override {}
  void at_group(double share, std::size_t designs) override {
    if (share == 0.0) sizes.push_back(designs);
    if (share > 0.0) {
      EXPECT_GT(share, last);
    }
    last = share;
    finished += share == 1.0 ? designs : 0;
  }
  std::vector<std::size_t> sizes;
  std::size_t finished = 0;
  double last = 0.0;
};

TEST(Optimise, ReportsTheProgressOfEachGroupOfDesigns) {
  const Study study = analytic_study("[optimize]\nmaximize = \"f\"\nscan = 20\n",
                                     {{"f", [](double x, double y) { return -std::pow(x - 1.7, 2) - y; }}});
  compute::ResultStore store("", optimise_layout(study), compute::IfExists::refuse);
  Groups groups;
  const Optimum optimum = optimise(study, read_optimise(study), store, &groups, nullptr);
  ASSERT_FALSE(groups.sizes.empty());
  EXPECT_EQ(groups.finished, optimum.designs.size()) << "each design belongs to one group, and each group is finished";
  Groups again;
  optimise(study, read_optimise(study), store, &again, nullptr);
  EXPECT_TRUE(again.sizes.empty()) << "designs of the store are not computed";
}

/// A quantity with a known derivative with respect to the thickness. It counts how often the derivative is requested.
class WithSlope : public Quantity {
 public:
  using Function = std::function<double(double thickness_mm)>;
  WithSlope(Function f, Function slope) : Quantity("f"), f_(std::move(f)), slope_(std::move(slope)) {}
  std::optional<Measured> measure(const Candidate& candidate, const Cancellation*) const override {
    return Measured{f_(candidate.design().part().thickness_mm), 0.0};
  }
  std::optional<double> slope(const Candidate& candidate, RreParameter parameter, const Cancellation*) const override {
    EXPECT_EQ(parameter, RreParameter::thickness_mm);
    ++asked;
    return slope_(candidate.design().part().thickness_mm);
  }
  mutable int asked = 0;

 private:
  Function f_;
  Function slope_;
};

TEST(Optimise, SlopesServeWhereThereAreAny) {
  Study study = parse_study(
      "design = \"../rtp_brick_1mm.toml\"\n[[parameter]]\nkey = \"body.thickness_mm\"\nfrom = 0.5\nto = 3\n"
      "[[quantity]]\nkind = \"elements_full\"\nname = \"f\"\n[optimize]\nmaximize = \"f\"\nscan = 4\n",
      kStudies + "study.toml");
  constexpr double top_mm = 1.2345678;
  const auto f = [](double x) { return 1.0 - std::pow(x - top_mm, 2); };
  const auto quantity = std::make_shared<WithSlope>(f, [](double x) { return -2.0 * (x - top_mm); });
  study.quantities = {quantity};
  const Optimum optimum = optimum_of(study);
  EXPECT_EQ(optimum.method, "exact slopes");
  EXPECT_GT(quantity->asked, 1);
  compute::ResultStore store("", optimise_layout(study), compute::IfExists::refuse);
  const OptimiseRequest request = read_optimise(study);
  optimise(study, request, store, nullptr, nullptr);
  // The designs that were evaluated with derivatives include the maximum itself. The design that the program chooses
  // has rounder values and is equally good within the tolerance.
  double nearest_mm = 1.0;
  for (const compute::StoredPoint& point : store.points())
    nearest_mm = std::min(nearest_mm, std::abs(std::get<double>(point.inputs[0]) - top_mm));
  EXPECT_LT(nearest_mm, 1e-7);
  EXPECT_NEAR(number(optimum.best->values[0]), top_mm, 1e-3);
}

/// At normal incidence, the RRE increases with the index, because of the light that half elements reflect. The optimum
/// is therefore at the end of the interval. It is found with the derivatives of the exact engine.
TEST(Optimise, SlopesOfTheExactEngineServe) {
  const Study study = parse_study(
      "design = \"../rtp_brick_1mm.toml\"\n[[parameter]]\nkey = \"body.refractive_index\"\nfrom = 1.45\nto = 1.6\n"
      "[[quantity]]\nkind = \"rre\"\n[analysis]\nengine = \"exact\"\n[optimize]\nmaximize = \"rre\"\nscan = 3\n",
      kStudies + "study.toml");
  const Optimum optimum = optimum_of(study);
  ASSERT_TRUE(optimum.best.has_value());
  EXPECT_EQ(optimum.method, "exact slopes");
  EXPECT_EQ(number(optimum.best->values[0]), 1.6);
  const double r = std::pow(0.6 / 2.6, 2);
  EXPECT_NEAR(*optimum.best->objective, 0.95 + 0.05 * 2.0 * r / (1.0 + r), 1e-9);
}

TEST(Optimise, ReachesAnOptimumOnAConstraint) {
  // The optimum is the point with x + y <= 3 that is closest to (2, 2).
  const Study study =
      analytic_study("[optimize]\nminimize = \"f\"\n[[constraint]]\nquantity = \"g\"\nmax = 3\n",
                     {{"f", [](double x, double y) { return std::pow(x - 2.0, 2) + std::pow(y - 2.0, 2); }},
                      {"g", [](double x, double y) { return x + y; }}});
  const Optimum optimum = optimum_of(study);
  ASSERT_TRUE(optimum.best.has_value());
  EXPECT_NEAR(number(optimum.best->values[0]), 1.5, 5e-3);
  EXPECT_NEAR(number(optimum.best->values[1]), 1.5, 5e-3);
  EXPECT_NEAR(-*optimum.best->objective, 0.5, 1e-4);
  EXPECT_LE(*optimum.best->outputs[1].value, 3.0);
  ASSERT_FALSE(optimum.rejected.empty());
  EXPECT_EQ(optimum.rejected.front().variant.broken, (std::vector<std::size_t>{0}));
  EXPECT_GT(*optimum.rejected.front().variant.objective, *optimum.best->objective);
}

TEST(Optimise, TheFrontHasNoDominatedPoint) {
  const Study study = analytic_study("[optimize]\nmaximize = {f = 1, g = -0.5}\nfront = {f = \"max\", g = \"min\"}\n",
                                     {{"f", [](double x, double y) { return x + std::sin(3.0 * y); }},
                                      {"g", [](double x, double y) { return x * y; }}});
  const Optimum optimum = optimum_of(study);
  ASSERT_GE(optimum.front.size(), 3U);
  const auto f = [](const Variant& v) { return *v.outputs[0].value; };
  const auto g = [](const Variant& v) { return *v.outputs[1].value; };
  for (const Variant& a : optimum.front)
    for (const Variant& b : optimum.front) EXPECT_FALSE(f(a) >= f(b) && g(a) <= g(b) && (f(a) > f(b) || g(a) < g(b)));
  // The maximum of a weighted sum is on the Pareto front.
  for (const Variant& v : optimum.front) EXPECT_GE(*optimum.best->objective, f(v) - 0.5 * g(v) - 1e-5);
}

TEST(Optimise, FormerWordsOfTheFrontKeepTheirMeaning) {
  for (const char* const front : {"{f = \"max\", g = \"min\"}", "{f = \"most\", g = \"least\"}"}) {
    const std::vector<FrontAxis> axes =
        read_optimise(
            analytic_study(std::string("[optimize]\nmaximize = \"f\"\nfront = ") + front + "\n",
                           {{"f", [](double x, double) { return x; }}, {"g", [](double, double y) { return y; }}}))
            .front;
    ASSERT_EQ(axes.size(), 2U) << front;
    EXPECT_EQ(axes[0].quantity, "f");
    EXPECT_TRUE(axes[0].is_maximized) << front;
    EXPECT_FALSE(axes[1].is_maximized) << front;
  }
}

TEST(Optimise, FormerKindsAreNamesOfQuantities) {
  const std::string former = "full_element_share";
  const std::string current = "full_element_area_fraction";
  for (const std::string& kind : {former, current})
    for (const std::string& name : {former, current}) {
      const Study study = parse_study(
          "design = \"../rtp_brick_1mm.toml\"\n[[parameter]]\nkey = \"body.thickness_mm\"\nfrom = 1\nto = 3\n"
          "[[quantity]]\nkind = \"" +
              kind + "\"\n[optimize]\nmaximize = \"" + name + "\"\n[[constraint]]\nquantity = \"" + name +
              "\"\nmin = 0.1\n",
          kStudies + "study.toml");
      EXPECT_EQ(study.quantities.at(0)->name(), kind);  // the column has the name that the study file uses
      const OptimiseRequest request = read_optimise(study);
      EXPECT_EQ(request.objective.weights.at(0).first, kind) << name;
      EXPECT_EQ(request.constraints.at(0).quantity, kind) << name;
    }
}

TEST(Optimise, DiscreteAndContinuousTogether) {
  Study study = parse_study(
      "design = \"../rtp_brick_1mm.toml\"\n[[parameter]]\nkey = \"body.thickness_mm\"\nvalues = [1, 2, 3]\n"
      "[[parameter]]\nkey = \"body.back_index\"\nfrom = 1\nto = 3\n"
      "[[quantity]]\nkind = \"elements_full\"\nname = \"f\"\n[optimize]\nmaximize = \"f\"\n",
      kStudies + "study.toml");
  study.quantities = {std::make_shared<Analytic>(
      "f", [](double x, double y) { return -std::pow(x - 2.2, 2) - std::pow(y - 0.5 * x - 0.3, 2); })};
  const Optimum optimum = optimum_of(study);
  EXPECT_EQ(number(optimum.best->values[0]), 2.0);
  EXPECT_NEAR(number(optimum.best->values[1]), 1.3, 1e-3);
  for (const Rejected& rejected : optimum.rejected) EXPECT_FALSE(rejected.why.empty()) << rejected.role;
}

TEST(Optimise, ReportsTheConstraintThatExcludesAllDesigns) {
  const Study study = analytic_study(
      "[optimize]\nmaximize = \"f\"\n[[constraint]]\nquantity = \"f\"\nmin = 7\n"
      "[[constraint]]\nquantity = \"f\"\nmin = 0\n",
      {{"f", [](double x, double) { return x; }}});
  const Optimum optimum = optimum_of(study);
  EXPECT_FALSE(optimum.best.has_value());
  ASSERT_EQ(optimum.exclusions.size(), 2U);
  EXPECT_EQ(optimum.exclusions[0].designs, optimum.designs.size());
  EXPECT_EQ(optimum.exclusions[0].min_violation, 4.0);
  EXPECT_EQ(optimum.exclusions[1].designs, 0U);
  EXPECT_EQ(optimum.exclusions[1].min_violation, 0.0);
  record_message(optimum.infeasible_reason);
}

TEST(Optimise, AResumedSearchComputesNothingAgain) {
  std::atomic<int> computed = 0;
  const Study study = analytic_study("[optimize]\nmaximize = \"f\"\nscan = 20\n", {{"f", [&](double x, double y) {
                                                                                      ++computed;
                                                                                      return -x * x - y;
                                                                                    }}});
  compute::ResultStore store("", optimise_layout(study), compute::IfExists::refuse);
  const OptimiseRequest request = read_optimise(study);
  const Optimum first = optimise(study, request, store, nullptr, nullptr);
  const int once = computed.exchange(0);
  EXPECT_GT(once, 20);
  const Optimum second = optimise(study, request, store, nullptr, nullptr);
  EXPECT_EQ(computed, 0);
  EXPECT_EQ(second.best->number, first.best->number);
}

TEST(Optimise, IsTheSameWhateverAKilledRunLeft) {
  const Study study = analytic_study(
      "[optimize]\nmaximize = \"f\"\nscan = 20\n",
      {{"f", [](double x, double y) { return 1.0 - std::pow(x - 1.7, 2) - 2.0 * std::pow(y - 2.2, 2); }}});
  const OptimiseRequest request = read_optimise(study);
  compute::ResultStore whole("", optimise_layout(study), compute::IfExists::refuse);
  const std::string expected = optimum_json(study, request, optimise(study, request, whole, nullptr, nullptr), 0.0);
  const std::vector<compute::StoredPoint> points = whole.points();
  testing::for_each_killed_run(points, optimise_layout(study), [&](compute::ResultStore& left) {
    const Optimum optimum = optimise(study, request, left, nullptr, nullptr);
    EXPECT_EQ(optimum_json(study, request, optimum, 0.0), expected);
    EXPECT_EQ(left.finished(), whole.finished());
  });
}

/// This is the example study with fewer sizes below the smallest size that the tool can cut.
TEST(Optimise, TheSmallestPrismThatTheToolCutsIsChosenAndTheSingleOneRejectedByTheLens) {
  const Study whole = read_study(kStudies + "element_size.toml", std::vector<std::string>{});
  Study study = whole;
  study.parameters[0].interval->from = 0.8;
  OptimiseRequest request = read_optimise(study);
  request.scan = 21;
  compute::ResultStore store("", optimise_layout(study), compute::IfExists::refuse);
  const Optimum optimum = optimise(study, request, store, nullptr, nullptr);
  ASSERT_TRUE(optimum.best.has_value()) << optimum.infeasible_reason;
  EXPECT_EQ(number(optimum.best->values[0]), 1.0);
  EXPECT_NEAR(*optimum.best->objective, 0.953748, 1e-6);
  const Rejected& single = optimum.rejected.at(0);
  EXPECT_EQ(single.variant.broken, (std::vector<std::size_t>{0}));
  record_message(single.role);
  EXPECT_EQ(number(single.variant.values[0]), 10.0);
  // The entrance face reflects the fraction R (1 - R) of the light back into the part. This light returns after a
  // second round trip, with a deviation of 4 n e from the direction to the source. It is the first light that leaves
  // the acceptance cone of 0.5 degrees.
  ASSERT_EQ(optimum.bands.size(), 1U);
  EXPECT_NEAR(optimum.bands[0].up.value(), 60.0 * 0.5 / (4.0 * 1.4917), 2e-3);
  EXPECT_NEAR(optimum.bands[0].down.value(), 60.0 * 0.5 / (4.0 * 1.4917), 2e-3);
  record_message(single.why);
}

TEST(Optimise, AKeyThatIsACurveHasNoBand) {
  Study study = read_study(kStudies + "element_size.toml",
                           std::vector<std::string>{"body.absorption_per_mm=[[400, 0], [700, 0]]"});
  study.parameters[0].interval->from = 0.8;
  OptimiseRequest request = read_optimise(study);
  request.scan = 3;
  request.band_keys = {"body.absorption_per_mm"};
  compute::ResultStore store("", optimise_layout(study), compute::IfExists::refuse);
  const Optimum optimum = optimise(study, request, store, nullptr, nullptr);
  ASSERT_EQ(optimum.bands.size(), 1U);
  EXPECT_FALSE(optimum.bands[0].up.has_value());
  EXPECT_FALSE(optimum.bands[0].down.has_value());
}

TEST(Optimise, WhatIsWrongIsSaidWithItsLine) {
  const auto message = [](const std::string& keys) -> std::string {
    try {
      read_optimise(analytic_study(keys, {{"f", [](double x, double) { return x; }}}));
    } catch (const InputError& error) {
      return recorded_place_of(error);
    }
    return "";
  };
  expect_refusals(message,
                  {{"", "examples/studies/study.toml: optimize"},
                   {"[optimize]\nmaximize = \"ff\"\n", "examples/studies/study.toml:16: optimize.maximize"},
                   {"[optimize]\nscan = 5\n", "examples/studies/study.toml:15: optimize"},
                   {"[optimize]\nmaximize = \"f\"\nscan = 2\n", "examples/studies/study.toml:17: optimize.scan"},
                   {"[optimize]\nmaximize = \"f\"\n[[constraint]]\nquantity = \"f\"\n",
                    "examples/studies/study.toml:17: constraint[1].max"},
                   {"[optimize]\nmaximize = \"f\"\n[[constraint]]\nquantity = \"f\"\nmin = 2\nmax = 1\n",
                    "examples/studies/study.toml:20: constraint[1].max"}});
}

}  // namespace
}  // namespace retrace::studies::optimise_test
