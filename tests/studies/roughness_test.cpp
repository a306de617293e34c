// Tests of the RRE as a function of the roughness of facets: shipped tables, closed forms, and refused values.
#include "studies/roughness/roughness.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "design/io/design_reader.h"
#include "design/optical_model.h"
#include "studies/roughness/io/facet_table_reader.h"
#include "studies/rre/rre.h"
#include "tests/support/refusals.h"
#include "tests/support/statistics.h"

namespace retrace::studies::roughness_test {
namespace {

/// A prism of mirrors behind a lossless entrance face. The cone is so narrow that it contains no scattered light, so
/// that the RRE is the specular fraction.
const std::string kPrism =
    "[element]\nkind = \"rtp\"\nbase_mm = 0.5\nwidth_mm = 0.5\n[array]\narrangement = \"single\"\n"
    "[body]\nthickness_mm = 0.5\n[idealisation]\nentrance = \"lossless\"\nfacets = \"mirror\"\n"
    "[detector]\nacceptance_half_angle_deg = 0.001\n";
const std::string kArray =
    "[element]\nkind = \"rtp\"\nbase_mm = 0.45\nwidth_mm = 0.45\n[array]\narrangement = \"offset\"\nextent = "
    "\"infinite\"\n[body]\nthickness_mm = 0.5\n";

std::string complaint(const std::string& table) {
  return refusal_of([&] { parse_facet_table(table, "t.csv"); });
}

TEST(FacetTable, SaysWhatIsWrongAndWhere) {
  expect_refusals(complaint, {{"# only words\n", "t.csv"},
                              {"facet,sa_nm\n", "t.csv"},
                              {"# x\nfacet,sa\nF1,3\n", "t.csv:2"},
                              {"sa_nm,sa_nm\n1,2\n", "t.csv:1: sa_nm"},
                              {"facet,sa_nm\nF1,3\nF2\n", "t.csv:3"}});
  for (const std::string value : {"-1", "nan", "inf", "1e6", "3 nm", ""})
    EXPECT_EQ(complaint("facet,sa_nm\nF1," + value + "\n"), "t.csv:2: sa_nm");
  EXPECT_EQ(complaint("process,roughness_sa_nm,waviness_sa_nm\npin,1,x\n"), "t.csv:2: waviness_sa_nm");
  EXPECT_EQ(complaint("process,sa_nm\n,1\n"), "t.csv:2: process");
  EXPECT_EQ(complaint("sa_nm\n" + std::string(1 << 20, ' ')), "t.csv");
}

TEST(FacetTable, TakesLineEndsAndBlanksAsTheyCome) {
  const std::vector<FacetGroup> groups =
      parse_facet_table("\r\n# c\r\n facet , sa_nm \r\nF1 , 3.5\r\n\r\nF2,4", "t.csv");
  ASSERT_EQ(groups.size(), 2U);
  EXPECT_EQ(groups[0].name, "F1");
  EXPECT_EQ(groups[0].roughness_sa_nm, 3.5);
  EXPECT_EQ(groups[1].line, 6);
}

RoughnessRequest request_of(const std::vector<double>& sa_nm) {
  RoughnessRequest request;
  request.sa_nm = sa_nm;
  request.correlation_length_um = {5.0};
  request.samples = 1U << 16;
  return request;
}

double phase2(double index, double sa_nm) {
  const double pi = std::numbers::pi;
  return std::pow(4.0 * pi * index * std::sqrt(0.5 * pi) * sa_nm * std::cos(0.25 * pi) / 587.56, 2);
}

// Light is reflected two times at 45 degrees. The specular fraction of each reflection is exp(-g), where g is the
// variance of the phase (closed form 7 in docs/theory/closed_forms.md), with Sq = sqrt(pi / 2) Sa.
TEST(RoughnessStudy, SpecularShareIsTheClosedFormOfSa) {
  const design::Design design = design::parse_design(kPrism, "d.toml");
  const double index = design::make_model(design, materials::MaterialLibrary::shipped()).optics.index;
  RoughnessRequest request = request_of({0.0, 4.0, 9.0, 20.0});
  FacetGroup wavy;
  wavy.name = "wavy";
  wavy.roughness_sa_nm = 6.0;
  wavy.waviness_sa_nm = 12.0;
  const RoughnessResult result = RoughnessStudy(design, request, {wavy}).run();
  ASSERT_EQ(result.points.size(), 5U);
  EXPECT_EQ(result.smooth_std_error, 0.0) << "of the exact engine";
  EXPECT_EQ(result.points[0].rre, result.smooth_rre);
  // The specular light is traced without sampling, so that the only difference may be rounding errors.
  constexpr double kRounding = 1e-12;
  for (std::size_t k = 1; k < 4; ++k)
    EXPECT_NEAR(result.points[k].rre, result.smooth_rre * std::exp(-2.0 * phase2(index, request.sa_nm[k])),
                testing::student_bound(4) * result.points[k].std_error + kRounding);
  EXPECT_EQ(result.points[4].measured, 0U);
  EXPECT_NEAR(result.points[4].rre, result.smooth_rre * std::exp(-2.0 * (phase2(index, 6.0) + phase2(index, 12.0))),
              testing::student_bound(4) * result.points[4].std_error + kRounding);
}

class Reports : public Progress {
 public:
  void at(double share) override { shares.push_back(share); }
  std::vector<double> shares;
};

// The point with smooth facets counts in the progress like every other point of the run.
TEST(RoughnessStudy, ReportsTheProgressOfTheSmoothPointAsWell) {
  for (const std::vector<double>& sa_nm : {std::vector{0.0}, std::vector{0.0, 4.0, 9.0, 20.0}}) {
    RoughnessRequest request = request_of(sa_nm);
    request.samples = 4096;
    Reports progress;
    EXPECT_TRUE(RoughnessStudy(design::parse_design(kPrism, "d.toml"), request).run(&progress, nullptr).complete);
    ASSERT_FALSE(progress.shares.empty());
    EXPECT_TRUE(std::ranges::is_sorted(progress.shares));
    EXPECT_GE(std::ranges::count(progress.shares, 1.0 / static_cast<double>(sa_nm.size())), 1);
    EXPECT_EQ(progress.shares.back(), 1.0);
  }
}

// Roughness with a longer correlation length scatters into narrower lobes, and more scattered light is inside the cone.
// Sa by itself therefore does not determine the RRE.
TEST(RoughnessStudy, FallsWithSaAndRisesWithTheCorrelationLength) {
  RoughnessRequest request = request_of({0.0, 5.0, 10.0, 20.0, 40.0});
  request.correlation_length_um = {2.0, 20.0, 60.0};
  const RoughnessResult result = RoughnessStudy(design::parse_design(kArray, "d.toml"), request).run();
  ASSERT_EQ(result.points.size(), 15U);
  for (std::size_t k = 0; k < result.points.size(); ++k) {
    const RoughnessPoint& at = result.points[k];
    const double error = 4.0 * at.std_error;
    if (k % 5 > 0) {
      EXPECT_LT(at.rre + error, result.points[k - 1].rre);
      if (k >= 5) {
        EXPECT_GT(at.rre, result.points[k - 5].rre + error) << at.roughness_sa_nm;
      }
    } else {
      EXPECT_EQ(at.rre, result.smooth_rre);
    }
  }
}

TEST(RoughnessStudy, RefusesWhatItCannotVary) {
  const auto said = [](const std::string& design, const RoughnessRequest& request,
                       const std::vector<FacetGroup>& measured = {}) -> std::string {
    return refusal_of([&] { RoughnessStudy(design::parse_design(design, "d.toml"), request, measured); });
  };
  EXPECT_EQ(said(kArray + "[surface]\nroughness_sq_nm = 3\ncorrelation_length_um = 5\n", request_of({1.0})),
            "d.toml:11: surface.roughness_sq_nm");
  EXPECT_EQ(said(kArray + "[detector]\nacceptance_half_angle_deg = [0.2, 0.5]\n", request_of({1.0})),
            "d.toml: detector.acceptance_half_angle_deg");
  EXPECT_EQ(said(kArray, request_of({-1.0})), "sa_nm");
  RoughnessRequest request = request_of({1.0});
  request.correlation_length_um = {0.0};
  EXPECT_EQ(said(kArray, request), "correlation_length_um");
  EXPECT_EQ(said(kArray, request_of({5000.0})), "sa_nm 5000 correlation_length_um 5");
  FacetGroup steep;
  steep.table = "t.csv";
  steep.line = 7;
  steep.name = "steep";
  steep.waviness_sa_nm = 90000.0;
  EXPECT_EQ(said(kArray, request_of({1.0}), {steep}), "t.csv:7: steep");
}

}  // namespace
}  // namespace retrace::studies::roughness_test
