// Tests of designs whose cells interfere: keys, refused input, limits of the readings, documents and warnings.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "design/io/design_document.h"
#include "design/io/design_reader.h"
#include "materials/io/spectrum_reader.h"
#include "materials/spectral_bands.h"
#include "studies/photometry/io/photometry_files.h"
#include "tests/studies/photometric_requests.h"
#include "tests/support/refusals.h"

namespace retrace::studies::cell_interference_test {
namespace {

using namespace photometric_requests;
using Json = nlohmann::ordered_json;

/// Returns a design of triangular cube corners. Line 8 contains `of_array`.
std::string triangles(const std::string& of_array, const std::string& light = "wavelength_nm = 550") {
  return "[element]\nkind = \"triangular_icc\"\naperture_mm = 0.12\n[body]\nthickness_mm = 0.2\n"
         "refractive_index = 1.49\n[array]\n" +
         of_array + "\n[light]\n" + light + "\n";
}

const std::string kInfinite = "extent = \"infinite\"\n";

std::string refused(const std::string& text) {
  return refusal_of([&] { design::parse_design(text, "d.toml"); });
}

PhotometrySettings request_at(const std::vector<double>& observation_deg) {
  PhotometrySettings request = request_of(points_at(observation_deg, 1.0));
  request.diffraction = true;
  request.engine = raytrace::Engine::exact;
  request.cutoff = 1e-5;
  return request;
}

std::vector<double> readings(const design::Design& design, const PhotometrySettings& request) {
  std::vector<double> values;
  for (const PhotometricPoint& point : run(design, request).points) values.push_back(point.r_a);
  return values;
}

}  // namespace

TEST(CellInterference, KeysAreReadAndWritten) {
  const design::Design none = design::parse_design(triangles(kInfinite), "d.toml");
  EXPECT_EQ(none.cell_spread(), nullptr);
  EXPECT_FALSE(design::document_of(none).has("array.depth_spread_nm"));
  const design::Design perfect = design::parse_design(triangles(kInfinite + "depth_spread_nm = 0"), "d.toml");
  ASSERT_NE(perfect.cell_spread(), nullptr);
  EXPECT_EQ(perfect.cell_spread()->depth_nm, 0.0);
  EXPECT_EQ(perfect.cell_spread()->spacing_nm, 0.0);
  const design::Design real =
      design::parse_design(triangles(kInfinite + "depth_spread_nm = 20\nspacing_spread_nm = 100"), "d.toml");
  const auto document = design::document_of(real);
  EXPECT_EQ(document.number("array.depth_spread_nm"), 20.0);
  EXPECT_EQ(document.number("array.spacing_spread_nm"), 100.0);
}

TEST(CellInterference, BadInputIsRefused) {
  expect_refusals(
      refused,
      {{triangles(kInfinite + "depth_spread_nm = -1"), "d.toml:9: array.depth_spread_nm"},
       {triangles(kInfinite + "depth_spread_nm = 2e6"), "d.toml:9: array.depth_spread_nm"},
       {triangles(kInfinite + "depth_spread_nm = \"small\""), "d.toml:9: array.depth_spread_nm"},
       {triangles(kInfinite + "spacing_spread_nm = 1"), "d.toml:9: array.spacing_spread_nm"},
       {triangles("x_length_mm = 5\ny_length_mm = 5\ndepth_spread_nm = 1"), "d.toml:10: array.depth_spread_nm"},
       {triangles("arrangement = \"single\"\ndepth_spread_nm = 1"), "d.toml:9: array.depth_spread_nm"},
       {"[element]\nkind = \"ball\"\ndiameter_mm = 1\n[array]\ndepth_spread_nm = 1\n",
        "d.toml:5: array.depth_spread_nm"}});
}

// Studies that add intensities of cells refuse such designs.
TEST(CellInterference, IsRefusedWhereIntensitiesAreAdded) {
  const design::Design spread = design::parse_design(triangles(kInfinite + "depth_spread_nm = 20"), "d.toml");
  const auto require = [&](const design::Design& design) {
    return refusal_of([&] { design::require_supported(design, {.what = "a camera image", .cell_spreads = false}); });
  };
  EXPECT_EQ(require(spread), "d.toml:9: array.depth_spread_nm");
  EXPECT_EQ(require(design::parse_design(triangles(kInfinite), "d.toml")), "");
}

// A large spread gives the readings of a design without the key. Small spreads change them continuously.
TEST(CellInterference, LargeSpreadsAddIntensities) {
  const PhotometrySettings request = request_at({0.1, 0.2, 0.33, 0.5});
  const auto with_depth = [&](const std::string& nm) {
    return readings(design::parse_design(triangles(kInfinite + "depth_spread_nm = " + nm), "d.toml"), request);
  };
  const std::vector<double> sum = readings(design::parse_design(triangles(kInfinite), "d.toml"), request);
  const std::vector<double> large = with_depth("2000");
  const std::vector<double> perfect = with_depth("0"), nearly = with_depth("0.1"), small = with_depth("15");
  ASSERT_EQ(sum.size(), 4U);
  const double peak = *std::max_element(perfect.begin(), perfect.end());
  double most = 0.0;
  for (std::size_t k = 0; k < sum.size(); ++k) {
    EXPECT_NEAR(large[k], sum[k], 1e-9 * sum[k]);
    EXPECT_NEAR(nearly[k], perfect[k], 1e-3 * peak);
    EXPECT_GE(small[k], std::min(perfect[k], sum[k]));
    EXPECT_LE(small[k], std::max(perfect[k], sum[k]));
    most = std::max(most, std::abs(perfect[k] - sum[k]));
  }
  EXPECT_GT(most, 0.1 * peak);
}

// The far field of the study has the power of the beams, inside and outside of its window.
TEST(CellInterference, WindowPowerIsComplete) {
  PhotometrySettings request = request_at({0.2});
  request.window_power = true;
  const PhotometryResult result =
      run(design::parse_design(triangles(kInfinite + "depth_spread_nm = 10"), "d.toml"), request);
  ASSERT_TRUE(result.directions.front().split);
  const PhotometricDirection::Split& split = *result.directions.front().split;
  EXPECT_NEAR(split.window + split.outside, split.geometric, 1e-3 * split.geometric);
}

TEST(CellInterference, ResultsReportTheRule) {
  const design::Design design = design::parse_design(triangles(kInfinite + "depth_spread_nm = 20"), "d.toml");
  const PhotometryResult result = run(design, request_at({0.2}));
  const Json json = Json::parse(photometry_json(result));
  EXPECT_EQ(json["cell_interference"]["depth_spread_nm"], 20.0);
  EXPECT_EQ(json["cell_interference"]["spacing_spread_nm"], 0.0);
  EXPECT_TRUE(result.warnings.empty());
  PhotometrySettings geometric = request_at({0.2});
  geometric.diffraction = false;
  const PhotometryResult without = run(design, geometric);
  EXPECT_FALSE(Json::parse(photometry_json(without)).contains("cell_interference"));
  ASSERT_EQ(without.warnings.size(), 1U);
  EXPECT_EQ(facts_of(without.warnings.front()), "no_cell_interference at d.toml");
  const PhotometryResult sum = run(design::parse_design(triangles(kInfinite), "d.toml"), request_at({0.2}));
  EXPECT_FALSE(Json::parse(photometry_json(sum)).contains("cell_interference"));
}

// The reading in white light is the mean of the readings at many single wavelengths. At oblique incidence, the orders
// of different wavelengths leave in different directions.
TEST(CellInterference, WhiteLightIsTheMeanOverWavelengths) {
  PhotometrySettings request = request_at({0.1, 0.33});
  for (TestPoint& point : request.test_plan.points) point.h_deg = 5.0;
  const auto at = [&](const std::string& light) {
    return readings(design::parse_design(triangles(kInfinite + "depth_spread_nm = 10", light), "d.toml"), request);
  };
  const materials::CieTable cie = materials::shipped_cie_table();
  std::vector<double> mean(2, 0.0), least(2, 1e300), most(2, 0.0);
  double weights = 0.0;
  for (int wavelength_nm = 420; wavelength_nm <= 680; wavelength_nm += 2) {
    const std::vector<double> line = at("wavelength_nm = " + std::to_string(wavelength_nm));
    const double weight = cie.illuminant_a.at(wavelength_nm) * cie.photopic_efficiency.at(wavelength_nm);
    weights += weight;
    for (std::size_t k = 0; k < 2; ++k) {
      mean[k] += weight * line[k];
      least[k] = std::min(least[k], line[k]);
      most[k] = std::max(most[k], line[k]);
    }
  }
  request.light = PhotometricLight::illuminant_a;
  const std::vector<double> white = at("wavelength_nm = 550");
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_NEAR(white[k], mean[k] / weights, 0.01 * white[k]);
    EXPECT_GT(most[k], 1.5 * least[k]);
  }
}

// The bands of a spectrum are adjacent and contain their wavelengths. Their flux is the weight of the wavelength.
TEST(CellInterference, BandsDivideTheSpectrum) {
  materials::SpectralCurve power;
  for (double w = 400.0; w <= 700.0; w += 5.0) {
    power.wavelengths_nm.push_back(w);
    power.values.push_back(1.0 + 0.01 * (w - 400.0));
  }
  const materials::Spectrum flux = materials::resolved_spectrum(power, nullptr);
  const materials::Spectrum traced = materials::traced_spectrum(flux);
  const auto bands = materials::spectral_bands(traced, flux);
  ASSERT_EQ(bands.size(), traced.size());
  EXPECT_NEAR(bands.front().front(), 400.0, 1e-9);
  EXPECT_NEAR(bands.back().back(), 700.0, 1e-9);
  for (std::size_t k = 0; k < bands.size(); ++k) {
    EXPECT_TRUE(std::is_sorted(bands[k].begin(), bands[k].end()));
    EXPECT_LT(bands[k].front(), traced.wavelengths_nm[k]);
    EXPECT_GT(bands[k].back(), traced.wavelengths_nm[k]);
    if (k > 0) {
      EXPECT_NEAR(bands[k].front(), bands[k - 1].back(), 1e-9);
    }
    const auto below = [](double w) { return (w - 400.0) + 0.005 * (w - 400.0) * (w - 400.0); };
    EXPECT_NEAR((below(bands[k].back()) - below(bands[k].front())) / below(700.0), traced.weights[k], 2e-3);
  }
}

}  // namespace retrace::studies::cell_interference_test
