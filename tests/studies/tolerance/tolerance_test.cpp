#include "studies/tolerance/tolerance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <set>
#include <utility>

#include "core/error.h"
#include "studies/quantity/io/study_reader.h"
#include "studies/tolerance/io/tolerance_files.h"
#include "studies/tolerance/io/tolerance_reader.h"
#include "tests/support/refusals.h"

namespace retrace::studies::tolerance_test {
namespace {

const std::string kFolder = std::string(RETRACE_SOURCE_DIR) + "/examples/";

/// Quantity that is a given function of three varied numbers. It needs no ray tracing.
class Analytic : public Quantity {
 public:
  using Function = std::function<double(double x, double y, double z)>;
  Analytic(std::string name, Function f) : Quantity(std::move(name)), f_(std::move(f)) {}
  std::optional<Measured> measure(const Candidate& candidate, const Cancellation*) const override {
    const AnalysisSettings& analysis = candidate.analysis();
    return Measured{f_(analysis.azimuth_deg, analysis.incidence_deg, candidate.design().part().thickness_mm), 0.0};
  }

 private:
  Function f_;
};

std::string parameter(const std::string& key, const std::string& distribution) {
  return "[[parameter]]\nkey = \"" + key + "\"\n" + distribution + "\n";
}

/// Returns a study whose quantity is f(x, y, z), where x is the azimuth, y the angle of incidence and z the thickness.
Study analytic_study(const std::array<std::string, 3>& distributions, const std::string& keys,
                     const Analytic::Function& f) {
  Study study = parse_study("design = \"rtp_brick_1mm.toml\"\n" + parameter("analysis.azimuth_deg", distributions[0]) +
                                parameter("analysis.incidence_deg", distributions[1]) +
                                parameter("body.thickness_mm", distributions[2]) +
                                "[[quantity]]\nkind = \"elements_full\"\nname = \"f\"\n" + keys,
                            kFolder + "study.toml");
  study.quantities = {std::make_shared<Analytic>("f", f)};
  return study;
}

/// Tolerance study with its store and its result.
struct StudyRun {
  explicit StudyRun(Study study)
      : request(read_tolerance(study)),
        sweep(tolerance_sweep(std::move(study), request)),
        store("", sweep.layout(), compute::IfExists::refuse) {}

  void compute() {
    EXPECT_TRUE(run_sweep(sweep, store, nullptr, nullptr));
    result = analyse(sweep, request, store.points());
  }
  std::string json() {
    SweepResult swept = collect(sweep, store, true);
    return tolerance_json(swept, request, result);
  }

  ToleranceRequest request;
  Sweep sweep;
  compute::ResultStore store;
  ToleranceResult result;
};

std::vector<double> numbers(const PointValues& values) {
  std::vector<double> result;
  for (const ParameterValue& value : values) result.push_back(std::get<double>(value.shown));
  return result;
}

const std::array<std::string, 3> kNormals = {"distribution = \"normal\"\nmean = 10\nsigma = 2",
                                             "distribution = \"normal\"\nmean = 0\nsigma = 1",
                                             "distribution = \"uniform\"\nfrom = 1\nto = 3"};

TEST(TolerancePlan, BeginsWithTheNominalPartAndMixesColumns) {
  const Study study = analytic_study(kNormals, "[tolerance]\nsamples = 8\n", [](double, double, double) { return 0; });
  const ToleranceRequest request = read_tolerance(study);
  const TolerancePlan plan(study, request);
  ASSERT_EQ(plan.size(), 1U + 8U * 5U);
  EXPECT_EQ(numbers(plan.values(0)), (std::vector{10.0, 0.0, 2.0})) << "medians";
  for (std::uint64_t row = 0; row < 8; ++row) {
    const std::vector<double> a = numbers(plan.values(1 + 5 * row));
    const std::vector<double> b = numbers(plan.values(2 + 5 * row));
    for (std::size_t k = 0; k < 3; ++k) {
      std::vector<double> mixed = a;
      mixed[k] = b[k];
      EXPECT_EQ(numbers(plan.values(3 + 5 * row + k)), mixed);
      EXPECT_NE(a[k], b[k]);
    }
  }
}

TEST(TolerancePlan, WithoutIndicesHasOnePointAPart) {
  const Study study =
      analytic_study(kNormals, "[tolerance]\nsamples = 9\nindices = \"none\"\nsampling = \"monte_carlo\"\n",
                     [](double, double, double) { return 0; });
  const TolerancePlan plan(study, read_tolerance(study));
  ASSERT_EQ(plan.size(), 10U);
  std::set<double> seen;
  for (std::uint64_t point = 1; point < 10; ++point) seen.insert(numbers(plan.values(point))[0]);
  EXPECT_EQ(seen.size(), 9U);
}

TEST(Tolerance, IshigamiThroughAStudy) {
  constexpr double pi = std::numbers::pi;
  const std::string uniform = "distribution = \"uniform\"\nfrom = -3.141592653589793\nto = 3.141592653589793";
  StudyRun run(analytic_study({uniform, uniform, "distribution = \"uniform\"\nfrom = 1\nto = 7.283185307179586"},
                              "[tolerance]\nsamples = 1024\n", [](double x, double y, double thickness) {
                                const double z = thickness - 1.0 - pi;
                                return std::sin(x) + 7.0 * std::pow(std::sin(y), 2) +
                                       0.1 * std::pow(z, 4) * std::sin(x);
                              }));
  run.compute();
  const QuantityTolerance& f = run.result.quantities.at(0);
  ASSERT_EQ(f.indices.size(), 3U);
  EXPECT_EQ(f.parts, 2048U);
  EXPECT_EQ(f.rows, 1024U);
  EXPECT_NEAR(f.indices[0].first_order.value, 0.3139, 0.04);
  EXPECT_NEAR(f.indices[1].first_order.value, 0.4424, 0.04);
  EXPECT_NEAR(f.indices[2].first_order.value, 0.0, 0.04);
  EXPECT_NEAR(f.indices[0].total.value, 0.5576, 0.04);
  EXPECT_NEAR(f.indices[1].total.value, 0.4424, 0.04);
  EXPECT_NEAR(f.indices[2].total.value, 0.2437, 0.04);
  // The mean of the Ishigami function is a / 2, with a = 7 and b = 0.1. Its variance is
  // a^2 / 8 + b pi^4 / 5 + b^2 pi^8 / 18 + 1 / 2.
  EXPECT_NEAR(f.spread->mean, 3.5, 0.05);
  EXPECT_NEAR(f.spread->deviation, std::sqrt(13.8446), 0.06);
}

/// The limits are 1 and 2 standard deviations from the mean of a normal distribution. 84.134 % and 97.725 % of the
/// parts satisfy them.
TEST(Tolerance, YieldsAreThoseOfTheNormalDistribution) {
  for (const std::string sampling : {"monte_carlo", "sobol", "latin_hypercube"}) {
    SCOPED_TRACE(sampling);
    StudyRun run(
        analytic_study(kNormals,
                       "[[constraint]]\nquantity = \"f\"\nmax = 12\n[[constraint]]\nquantity = \"f\"\nmin = 6\n"
                       "[tolerance]\nsamples = 2000\nindices = \"none\"\nconfidence_percent = 99.9\nsampling = \"" +
                           sampling + "\"\n",
                       [](double x, double, double) { return x; }));
    run.compute();
    ASSERT_EQ(run.result.limits.size(), 2U);
    const auto holds = [](const compute::IntervalEstimate& yield, double exact) {
      EXPECT_LE(yield.low, exact);
      EXPECT_GE(yield.high, exact);
      EXPECT_LT(yield.high - yield.low, 0.06);
    };
    holds(run.result.limits[0].yield, 0.841345);
    holds(run.result.limits[1].yield, 0.977250);
    holds(run.result.yield.value(), 0.841345 - (1.0 - 0.977250));
    EXPECT_NEAR(run.result.quantities[0].spread->mean, 10.0, 0.15);
    EXPECT_NEAR(run.result.quantities[0].spread->deviation, 2.0, 0.12);
    EXPECT_NEAR(run.result.quantities[0].percentiles[3].second, 10.0, 0.2) << "median";
    EXPECT_EQ(run.result.quantities[0].nominal, 10.0);
  }
}

TEST(Tolerance, TheYieldThatIsAskedForDecides) {
  const auto is_enough = [](const std::string& percent) {
    StudyRun run(
        analytic_study(kNormals,
                       "[[constraint]]\nquantity = \"f\"\nmin = 10\n[tolerance]\nsamples = 64\nindices = \"none\"\n"
                       "min_yield_percent = " +
                           percent + "\n",
                       [](double x, double, double) { return x; }));
    run.compute();
    return run.result.is_enough;
  };
  EXPECT_TRUE(is_enough("40"));
  EXPECT_FALSE(is_enough("60"));
}

/// At normal incidence, the RRE of a flat brick array is s + (1 - s) 2 R / (1 + R). Here, s is the fraction of the area
/// with whole elements, and R is the reflectance of the entrance face. The RRE depends on the index, but not on the
/// thickness of the plate.
TEST(Tolerance, OnlyWhatMattersContributesToRre) {
  StudyRun run(
      parse_study("design = \"rtp_brick_1mm.toml\"\n" +
                      parameter("body.thickness_mm", "distribution = \"uniform\"\nfrom = 1\nto = 3") +
                      parameter("body.refractive_index", "distribution = \"normal\"\nmean = 1.49\nsigma = 0.01") +
                      "[[quantity]]\nkind = \"rre\"\n[[quantity]]\nkind = "
                      "\"full_element_area_fraction\"\n[analysis]\nengine = \"exact\"\n[tolerance]\nsamples = 32\n",
                  kFolder + "study.toml"));
  run.compute();
  const QuantityTolerance& rre = run.result.quantities.at(0);
  ASSERT_EQ(rre.indices.size(), 2U) << run.result.warnings.at(0).text;
  EXPECT_NEAR(rre.indices[0].total.value, 0.0, 1e-6);
  EXPECT_NEAR(rre.indices[1].total.value, 1.0, 0.25);
  const double share = run.result.quantities.at(1).nominal.value();
  const auto closed_form = [&](double n) {
    const double r = std::pow((n - 1.0) / (n + 1.0), 2);
    return share + (1.0 - share) * 2.0 * r / (1.0 + r);
  };
  EXPECT_NEAR(rre.nominal.value(), closed_form(1.49), 1e-9);
  // In this small range, the RRE is a linear function of the index. Its standard deviation is the change of RRE per
  // standard deviation of the index.
  const double deviation = 0.5 * (closed_form(1.5) - closed_form(1.48));
  EXPECT_NEAR(rre.spread->deviation, deviation, 0.15 * deviation);
  EXPECT_TRUE(run.result.quantities[1].indices.empty()) << "a count does not vary";
}

TEST(Tolerance, PartsThatCannotBeMadeAreNoGoodParts) {
  // Half of the plates would have a thickness below 0.
  StudyRun run(
      analytic_study({kNormals[0], kNormals[1], "distribution = \"uniform\"\nfrom = -1\nto = 1"},
                     "[[constraint]]\nquantity = \"f\"\nmin = 0\n[tolerance]\nsamples = 128\nindices = \"none\"\n",
                     [](double, double, double thickness) { return thickness; }));
  run.compute();
  EXPECT_NEAR(static_cast<double>(run.result.failed), 64.0, 2.0);
  EXPECT_NEAR(run.result.yield->value, 0.5, 0.02);
  EXPECT_EQ(run.result.quantities[0].missing_parts, run.result.failed);
  EXPECT_GE(run.result.quantities[0].spread->min, 0.0);
  ASSERT_FALSE(run.result.warnings.empty());
  EXPECT_EQ(run.result.warnings[0].id, "parts_without_value");
}

TEST(Tolerance, IsTheSameEveryTimeAndWhateverWasThereBefore) {
  const auto study = [](std::uint32_t seed) {
    Study made =
        analytic_study(kNormals, "[tolerance]\nsamples = 64\n", [](double x, double y, double z) { return x * y + z; });
    made.seed = seed;
    return made;
  };
  StudyRun first(study(1));
  first.compute();
  StudyRun second(study(1));
  // Some points are already in the store, as after a run that was killed.
  for (const std::uint64_t point : {0U, 7U, 100U})
    second.store.record(*compute_point(second.sweep.study(), point, second.sweep.values(point), nullptr));
  second.compute();
  EXPECT_EQ(first.json(), second.json());
  StudyRun third(study(2));
  third.compute();
  EXPECT_NE(first.json(), third.json());
}

TEST(Tolerance, AnUnfinishedStudyIsJudgedByItsWholeRows) {
  StudyRun run(
      analytic_study(kNormals, "[tolerance]\nsamples = 64\n", [](double x, double y, double) { return x + y; }));
  for (std::uint64_t point = 0; point < 1 + 5 * 20 + 2; ++point)
    run.store.record(*compute_point(run.sweep.study(), point, run.sweep.values(point), nullptr));
  const ToleranceResult result = analyse(run.sweep, run.request, run.store.points());
  EXPECT_EQ(result.parts, 42U);
  EXPECT_EQ(result.quantities[0].rows, 20U);
}

TEST(Tolerance, WhatIsWrongIsSaidWithItsLine) {
  const auto message = [](const std::string& distribution, const std::string& keys) -> std::string {
    try {
      read_tolerance(
          analytic_study({distribution, kNormals[1], kNormals[2]}, keys, [](double x, double, double) { return x; }));
    } catch (const InputError& error) {
      return recorded_place_of(error);
    }
    return "";
  };
  EXPECT_EQ(message("values = [1, 2]", ""), "examples/study.toml:2: parameter[1]");
  EXPECT_EQ(message("from = 1\nto = 2", ""), "examples/study.toml:2: parameter[1]");
  const auto keys = [&](const std::string& text) { return message(kNormals[0], text); };
  expect_refusals(keys,
                  {{"[tolerance]\nsamples = 1\n", "examples/study.toml:21: tolerance.samples"},
                   {"[tolerance]\nsamples = 2.5\n", "examples/study.toml:21: tolerance.samples"},
                   {"[tolerance]\nsampling = \"random\"\n", "examples/study.toml:21: tolerance.sampling"},
                   {"[tolerance]\nindices = \"yes\"\n", "examples/study.toml:21: tolerance.indices"},
                   {"[tolerance]\nconfidence_percent = 100\n", "examples/study.toml:21: tolerance.confidence_percent"},
                   {"[tolerance]\nmin_yield_percent = 90\n", "examples/study.toml:21: tolerance.min_yield_percent"},
                   {"[tolerance]\nsample = 3\n", "examples/study.toml:21: tolerance.sample"},
                   {"[tolerance]\nsamples = 1000000\nindices = \"none\"\n", ""},
                   {"[tolerance]\nsamples = 1000000\nindices = \"sobol\"\n", ""},
                   {"[[constraint]]\nquantity = \"g\"\nmax = 1\n", "examples/study.toml:21: constraint[1].quantity"}});
}

}  // namespace
}  // namespace retrace::studies::tolerance_test
