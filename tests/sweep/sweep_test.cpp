#include "studies/sweep/sweep.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "core/error.h"
#include "studies/quantity/io/study_reader.h"
#include "studies/sweep/io/sweep_files.h"
#include "studies/sweep/io/sweep_reader.h"

namespace retrace::studies {
namespace {

const std::string kFolder = std::string(RETRACE_SOURCE_DIR) + "/examples/";

SweepResult swept(const Sweep& sweep) {
  ResultStore store("", sweep.layout(), IfExists::refuse);
  EXPECT_TRUE(run_sweep(sweep, store, nullptr, nullptr));
  return collect(sweep, store, true);
}

double output(const SweepResult& result, std::size_t point, const std::string& quantity) {
  const StoreLayout layout = result.sweep.layout();
  for (std::size_t k = 0; k < layout.outputs.size(); ++k)
    if (layout.outputs[k] == quantity) return result.points.at(point).outputs.at(k).value.value();
  throw std::runtime_error("no " + quantity);
}

/// Closed form of a flat brick array at normal incidence: half elements act as plane plates whose border walls return
/// R.
double brick_rre(double full_share) {
  constexpr double n = 1.4917;
  const double r = std::pow((n - 1.0) / (n + 1.0), 2);
  return full_share + (1.0 - full_share) * 2.0 * r / (1.0 + r);
}

TEST(Sweep, TheExampleGivesTheTableOfThePaper) {
  const Sweep sweep = read_sweep(read_study(kFolder + "studies/table1.toml"));
  const SweepResult result = swept(sweep);
  ASSERT_EQ(result.points.size(), 5U);
  std::ifstream table(std::string(RETRACE_SOURCE_DIR) + "/tests/data/rtp_array_rre.csv");
  std::size_t point = 0;
  for (std::string line; std::getline(table, line);) {
    double base = 0.0, width = 0.0, full = 0.0, area = 0.0, rre = 0.0;
    if (std::sscanf(line.c_str(), "%lf,%lf,%lf,%lf,%lf", &base, &width, &full, &area, &rre) != 5) continue;
    SCOPED_TRACE(line);
    EXPECT_EQ(std::get<double>(result.points.at(point).inputs[0]), base);
    EXPECT_EQ(output(result, point, "elements_full"), full);
    EXPECT_NEAR(output(result, point, "facet_area_mm2"), area, 0.005);
    EXPECT_NEAR(100.0 * output(result, point, "rre"), rre, 0.011) << "as printed";
    EXPECT_NEAR(output(result, point, "rre"), brick_rre(full * base * width / 100.0), 1e-9);
    EXPECT_NEAR(output(result, point, "effective_area_mm2"), full * std::sqrt(2.0) * base * width, 1e-9);
    EXPECT_NEAR(output(result, point, "lens_thickness_mm"), 2.0 + base / 2.0, 1e-12);
    ++point;
  }
  EXPECT_EQ(point, 5U);
}

TEST(Sweep, AFailingPointIsRecordedAndTheRestGoOn) {
  const Sweep sweep = read_sweep(
      parse_study("design = \"rtp_brick_1mm.toml\"\n[[parameter]]\nkey = \"element.base_mm\"\nvalues = [1, -3, 20, 2]\n"
                  "[[quantity]]\nkind = \"elements_full\"\n",
                  kFolder + "study.toml"));
  const SweepResult result = swept(sweep);
  ASSERT_EQ(result.points.size(), 4U);
  EXPECT_FALSE(result.points[0].failed);
  EXPECT_TRUE(result.points[1].failed);
  EXPECT_EQ(result.points[1].reason, "--set element.base_mm=-3: element.base_mm: must be > 0, got -3");
  EXPECT_TRUE(result.points[2].failed);
  EXPECT_FALSE(result.points[3].failed);
  ASSERT_EQ(result.warnings.size(), 1U);
  EXPECT_TRUE(result.warnings[0].starts_with("2 of 4 points failed, the first of them point 1: --set"));
  const std::string csv = sweep_csv(result);
  EXPECT_NE(csv.find("\n1,failed,-3,,,"), std::string::npos) << csv;
  EXPECT_EQ(csv.substr(0, csv.find('\n')),
            "point,status,element.base_mm,elements_full,elements_full_std_error,version,reason");
}

TEST(Sweep, WindowsAreMeansAndLeastsOfTheirDirections) {
  const auto value = [](const std::string& quantity) {
    const Sweep sweep = read_sweep(
        parse_study("design = \"rtp_single_0p45mm.toml\"\n[[parameter]]\nkey = \"body.thickness_mm\"\nvalues = [1]\n"
                    "[[quantity]]\nkind = \"rre\"\nname = \"q\"\n" +
                        quantity,
                    kFolder + "study.toml"));
    return output(swept(sweep), 0, "q");
  };
  const double at_2 = value("incidence_deg = 2\n");
  const double at_6 = value("incidence_deg = 6\n");
  ASSERT_NE(at_2, at_6);
  EXPECT_NEAR(value("incidence_deg = [2, 6]\n"), 0.5 * (at_2 + at_6), 1e-12);
  EXPECT_NEAR(value("incidence_deg = {from = 0, to = 8, count = 2}\n"), 0.5 * (at_2 + at_6), 1e-12);
  EXPECT_EQ(value("incidence_deg = [2, 6]\nover_directions = \"least\"\n"), std::min(at_2, at_6));
  const double s2 = std::sin(2.0 * M_PI / 180.0);
  const double s6 = std::sin(6.0 * M_PI / 180.0);
  EXPECT_NEAR(value("incidence_deg = [2, 6]\nweighting = \"solid_angle\"\n"), (s2 * at_2 + s6 * at_6) / (s2 + s6),
              1e-12);
}

TEST(Sweep, TheLedgerAddsUpAndTheFarFieldIsWhatWiderConesBring) {
  const Sweep sweep = read_sweep(parse_study(
      "design = \"rtp_single_0p45mm.toml\"\n[[parameter]]\nkey = \"analysis.incidence_deg\"\nvalues = [10]\n"
      "[[quantity]]\nkind = \"rre\"\n[[quantity]]\nkind = \"rre\"\nname = \"wide\"\nacceptance_half_angle_deg = 30\n"
      "[[quantity]]\nkind = \"far_field\"\nfrom_deg = 0.5\nto_deg = 30\n" +
          [] {
            std::string all;
            for (const auto account : raytrace::kAccountNames)
              all += "[[quantity]]\nkind = \"ledger\"\naccount = \"" + std::string(account) + "\"\nname = \"" +
                     std::string(account) + "\"\n";
            return all;
          }(),
      kFolder + "study.toml"));
  const SweepResult result = swept(sweep);
  ASSERT_FALSE(result.points[0].failed) << result.points[0].reason;
  double total = 0.0;
  for (const auto account : raytrace::kAccountNames) total += output(result, 0, std::string(account));
  EXPECT_NEAR(total, 1.0, 1e-9);
  EXPECT_EQ(output(result, 0, "rre"), output(result, 0, "retroreflected"));
  EXPECT_GT(output(result, 0, "far_field"), 0.0);
  EXPECT_NEAR(output(result, 0, "far_field"), output(result, 0, "wide") - output(result, 0, "rre"), 1e-9);
}

TEST(Sweep, ResultsDoNotDependOnWhatIsAlreadyThere) {
  const Sweep sweep = read_sweep(read_study(kFolder + "studies/table1.toml"));
  ResultStore store("", sweep.layout(), IfExists::refuse);
  store.record(*compute_point(sweep.study(), 3, sweep.values(3), nullptr));
  EXPECT_EQ(unfinished(sweep, store), (std::vector<std::uint64_t>{0, 1, 2, 4}));
  EXPECT_TRUE(run_sweep(sweep, store, nullptr, nullptr));
  EXPECT_EQ(sweep_csv(collect(sweep, store, true)), sweep_csv(swept(sweep)));
}

TEST(Sweep, ACancelledSweepKeepsWhatIsFinished) {
  const Sweep sweep = read_sweep(read_study(kFolder + "studies/table1.toml"));
  ResultStore store("", sweep.layout(), IfExists::refuse);
  Cancellation cancel;
  cancel.request();
  EXPECT_FALSE(run_sweep(sweep, store, nullptr, &cancel));
  EXPECT_TRUE(store.finished().empty());
}

}  // namespace
}  // namespace retrace::studies
