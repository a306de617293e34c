#include "studies/sweep/sweep.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <memory>
#include <new>
#include <optional>

#include "core/error.h"
#include "design/io/design_reader.h"
#include "studies/optimise/io/optimise_reader.h"
#include "studies/optimise/optimise.h"
#include "studies/photometry/io/standard_reader.h"
#include "studies/quantity/io/study_reader.h"
#include "studies/sweep/io/sweep_files.h"
#include "studies/sweep/io/sweep_reader.h"
#include "tests/support/refusals.h"

namespace retrace::studies::sweep_test {
namespace {

const std::string kFolder = std::string(RETRACE_SOURCE_DIR) + "/examples/";

SweepResult swept(const Sweep& sweep) {
  compute::ResultStore store("", sweep.layout(), compute::IfExists::refuse);
  EXPECT_TRUE(run_sweep(sweep, store, nullptr, nullptr));
  return collect(sweep, store, true);
}

double output(const SweepResult& result, std::size_t point, const std::string& quantity) {
  const compute::StoreLayout layout = result.sweep.layout();
  for (std::size_t k = 0; k < layout.outputs.size(); ++k)
    if (layout.outputs[k] == quantity) return result.points.at(point).outputs.at(k).value.value();
  throw std::runtime_error("no " + quantity);
}

/// Returns the RRE of a flat brick array at normal incidence in closed form. Half elements act like plane plates whose
/// border walls have the reflectance R.
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
  EXPECT_EQ(recorded_place_of(result.points[1].reason), "--set element.base_mm=-3: element.base_mm");
  EXPECT_TRUE(result.points[2].failed);
  EXPECT_FALSE(result.points[3].failed);
  ASSERT_EQ(result.warnings.size(), 1U);
  EXPECT_EQ(facts_of(result.warnings[0]), "points_failed");
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
  EXPECT_EQ(value("incidence_deg = [2, 6]\nover_directions = \"min\"\n"), std::min(at_2, at_6));
  // A rotation of the part by 30 degrees has the same effect as a rotation of the light by -30 degrees.
  const std::string oblique = "incidence_deg = 20\nazimuth_deg = ";
  const double at_minus_20 = value(oblique + "-20\n");
  EXPECT_NEAR(value(oblique + "10\n[analysis]\nrotation_deg = 30\n"), at_minus_20, 1e-12);
  EXPECT_NE(value(oblique + "40\n"), at_minus_20);
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

/// A design of cube corners with one wavelength, without diffraction. It is traced quickly and returns light at every
/// test point.
const std::string kCubes =
    "[element]\nkind = \"hexagonal_icc\"\naperture_mm = 0.5\n[array]\nextent = \"infinite\"\n[body]\n"
    "thickness_mm = 1.5\nrefractive_index = 1.4917\n[light]\nwavelength_nm = 600\n";
const std::string kLimits =
    "standard,class,colour,observation_deg,v_deg,h_deg,minimum,unit,status\n"
    "S,,red,0.2,0,0,1000,mcd/lx,read\nS,,red,0.2,10,0,1000,mcd/lx,read\nS,,red,0.2,0,20,10,mcd/lx,read\n";

/// Fixture with a folder that contains the design and its limits.
class PhotometricStudy : public ::testing::Test {
 protected:
  PhotometricStudy()
      : folder_(std::filesystem::temp_directory_path() / ("retrace_sweep_" + std::to_string(::getpid()))) {
    std::filesystem::create_directories(folder_);
    std::ofstream(folder_ / "d.toml") << kCubes;
    std::ofstream(folder_ / "l.csv") << kLimits;
  }
  ~PhotometricStudy() override { std::filesystem::remove_all(folder_); }

  std::string text(const std::string& quantities) const {
    std::string all = "design = \"d.toml\"\n[[parameter]]\nkey = \"surface.dihedral_error_arcmin\"\nvalues = [1]\n";
    const std::string standard =
        "kind = \"photometry\"\nstandard = \"l.csv\"\narea_cm2 = 30\nlight = \"design\"\nfar_field = \"geometric\"\n";
    for (std::size_t at = 0; at < quantities.size();) {
      const std::size_t end = quantities.find('|', at);
      all += "[[quantity]]\n" + standard + quantities.substr(at, end - at);
      at = end == std::string::npos ? quantities.size() : end + 1;
    }
    return all;
  }
  SweepResult swept_of(const std::string& quantities) {
    sweep_.emplace(read_sweep(parse_study(text(quantities), (folder_ / "study.toml").string())));
    return swept(*sweep_);
  }
  std::string message(const std::string& keys) const {
    try {
      parse_study(text(keys), (folder_ / "study.toml").string());
    } catch (const InputError& error) {
      return recorded_place_of(error);
    }
    return "";
  }

  std::filesystem::path folder_;
  std::optional<Sweep> sweep_;
};

TEST_F(PhotometricStudy, QuantitiesAreThoseOfTheTable) {
  const SweepResult result = swept_of(
      "name = \"worst\"\n|name = \"m\"\npoints = \"each\"\n|name = \"second\"\npoints = 2\nfigure = "
      "\"r_i_mcd_per_lx\"\n|name = \"r_a\"\npoints = 2\nfigure = \"r_a\"\n");
  ASSERT_FALSE(result.points.at(0).failed) << result.points[0].reason;
  // The reference is the result of `retrace photometry` for the same design.
  PhotometryRequest request;
  request.standard = (folder_ / "l.csv").string();
  request.area_cm2 = 30.0;
  request.light = "design";
  request.diffraction = false;
  request.advice = false;
  const std::vector<std::string> overrides = {"surface.dihedral_error_arcmin=1"};
  const PhotometryResult table =
      PhotometryStudy(design::parse_design(kCubes, "d.toml", overrides), resolve(request, false)).run();
  ASSERT_EQ(table.points.size(), 3U);
  double worst = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(output(result, 0, "m." + std::to_string(k + 1)), table.points[k].margin());
    worst = std::min(worst, table.points[k].margin());
  }
  EXPECT_EQ(output(result, 0, "worst"), worst);
  EXPECT_EQ(output(result, 0, "second"), table.points[1].r_i_mcd_per_lx);
  EXPECT_GT(output(result, 0, "second"), 0.0);
  // R_I is R_A times the area.
  EXPECT_NEAR(output(result, 0, "r_a") * 30e-4 * 1e3, output(result, 0, "second"), 1e-9 * output(result, 0, "second"));
  EXPECT_EQ(result.sweep.layout().outputs.size(), 6U);
}

// If diffraction is important, a margin that is computed by rays could be mistaken for a verdict. The point is
// therefore stored as failed. R_A that is computed by rays is allowed.
TEST_F(PhotometricStudy, AnUndeterminedMarginIsNone) {
  const auto swept_with = [&](const std::string& quantity) {
    std::string study = text(quantity) + "[analysis]\nengine = \"montecarlo\"\nsamples = 1024\n";
    const std::string geometric = "far_field = \"geometric\"\n";
    study.erase(study.find(geometric), geometric.size());
    sweep_.emplace(read_sweep(parse_study(study, (folder_ / "study.toml").string())));
    return swept(*sweep_);
  };
  const SweepResult margin = swept_with("name = \"m\"\n");
  ASSERT_TRUE(margin.points.at(0).failed);
  record_message(margin.points[0].reason);
  EXPECT_FALSE(swept_with("name = \"r_a\"\nfigure = \"r_a\"\n").points.at(0).failed);
}

/// The objective is the smallest margin over all test points. The study chooses the best of several dihedral errors.
TEST_F(PhotometricStudy, TheWorstMarginIsMaximised) {
  std::string keys = text("name = \"worst\"\n|name = \"m\"\npoints = \"each\"\n");
  keys.replace(keys.find("values = [1]"), 12, "values = [0, 0.5, 1, 2, 3]");
  const Study study = parse_study(keys + "[optimize]\nmaximize = \"worst\"\n", (folder_ / "study.toml").string());
  compute::ResultStore store("", optimise_layout(study), compute::IfExists::refuse);
  const Optimum optimum = optimise(study, read_optimise(study), store, nullptr, nullptr);
  ASSERT_TRUE(optimum.best.has_value()) << optimum.infeasible_reason;
  std::optional<double> best;
  std::optional<compute::StoredValue> at;
  for (const compute::StoredPoint& point : store.points()) {
    double worst = std::numeric_limits<double>::infinity();
    for (std::size_t k = 1; k <= 3; ++k) worst = std::min(worst, point.outputs.at(k).value.value());
    if (best && worst <= *best) continue;
    best = worst;
    at = point.inputs.at(0);
  }
  EXPECT_EQ(optimum.best->values[0].shown, at.value());
  EXPECT_EQ(optimum.best->objective, best);
  EXPECT_EQ(optimum.designs.size(), 5U);
}

TEST_F(PhotometricStudy, WhatIsWrongIsSaidWithItsKey) {
  expect_refusals([this](const std::string& keys) { return message(keys); },
                  {{"name = \"q\"\npoints = 4\n", "TMP/study.toml:12: quantity[1].points"},
                   {"name = \"q\"\npoints = 1.5\n", "TMP/study.toml:12: quantity[1].points"},
                   {"name = \"q\"\npoints = \"all\"\n", "TMP/study.toml:12: quantity[1].points"},
                   {"name = \"q\"\nfigure = \"R\"\n", "TMP/study.toml:12: quantity[1].figure"},
                   {"name = \"q\"\ncolour = \"green\"\n", "TMP/study.toml:12: quantity[1].colour"},
                   {"name = \"q\"\ndye = \"no.csv\"\n", "TMP/study.toml:12: quantity[1].dye"},
                   {"name = \"q\"\nwindow_deg = 0.1\n", "TMP/study.toml:12: quantity[1].window_deg"},
                   {"name = \"q\"\nwidth = 1\n", "TMP/study.toml:12: quantity[1].width"}});
}

/// The texture and the edge radius that result from machining are inserted into the design. If an override also sets
/// one of these values, the override takes precedence.
TEST(MachiningLoop, SurfacesAreThoseThatTheStrategyLeaves) {
  const auto design = [](const std::string& machining, const std::vector<std::string>& overrides = {}) {
    const Study study = parse_study(
        "design = \"rtp_brick_1mm.toml\"\n[[parameter]]\nkey = \"body.thickness_mm\"\nvalues = "
        "[2]\n[[quantity]]\nkind = \"rre\"\n[machining]\n" +
            machining,
        kFolder + "study.toml", overrides);
    return make_candidate(study, study.parameters[0].values).design();
  };
  const auto texture_of = [](const design::Design& rough) {
    return std::get<design::HarveyShackTexture>(rough.surface.texture);
  };
  const design::Design drawn = design("edge_radius_um = 3\n");
  EXPECT_TRUE(drawn.surface.is_smooth());
  EXPECT_NEAR(drawn.part().edges.root_radius_mm, 3e-3, 1e-15);
  const design::Design cut = design("edge_radius_um = 3\nsurface = \"as_cut\"\n");
  EXPECT_NEAR(cut.part().edges.root_radius_mm, 3e-3, 1e-15);
  // The finished surface has Sa = 48.9 nm, of which 19.7 nm are roughness. For Gaussian heights, Sq is sqrt(pi / 2) Sa.
  EXPECT_NEAR(texture_of(cut).roughness_sq_nm, 19.7 * std::sqrt(M_PI / 2.0), 1e-9);
  EXPECT_NEAR(texture_of(cut).waviness_sq_nm, 29.9 * std::sqrt(M_PI / 2.0), 1e-9);
  const design::Design rough = design("strategy = \"unidirectional\"\nsurface = \"as_cut\"\n");
  EXPECT_GT(texture_of(rough).roughness_sq_nm, 5.0 * texture_of(cut).roughness_sq_nm);
  const std::vector<std::string> smoother = {"surface.roughness_sq_nm=7"};
  EXPECT_EQ(texture_of(design("surface = \"as_cut\"\n", smoother)).roughness_sq_nm, 7.0);
}

/// The roughness of the process is a quantity, so that processes with too much roughness can be excluded.
TEST(MachiningLoop, TheProcessIsAQuantity) {
  const Sweep sweep = read_sweep(parse_study(
      "design = \"rtp_brick_1mm.toml\"\n[[parameter]]\nkey = \"machining.strategy\"\nvalues = [\"two-step\", "
      "\"unidirectional\"]\n[[quantity]]\nkind = \"process_sa_nm\"\n[[quantity]]\nkind = \"machining_time_h\"\n"
      "[[quantity]]\nkind = \"root_radius_um\"\n[machining]\nedge_radius_um = 2\nsurface = \"as_cut\"\n",
      kFolder + "study.toml"));
  const SweepResult result = swept(sweep);
  ASSERT_EQ(result.points.size(), 2U);
  ASSERT_FALSE(result.points[0].failed) << result.points[0].reason;
  ASSERT_FALSE(result.points[1].failed) << result.points[1].reason;
  EXPECT_NEAR(output(result, 0, "process_sa_nm"), 48.9, 1e-9);
  // In the unidirectional process, half of the facets are ploughed with an Sa of 468 nm, and half are plunged with 115
  // nm.
  EXPECT_NEAR(output(result, 1, "process_sa_nm"), std::sqrt(0.5 * (468.0 * 468.0 + 115.0 * 115.0)), 1e-9);
  EXPECT_LT(output(result, 1, "machining_time_h"), output(result, 0, "machining_time_h")) << "nothing is finished";
  EXPECT_NEAR(output(result, 0, "root_radius_um"), 2.0, 1e-12);
}

TEST(Sweep, ResultsDoNotDependOnWhatIsAlreadyThere) {
  const Sweep sweep = read_sweep(read_study(kFolder + "studies/table1.toml"));
  compute::ResultStore store("", sweep.layout(), compute::IfExists::refuse);
  store.record(*compute_point(sweep.study(), 3, sweep.values(3), nullptr));
  EXPECT_EQ(unfinished(sweep, store), (std::vector<std::uint64_t>{0, 1, 2, 4}));
  EXPECT_TRUE(run_sweep(sweep, store, nullptr, nullptr));
  EXPECT_EQ(sweep_csv(collect(sweep, store, true)), sweep_csv(swept(sweep)));
}

/// A quantity that reports a progress of one half. Quantities with equal `tracing()` share one tracing.
class HalfReported : public Quantity {
 public:
  HalfReported(std::string name, std::string tracing) : Quantity(std::move(name)), tracing_(std::move(tracing)) {}
  std::optional<Measured> measure(const Candidate& candidate, const Cancellation*) const override {
    if (!tracing_.empty()) candidate.progress()->at(0.5);
    return Measured{1.0, 0.0};
  }
  std::string tracing() const override { return tracing_; }

 private:
  std::string tracing_;
};

class SharesOfSweep : public SweepObserver {
 public:
  void at(std::uint64_t, std::uint64_t, std::uint64_t) override {}
  void at_fraction(double share) override { shares.push_back(share); }
  std::vector<double> shares;
};

TEST(Sweep, APointThatIsBeingComputedCountsInPart) {
  Study study = read_study(kFolder + "studies/table1.toml");
  study.quantities.clear();
  for (const auto& [name, tracing] : {std::pair{"a", "x"}, {"b", "x"}, {"c", ""}, {"d", "y"}})
    study.quantities.push_back(std::make_shared<HalfReported>(name, tracing));
  const Sweep sweep(study, Combine::zipped, 0);
  ASSERT_EQ(sweep.size(), 5U);
  compute::ResultStore store("", sweep.layout(), compute::IfExists::refuse);
  for (const std::uint64_t point : {0U, 1U, 3U, 4U})
    store.record(*compute_point(sweep.study(), point, sweep.values(point), nullptr));
  SharesOfSweep seen;
  EXPECT_TRUE(run_sweep(sweep, store, &seen, nullptr));
  // The last point is one fifth of all points. It has two tracings, x and y. Each of them is half of the progress
  // of the point.
  const std::vector<double> expected = {0.8 + 0.2 * 0.25, 0.8 + 0.2 * 0.75, 1.0};
  ASSERT_EQ(seen.shares.size(), expected.size());
  for (std::size_t k = 0; k < expected.size(); ++k) EXPECT_NEAR(seen.shares[k], expected[k], 1e-12);
}

TEST(Sweep, ALackOfMemoryIsNoResultOfAPoint) {
  class Greedy : public Quantity {
   public:
    Greedy() : Quantity("rre") {}
    std::optional<Measured> measure(const Candidate&, const Cancellation*) const override { throw std::bad_alloc(); }
  };
  Study study = read_study(kFolder + "studies/table1.toml");
  study.quantities = {std::make_shared<Greedy>()};
  const Sweep sweep(study, Combine::grid, 0);
  compute::ResultStore store("", sweep.layout(), compute::IfExists::refuse);
  EXPECT_THROW(run_sweep(sweep, store, nullptr, nullptr), std::bad_alloc);
  EXPECT_TRUE(store.points().empty());
}

TEST(Sweep, ACancelledSweepKeepsWhatIsFinished) {
  const Sweep sweep = read_sweep(read_study(kFolder + "studies/table1.toml"));
  compute::ResultStore store("", sweep.layout(), compute::IfExists::refuse);
  Cancellation cancel;
  cancel.request();
  EXPECT_FALSE(run_sweep(sweep, store, nullptr, &cancel));
  EXPECT_TRUE(store.finished().empty());
}

}  // namespace
}  // namespace retrace::studies::sweep_test
