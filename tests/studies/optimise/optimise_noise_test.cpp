// Tests of optimizations: random errors, interruptions, sizes that fill the part, and limits of the tool and the
// machine.

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <numbers>
#include <set>
#include <string>
#include <utility>

#include "core/error.h"
#include "design/io/design_reader.h"
#include "studies/optimise/important_parameters.h"
#include "studies/optimise/io/optimise_reader.h"
#include "studies/optimise/io/optimum_files.h"
#include "studies/optimise/optimise.h"
#include "studies/optimise/whole_sizes.h"
#include "studies/quantity/io/study_reader.h"
#include "studies/quantity/machine_plan.h"
#include "studies/quantity/machining_limits.h"
#include "tests/support/analytic_study.h"
#include "tests/support/refusals.h"

namespace retrace::studies::optimise_noise_test {
namespace {

using test::kStudies;

double number(const ParameterValue& value) {
  return std::get<double>(value.shown);
}

/// Quantity that adds a random error to a known function of the thickness. As for traced quantities, the error depends
/// on the seed and on the target error of the analysis.
class NoisyQuantity : public Quantity {
 public:
  using Function = std::function<double(double thickness_mm)>;
  using Action = std::function<void()>;
  NoisyQuantity(std::string name, Function f, Action action = {})
      : Quantity(std::move(name)), f_(std::move(f)), action_(std::move(action)) {}

  std::optional<Measured> measure(const Candidate& candidate, const Cancellation* cancel) const override {
    if (is_cancelled(cancel)) return std::nullopt;
    if (action_) action_();
    const double x = candidate.design().part().thickness_mm;
    const double error = candidate.analysis().target_error.value_or(kDefaultTargetError);
    const double phase = static_cast<double>(candidate.analysis().seed);
    const double noise = std::sin(1e4 * x + 7.0 * phase) + std::sin(3e5 * x * x + phase);
    return Measured{f_(x) + error * noise, error};
  }
  std::string tracing() const override { return "rre " + name(); }

 private:
  Function f_;
  Action action_;
};

/// Returns a study with the thickness as its parameter, from 0.5 to 3 mm, and with a noisy quantity `f`.
Study noisy_study(const NoisyQuantity::Function& f, const std::string& keys = "",
                  const NoisyQuantity::Action& action = {}) {
  Study study = parse_study(
      "design = \"../rtp_brick_1mm.toml\"\n[[parameter]]\nkey = \"body.thickness_mm\"\nname = \"x\"\nfrom = 0.5\n"
      "to = 3\n[[quantity]]\nkind = \"rre\"\nname = \"f\"\n[analysis]\nengine = \"montecarlo\"\n[optimize]\n"
      "maximize = \"f\"\n" +
          keys,
      kStudies + "study.toml");
  study.quantities = {std::make_shared<NoisyQuantity>("f", f, action)};
  return study;
}

double hill(double x) {
  return 0.7 - 0.05 * std::pow(x - 1.52, 2);
}

TEST(OptimiseNoise, TheResultIsRoundAndItsErrorIsStated) {
  const Study study = noisy_study(hill);
  compute::ResultStore store("", optimise_layout(study), compute::IfExists::refuse);
  const OptimiseRequest request = read_optimise(study);
  const Optimum optimum = optimise(study, request, store, nullptr, nullptr);
  ASSERT_TRUE(optimum.best.has_value());
  const double x = number(optimum.best->values[0]);
  EXPECT_GT(optimum.resolution, 0.0);
  EXPECT_LT(optimum.resolution, 6e-4) << "a few times the target error of 1e-4";
  EXPECT_LE(hill(1.52) - hill(x), optimum.resolution);
  EXPECT_NEAR(100.0 * x, std::round(100.0 * x), 1e-9) << "at most two decimals";
  EXPECT_NEAR(*optimum.best->objective, hill(x), 3.0 * optimum.best->objective_error);
  // Only a few designs may be computed with a small error.
  const auto accurate =
      std::ranges::count_if(optimum.designs, [](const Variant& variant) { return variant.objective_error < 3e-4; });
  EXPECT_LE(accurate, 12);
  EXPECT_GE(optimum.designs.size(), 60U);
  // If the search is repeated with the same store, it must have the same result without computing a design again.
  const std::size_t points = store.finished().size();
  const Optimum again = optimise(study, request, store, nullptr, nullptr);
  EXPECT_EQ(store.finished().size(), points);
  EXPECT_EQ(optimum_json(study, request, again, 0.0), optimum_json(study, request, optimum, 0.0));
}

TEST(OptimiseNoise, NoRoundingKeepsTheBestPoint) {
  const Study study = noisy_study(hill, "rounding = \"none\"\n");
  compute::ResultStore store("", optimise_layout(study), compute::IfExists::refuse);
  const Optimum optimum = optimise(study, read_optimise(study), store, nullptr, nullptr);
  EXPECT_LE(hill(1.52) - hill(number(optimum.best->values[0])), optimum.resolution);
}

/// Records the best designs that a search reports to its observer.
class BestDesigns : public OptimiseObserver {
 public:
  void at(std::size_t evaluated) override { count = evaluated; }
  void at_best(const Variant& best) override { reported.push_back(best); }
  std::vector<Variant> reported;
  std::size_t count = 0;
};

/// Interrupts the search after different numbers of computed designs.
TEST(OptimiseNoise, AnInterruptionLosesNoFinishedDesign) {
  const Study whole = noisy_study(hill);
  const OptimiseRequest request = read_optimise(whole);
  compute::ResultStore complete("", optimise_layout(whole), compute::IfExists::refuse);
  const std::string expected = optimum_json(whole, request, optimise(whole, request, complete, nullptr, nullptr), 0.0);
  const std::size_t points = complete.finished().size();
  for (const std::size_t end : {1U, 2U, 7U, 20U, 41U, 64U, 65U, 66U, 70U, 75U, 80U, 84U}) {
    SCOPED_TRACE("interrupted at design " + std::to_string(end));
    if (end >= points) break;
    Cancellation cancel;
    std::atomic<std::size_t> computed = 0;
    const Study study = noisy_study(hill, "", [&] {
      if (++computed == end) cancel.request();
    });
    compute::ResultStore store("", optimise_layout(study), compute::IfExists::refuse);
    BestDesigns observer;
    const Optimum optimum = optimise(study, request, store, &observer, &cancel);
    EXPECT_FALSE(optimum.complete);
    std::set<double> stored;
    for (const compute::StoredPoint& point : store.points()) stored.insert(std::get<double>(point.inputs[0]));
    EXPECT_EQ(optimum.designs.size(), stored.size()) << "every finished design is in the table";
    EXPECT_GE(store.finished().size(), end - 1);
    ASSERT_TRUE(optimum.best.has_value());
    EXPECT_TRUE(optimum.best->feasible());
    EXPECT_FALSE(optimum.front.empty());
    ASSERT_FALSE(observer.reported.empty());
    // The best design of the interrupted search must be valid.
    const std::string text = variant_design_text(study, *optimum.best, "# best\n");
    EXPECT_EQ(design::parse_design(text, "best.toml").part().thickness_mm, number(optimum.best->values[0]));
    // The next run continues the search. Its result must be equal to the result of an uninterrupted run.
    const Optimum resumed = optimise(whole, request, store, nullptr, nullptr);
    EXPECT_TRUE(resumed.complete);
    EXPECT_EQ(optimum_json(whole, request, resumed, 0.0), expected);
  }
}

TEST(OptimiseNoise, ReportsBetterAndBetterDesigns) {
  const Study study = noisy_study(hill);
  compute::ResultStore store("", optimise_layout(study), compute::IfExists::refuse);
  BestDesigns observer;
  const Optimum optimum = optimise(study, read_optimise(study), store, &observer, nullptr);
  ASSERT_GE(observer.reported.size(), 2U);
  const auto value = [](const Variant& variant) { return *variant.objective - 2.0 * variant.objective_error; };
  for (std::size_t k = 1; k < observer.reported.size(); ++k)
    EXPECT_GT(value(observer.reported[k]), value(observer.reported[k - 1]));
  EXPECT_FALSE(short_text(study, read_optimise(study), *optimum.best).empty());
}

TEST(OptimiseNoise, RowsOfAllDesignsAreInTheTable) {
  const Study study = noisy_study(hill);
  compute::ResultStore store("", optimise_layout(study), compute::IfExists::refuse);
  const Optimum optimum = optimise(study, read_optimise(study), store, nullptr, nullptr);
  const std::string csv = designs_csv(study, optimum);
  EXPECT_EQ(static_cast<std::size_t>(std::ranges::count(csv, '\n')), optimum.designs.size() + 1);
  EXPECT_EQ(important_parameters(study, optimum), (std::vector<std::size_t>{0}));
}

TEST(OptimiseNoise, TheMoreImportantParameterComesFirst) {
  const Study study = test::analytic_study(
      "[optimize]\nmaximize = \"f\"\nscan = 30\n",
      {{"f", [](double x, double y) { return -0.01 * std::pow(x - 1.0, 2) - std::pow(y - 2.0, 2); }}});
  compute::ResultStore store("", optimise_layout(study), compute::IfExists::refuse);
  const Optimum optimum = optimise(study, read_optimise(study), store, nullptr, nullptr);
  EXPECT_EQ(important_parameters(study, optimum), (std::vector<std::size_t>{1, 0}));
}

WholeSizes sizes_of(const std::vector<std::string>& keys, const std::vector<std::string>& overrides = {}) {
  Parameter parameter;
  parameter.keys = keys;
  const design::Design design =
      design::read_design(std::string(RETRACE_SOURCE_DIR) + "/examples/rtp_brick_1mm.toml", overrides);
  return {design, parameter};
}

TEST(WholeSizes, DivideTheLengthsOfThePart) {
  const std::vector<std::string> lengths = {"array.x_length_mm=30", "array.y_length_mm=20"};
  const WholeSizes both = sizes_of({"element.base_mm", "element.width_mm"}, lengths);
  EXPECT_TRUE(both.is_whole(0.5));
  EXPECT_FALSE(both.is_whole(30.0 / 61.0)) << "20 mm are not a multiple";
  EXPECT_EQ(both.between(0.45, 0.55), (std::vector<double>{10.0 / 22.0, 10.0 / 21.0, 0.5, 10.0 / 19.0}));
  const WholeSizes base = sizes_of({"element.base_mm"}, lengths);
  EXPECT_TRUE(base.is_whole(30.0 / 61.0));
  EXPECT_EQ(base.between(0.49, 0.51), (std::vector<double>{30.0 / 61.0, 0.5, 30.0 / 59.0}));
  // With gaps and margins, n elements and n - 1 gaps fill the length between the margins.
  const WholeSizes gaps =
      sizes_of({"element.base_mm"}, {"array.x_length_mm=30", "array.x_gap_mm=0.1", "array.x_offset_mm=0.5",
                                     "array.arrangement=\"aligned\"", "array.shifted_rows="});
  EXPECT_TRUE(gaps.is_whole((29.0 - 9.0 * 0.1) / 10.0));
  EXPECT_TRUE(sizes_of({"body.thickness_mm"}).is_empty());
}

TEST(WholeSizes, RoundValuesBeginWithTheRoundest) {
  const std::vector<double> values = round_values(0.4999446, 0.46, 0.54, {});
  ASSERT_FALSE(values.empty());
  EXPECT_EQ(values.front(), 0.5);
  EXPECT_EQ(round_values(0.0314, 0.03, 0.033, {}).front(), 0.03);
  // Both 0.45 and 0.46 are multiples of 0.01. Only with the size 0.46, a whole number of elements fills 9.2 mm, so 0.46
  // must come first.
  const WholeSizes sizes = sizes_of({"element.base_mm"}, {"array.x_length_mm=9.2"});
  const std::vector<double> near = round_values(0.452, 0.449, 0.461, sizes);
  const auto first = std::ranges::find(near, 0.46);
  EXPECT_NE(first, near.end());
}

/// The optimum is between the points of a coarse scan. The search must find it, because it also evaluates sizes with
/// which a whole number of elements fills the part.
TEST(WholeSizes, TheOptimumIsASizeThatDividesThePart) {
  const Study study = parse_study(
      "design = \"../rtp_brick_1mm.toml\"\n[[parameter]]\nkey = [\"element.base_mm\", \"element.width_mm\"]\n"
      "name = \"size_mm\"\nfrom = 0.45\nto = 0.93\n[[quantity]]\nkind = \"rre\"\n[analysis]\nengine = \"exact\"\n"
      "[optimize]\nmaximize = \"rre\"\nscan = 12\n",
      kStudies + "study.toml", std::vector<std::string>{"array.x_length_mm=6", "array.y_length_mm=4"});
  compute::ResultStore store("", optimise_layout(study), compute::IfExists::refuse);
  const Optimum optimum = optimise(study, read_optimise(study), store, nullptr, nullptr);
  EXPECT_EQ(number(optimum.best->values[0]), 0.5);
  EXPECT_EQ(optimum.best->outputs.size(), 1U);
}

std::string machining_study(const std::string& machining, const std::string& more = "") {
  return "design = \"../rtp_brick_1mm.toml\"\n[[parameter]]\nkey = [\"element.base_mm\", \"element.width_mm\"]\n"
         "name = \"size_mm\"\nfrom = 0.4\nto = 2\n[[quantity]]\nkind = \"elements_full\"\n[[quantity]]\n"
         "kind = \"machining_time_h\"\n" +
         more + "[optimize]\nmaximize = \"elements_full\"\n[machining]\n" + machining;
}

Study with_limits(const std::string& text) {
  return with_machining_limits(parse_study(text, kStudies + "study.toml"));
}

TEST(MachiningLimits, HoldByDefault) {
  const Study study = with_limits(machining_study("tool_width_mm = 0.5\n"));
  const OptimiseRequest request = read_optimise(study);
  ASSERT_EQ(request.constraints.size(), 1U);
  EXPECT_EQ(request.constraints[0].quantity, "tool_fit_mm");
  EXPECT_EQ(request.constraints[0].min, 0.0);
  compute::ResultStore store("", optimise_layout(study), compute::IfExists::refuse);
  const Optimum optimum = optimise(study, request, store, nullptr, nullptr);
  EXPECT_EQ(number(optimum.best->values[0]), 0.5) << "the smallest element that the tool fits";
  // A constraint of the study replaces the limit of the tool. The study can also ignore all limits.
  EXPECT_EQ(read_optimise(with_limits(machining_study("tool_width_mm = 0.5\n",
                                                      "[[quantity]]\nkind = \"tool_fit_mm\"\n[[constraint]]\n"
                                                      "quantity = \"tool_fit_mm\"\nmin = 0.1\n")))
                .constraints.size(),
            1U);
  EXPECT_TRUE(
      read_optimise(with_limits(machining_study("tool_width_mm = 0.5\nlimits = \"ignore\"\n"))).constraints.empty());
  EXPECT_TRUE(read_optimise(with_limits(machining_study(""))).constraints.empty());
  const OptimiseRequest all =
      read_optimise(with_limits(machining_study("tool_width_mm = 0.5\nmachine = \"thesis\"\nedge_life_mm = 1000\n")));
  EXPECT_EQ(all.constraints.size(), 3U);
}

TEST(MachiningLimits, NewKeysAreChecked) {
  const auto message = [](const std::string& machining) -> std::string {
    try {
      read_optimise(with_limits(machining_study(machining)));
    } catch (const InputError& error) {
      return recorded_place_of(error);
    }
    return "";
  };
  const std::string at = "examples/studies/study.toml:14: machining.";
  expect_refusals(message, {{"machine = \"nonesuch\"\n", at + "machine"},
                            {"machine = \"missing.toml\"\n", at + "machine"},
                            {"machine = \"ideal-dmc\"\n", at + "machine"},
                            {"machine = 3\n", at + "machine"},
                            {"process = \"nonesuch\"\n", at + "process"},
                            {"process = \"missing.toml\"\n", at + "process"},
                            {"edge_life_mm = 0\n", at + "edge_life_mm"},
                            {"edge_life_mm = \"long\"\n", at + "edge_life_mm"},
                            {"limits = \"keep\"\n", at + "limits"},
                            {"machine = \"thesis\"\n", ""}});
  const auto rounding = [](const std::string& word) {
    return refusal_of([&] { noisy_study(hill, "rounding = " + word + "\n"); }, "read");
  };
  EXPECT_EQ(rounding("\"digits\""), "examples/studies/study.toml:14: optimize.rounding");
  EXPECT_EQ(rounding("\"none\""), "read");
}

/// Values that [machining] does not give must be taken from the process file.
TEST(MachiningLimits, AProcessGivesTheOtherValues) {
  const auto machining = [](const std::string& keys) {
    const Study study = parse_study(machining_study(keys), kStudies + "study.toml");
    return make_candidate(study, example_values(study)).machining();
  };
  const MachiningProcess named = machining("process = \"paper-pmma\"\nroughing_depth_um = 7\n");
  const MachiningProcess defaults = machining("");
  EXPECT_EQ(named.roughing_depth_um, 7.0);
  EXPECT_NE(named.roughing_feed_mm_per_min, defaults.roughing_feed_mm_per_min);
}

/// On this machine, A tilts the facets by +-45 degrees about X, and C rotates the part by 180 degrees for facet 2. The
/// remaining travel then follows from the corners of the part.
TEST(MachinePlan, TravelIsThatOfTheFarthestCorner) {
  const design::Design design =
      design::read_design(std::string(RETRACE_SOURCE_DIR) + "/examples/rtp_brick_1mm.toml",
                          std::vector<std::string>{"array.x_length_mm=60", "array.y_length_mm=40"});
  MachiningProcess process;
  process.machine = "thesis";
  process.tool_width_mm = 1.0;
  const MachinePlan plan = plan_on_machine(design, process);
  ASSERT_TRUE(plan.travel_mm.has_value());
  // The centres of the elements are up to 29.5 mm along x and 19.5 mm along y from the centre of the part. Each axis is
  // limited to 120 mm. At 45 degrees, the coordinates y and z are at most (29.5 + depth) / sqrt(2).
  EXPECT_NEAR(*plan.travel_mm, 120.0 - (29.5 + 0.2) / std::numbers::sqrt2, 0.5);
  ASSERT_TRUE(plan.time_s.has_value());
  // The tolerance allows for accelerations, for moves between elements and for different retracts in the plan.
  const double path_s = static_cast<double>(plan.elements) *
                        seconds_per_element(std::get<geometry::RtpElement>(design.part().element), process);
  EXPECT_NEAR(*plan.time_s, path_s, 0.05 * path_s);
}

TEST(MachinePlan, APartBeyondTheTravelIsNotPlanned) {
  const design::Design design =
      design::read_design(std::string(RETRACE_SOURCE_DIR) + "/examples/rtp_brick_1mm.toml",
                          std::vector<std::string>{"array.x_length_mm=360", "array.y_length_mm=5"});
  MachiningProcess process;
  process.machine = "thesis";
  const MachinePlan plan = plan_on_machine(design, process);
  EXPECT_FALSE(plan.time_s.has_value());
  ASSERT_TRUE(plan.travel_mm.has_value());
  EXPECT_LT(*plan.travel_mm, 0.0);
}

TEST(MachinePlan, ToolLifeIsComparedWithThePathInOneElement) {
  const Study study = with_limits(machining_study("machine = \"ideal\"\ntool_width_mm = 0.4\nedge_life_mm = 50\n"));
  const Candidate candidate = make_candidate(study, example_values(study));
  const auto value = [&](const char* name) {
    for (const auto& quantity : study.quantities)
      if (quantity->name() == name) return quantity->measure(candidate, nullptr)->value;
    return std::optional<double>();
  };
  ASSERT_TRUE(value("edge_life_margin_mm").has_value());
  const double path_mm = 50.0 - *value("edge_life_margin_mm");
  // Each roughing cut of a facet of length L plunges 15 um deeper and then ploughs 0.1 mm, or up to the face of the
  // blank. Two finishing cuts plunge along each facet.
  const double facet_mm = 0.4 / std::numbers::sqrt2;
  double expected_mm = 4.0 * facet_mm;
  for (double depth_mm = facet_mm - 0.010; depth_mm > 1e-9; depth_mm -= 0.015)
    expected_mm += depth_mm + std::min(0.1, depth_mm);
  EXPECT_NEAR(path_mm, expected_mm, 0.1 * expected_mm);
}

/// The root radius of the design and the edge radius of the tool must be equal unless both are given.
TEST(LinkedRadius, EdgeAndRootAreEqualUnlessSetApart) {
  const auto radii = [](const std::string& machining, const std::vector<std::string>& overrides) {
    const Study study = parse_study(machining_study(machining), kStudies + "study.toml", overrides);
    const Candidate candidate = make_candidate(study, example_values(study));
    return std::pair(1e3 * candidate.design().part().edges.root_radius_mm, candidate.machining().edge_radius_um);
  };
  const auto expect = [&](const std::string& machining, const std::vector<std::string>& overrides, double root_um,
                          double edge_um) {
    const auto [root, edge] = radii(machining, overrides);
    EXPECT_NEAR(root, root_um, 1e-9) << machining;
    EXPECT_NEAR(edge, edge_um, 1e-9) << machining;
  };
  expect("", {}, 0.0, 0.0);
  expect("edge_radius_um = 3\n", {}, 3.0, 3.0);
  expect("", {"surface.root_radius_um=4"}, 4.0, 4.0);
  expect("edge_radius_um = 3\n", {"surface.root_radius_um=4"}, 4.0, 3.0);
}

}  // namespace
}  // namespace retrace::studies::optimise_noise_test
