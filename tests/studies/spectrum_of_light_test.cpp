// Tests of light with a spectrum. A result is a mean over single wavelengths, which must be close to the mean over the
// whole spectrum.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/number_format.h"
#include "design/io/design_reader.h"
#include "materials/io/spectrum_reader.h"
#include "studies/inspect/inspect.h"
#include "studies/rre/io/rre_files.h"
#include "studies/rre/rre.h"
#include "studies/rre/spectral_mean.h"
#include "tests/support/refusals.h"

namespace retrace::studies::spectrum_of_light_test {
namespace {

namespace fs = std::filesystem;
using Overrides = std::vector<std::string>;
using raytrace::Account;

const std::string kPrisms = R"([element]
kind = "rtp"
base_mm = 0.5
width_mm = 0.5
[array]
extent = "infinite"
[body]
thickness_mm = 2
)";

design::Design design(const Overrides& overrides) {
  return design::parse_design(kPrisms, "d.toml", overrides);
}

RreSettings exactly(double incidence_deg, double azimuth_deg = 0.0) {
  RreSettings request;
  request.incidence_deg = {incidence_deg};
  request.azimuth_deg = {azimuth_deg};
  request.engine = raytrace::Engine::exact;
  return request;
}

RreSettings sampled(double incidence_deg, std::uint64_t rays, std::uint32_t seed) {
  RreSettings request;
  request.incidence_deg = {incidence_deg};
  request.engine = raytrace::Engine::montecarlo;
  request.rays = rays;
  request.seed = seed;
  return request;
}

RrePoint point(const Overrides& overrides, const RreSettings& request) {
  return RreStudy({design(overrides)}, request).run().points.at(0);
}

std::string complaint(const design::Design& given, const RreSettings& request) {
  return refusal_of([&] { RreStudy({given}, request); });
}

/// Returns an override with lines of equal power at every wavelength of the table of the CIE.
std::string lines_of_the_table(const materials::CieTable& cie) {
  std::string text = "light.spectrum=[";
  for (const double wavelength_nm : cie.illuminant_a.wavelengths_nm)
    text += (text.ends_with('[') ? "[" : ",[") + shortest(wavelength_nm) + ",1]";
  return text + "]";
}

/// Returns the luminous mean of the RRE: sum S V f / sum S V over the table, as the CIE defines luminous means.
double luminous_mean(const materials::SpectralCurve& lamp, const materials::SpectralCurve& efficiency,
                     const std::vector<SpectralRre>& points) {
  double sum = 0.0;
  double flux = 0.0;
  for (std::size_t k = 0; k < lamp.values.size(); ++k) {
    sum += lamp.values[k] * efficiency.values[k] * points[k].rre;
    flux += lamp.values[k] * efficiency.values[k];
  }
  return sum / flux;
}

/// Returns an upper bound of the difference between the mean over `nodes` and the sum over the table (Koksma's
/// inequality). Between two neighbouring wavelengths of the table, the bound is the difference of the cumulated weights
/// times the change of the RRE. The RRE is assumed to be monotonic between neighbours.
double koksma_bound(const materials::SpectralCurve& lamp, const materials::SpectralCurve& efficiency,
                    const std::vector<SpectralRre>& table, const std::vector<SpectralRre>& nodes) {
  const auto below = [&](double wavelength_nm) {
    double sum = 0.0;
    for (const SpectralRre& node : nodes) sum += node.wavelength_nm <= wavelength_nm ? node.weight : 0.0;
    return sum;
  };
  double flux = 0.0;
  for (std::size_t k = 0; k < table.size(); ++k) flux += lamp.values[k] * efficiency.values[k];
  double cumulated = 0.0;
  double bound = 0.0;
  for (std::size_t k = 0; k + 1 < table.size(); ++k) {
    cumulated += lamp.values[k] * efficiency.values[k] / flux;
    const double apart = std::max(std::abs(below(table[k].wavelength_nm) - cumulated),
                                  std::abs(below(table[k + 1].wavelength_nm) - cumulated));
    bound += apart * std::abs(table[k + 1].rre - table[k].rre);
  }
  return bound;
}

TEST(SpectralMean, WeighsPointsAndAddsVariances) {
  const auto at_wavelength = [](double wavelength_nm, const raytrace::Stokes& stokes, double std_error) {
    RrePoint point;
    point.wavelength_nm = wavelength_nm;
    point.rre = point.ledger[Account::retroreflected] = stokes.i;
    point.std_error = std_error;
    point.stokes = stokes;
    return point;
  };
  RrePoint a = at_wavelength(500.0, {0.8, 0.1, -0.2, 0.3}, 0.03);
  a.ledger[Account::transmitted] = 0.2;
  a.beams = 7;
  a.depth = 3;
  RrePoint b = at_wavelength(600.0, {0.4, 0.2, 0.0, -0.1}, 0.04);
  b.ledger[Account::absorbed] = 0.6;
  b.beams = 5;
  b.depth = 9;
  RrePoint at;
  at.incidence_deg = 12.0;
  at.wavelength_nm = 575.0;
  const RrePoint mean = spectral_mean(at, {{0.25, a}, {0.75, b}});
  EXPECT_EQ(mean.incidence_deg, 12.0);
  EXPECT_EQ(mean.wavelength_nm, 575.0);
  EXPECT_DOUBLE_EQ(mean.rre, 0.5);
  EXPECT_DOUBLE_EQ(mean.std_error, std::hypot(0.25 * 0.03, 0.75 * 0.04));
  EXPECT_DOUBLE_EQ(mean.stokes.q, 0.175);
  EXPECT_DOUBLE_EQ(mean.stokes.u, -0.05);
  EXPECT_NEAR(mean.stokes.v, 0.0, 1e-16);
  EXPECT_DOUBLE_EQ(mean.ledger[Account::transmitted], 0.05);
  EXPECT_DOUBLE_EQ(mean.ledger[Account::absorbed], 0.45);
  EXPECT_DOUBLE_EQ(mean.ledger.total(), 1.0);
  EXPECT_EQ(mean.beams, 12U);
  EXPECT_EQ(mean.depth, 9U);
  ASSERT_EQ(mean.by_wavelength.size(), 2U);
  EXPECT_EQ(mean.by_wavelength[1].wavelength_nm, 600.0);
  EXPECT_EQ(mean.by_wavelength[1].weight, 0.75);
  EXPECT_EQ(mean.by_wavelength[1].rre, 0.4);
  EXPECT_EQ(mean.by_wavelength[1].std_error, 0.04);
}

TEST(SpectrumOfLight, IsTheWeightedMeanOfSingleWavelengths) {
  for (const double incidence_deg : {0.0, 4.0, 10.0}) {
    const RrePoint lit = point({"light.spectrum=A", "body.absorption_per_mm=0.01"}, exactly(incidence_deg, 20.0));
    ASSERT_EQ(lit.by_wavelength.size(), 2 * materials::kSpectralParts);
    raytrace::Ledger ledger;
    raytrace::Stokes stokes;
    double weights = 0.0;
    for (const SpectralRre& at : lit.by_wavelength) {
      const RrePoint alone = point({"light.wavelength_nm=" + shortest(at.wavelength_nm), "body.absorption_per_mm=0.01"},
                                   exactly(incidence_deg, 20.0));
      EXPECT_EQ(at.rre, alone.rre) << at.wavelength_nm;
      for (std::size_t k = 0; k < ledger.power.size(); ++k) ledger.power[k] += at.weight * alone.ledger.power[k];
      stokes += at.weight * alone.stokes;
      weights += at.weight;
    }
    EXPECT_NEAR(weights, 1.0, 1e-13);
    EXPECT_NEAR(lit.rre, ledger[Account::retroreflected], 1e-14);
    for (std::size_t k = 0; k < ledger.power.size(); ++k)
      EXPECT_NEAR(lit.ledger.power[k], ledger.power[k], 1e-14) << raytrace::kAccountNames[k];
    for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(lit.stokes.values()[k], stokes.values()[k], 1e-14);
    EXPECT_NEAR(lit.ledger.total(), 1.0, 1e-9);
  }
}

TEST(SpectrumOfLight, OneLineIsTheWavelength) {
  const Overrides line = {"light.spectrum=[[633, 2.5]]"};
  const Overrides wavelength = {"light.wavelength_nm=633"};
  for (const RreSettings& request : {exactly(7.0), sampled(7.0, 4096, 3)}) {
    const RrePoint a = point(line, request);
    const RrePoint b = point(wavelength, request);
    EXPECT_EQ(a.rre, b.rre);
    EXPECT_EQ(a.std_error, b.std_error);
    EXPECT_EQ(a.ledger.power, b.ledger.power);
    EXPECT_EQ(a.stokes.values(), b.stokes.values());
    EXPECT_EQ(a.wavelength_nm, 633.0);
    EXPECT_EQ(b.by_wavelength.size(), 0U);
  }
}

TEST(SpectrumOfLight, AGivenIndexKnowsNoDispersion) {
  const Overrides fixed = {"body.refractive_index=1.5", "body.absorption_per_mm=0.02"};
  Overrides lit = fixed;
  lit.push_back("light.spectrum=D65");
  for (const double incidence_deg : {0.0, 9.0, 30.0}) {
    const RrePoint a = point(lit, exactly(incidence_deg));
    EXPECT_NEAR(a.rre, point(fixed, exactly(incidence_deg)).rre, 1e-13);
    for (const SpectralRre& at : a.by_wavelength) EXPECT_EQ(at.rre, a.by_wavelength[0].rre);
  }
  const RrePoint dispersed = point({"light.spectrum=D65"}, exactly(9.0));
  EXPECT_GT(std::abs(dispersed.by_wavelength.front().rre - dispersed.by_wavelength.back().rre), 1e-3)
      << "without a given index there is dispersion to be seen";
}

// The spectrum has a blue and a red line. The weight of each line is its power, or its power times V.
TEST(SpectrumOfLight, WeightingIsOfTheEyeOrOfPower) {
  const std::string lines = "light.spectrum=[[450, 3], [650, 1]]";
  const RrePoint seen = point({lines}, exactly(10.0));
  const RrePoint radiant = point({lines, "light.weighting=radiant"}, exactly(10.0));
  EXPECT_NEAR(seen.by_wavelength[0].weight, 3.0 * 0.038 / (3.0 * 0.038 + 0.107), 1e-14);
  EXPECT_NEAR(radiant.by_wavelength[0].weight, 0.75, 1e-14);
  EXPECT_NEAR(radiant.wavelength_nm, 500.0, 1e-12);
  EXPECT_EQ(seen.by_wavelength[0].rre, radiant.by_wavelength[0].rre);
  EXPECT_GT(std::abs(seen.rre - radiant.rre), 1e-4);
}

// The mean over ten wavelengths is compared with the sum over all 81 wavelengths of the table. At normal incidence, the
// RRE is a smooth function of the wavelength. At 10 degrees, total reflection ends within the spectrum. The bound
// allows for any monotonic change between neighbours of the table.
TEST(SpectrumOfLight, TenWavelengthsStandForTheWholeTable) {
  const materials::CieTable cie = materials::shipped_cie_table();
  for (const double incidence_deg : {0.0, 10.0}) {
    RreSettings request = exactly(incidence_deg);
    request.cutoff = 1e-7;
    const auto all = point({lines_of_the_table(cie), "light.weighting=radiant"}, request).by_wavelength;
    ASSERT_EQ(all.size(), 81U);
    for (const bool is_a : {true, false}) {
      const materials::SpectralCurve& lamp = is_a ? cie.illuminant_a : cie.illuminant_d65;
      const RrePoint lit = point({is_a ? "light.spectrum=A" : "light.spectrum=D65"}, request);
      const double bound = koksma_bound(lamp, cie.photopic_efficiency, all, lit.by_wavelength);
      EXPECT_LT(bound, incidence_deg == 0.0 ? 1e-8 : 1e-3) << "says something";
      const double error = std::abs(lit.rre - luminous_mean(lamp, cie.photopic_efficiency, all));
      EXPECT_LE(error, bound + 1e-7) << incidence_deg << ", cut off: 1e-7";
      RecordProperty((is_a ? "error_a_" : "error_d65_") + std::to_string(std::lround(incidence_deg)), shortest(error));
      RecordProperty((is_a ? "bound_a_" : "bound_d65_") + std::to_string(std::lround(incidence_deg)), shortest(bound));
    }
  }
}

// The estimates for different seeds are independent. The deviation of each estimate is divided by its standard error.
// The mean square of these ratios is expected to be 1 within about sqrt(2 / number of seeds). The tested limits are
// wider, because standard errors from 32 replicates give ratios with long tails. With plain sampling, the part of the
// error that allows for light that no ray has met is negligible.
TEST(SpectrumOfLight, MonteCarloAgreesWithTheExactEngineWithinItsError) {
  constexpr int kSeeds = 40;
  const double truth = point({"light.spectrum=A"}, exactly(10.0)).rre;
  double sum = 0.0;
  for (std::uint32_t seed = 1; seed <= kSeeds; ++seed) {
    RreSettings request = sampled(10.0, 4096, seed);
    request.sampling = raytrace::Sampling::Kind::plain;
    const RrePoint estimate = point({"light.spectrum=A"}, request);
    ASSERT_GT(estimate.std_error, 0.0);
    sum += std::pow((estimate.rre - truth) / estimate.std_error, 2);
  }
  EXPECT_GT(sum / kSeeds, 0.45);
  EXPECT_LT(sum / kSeeds, 1.9);
}

TEST(SpectrumOfLight, TargetErrorIsThatOfTheMean) {
  RreSettings request = sampled(10.0, 0, 5);
  request.rays.reset();
  request.target_error = 2e-4;
  const RreResult lit = RreStudy({design({"light.spectrum=D65"})}, request).run();
  EXPECT_LE(lit.points.at(0).std_error, 2e-4);
  EXPECT_TRUE(lit.warnings.empty());
}

// Facets are mirrors, the entrance face is lossless, and light falls along the normal. Each path has the length 2 (2 +
// 0.25) mm. The absorption a(w) of an amber plate falls linearly from 0.2 per mm at 380 nm to 0 at 780 nm. The expected
// RRE is the mean of exp(-a(w) L) over the table.
TEST(SpectrumOfLight, AColouredPlateKeepsTheMeanOfItsTransmittance) {
  const double path_mm = 4.5;
  const auto absorption_per_mm = [](double wavelength_nm) { return 0.2 * (780.0 - wavelength_nm) / 400.0; };
  const Overrides amber = {"body.absorption_per_mm=[[380, 0.2], [780, 0]]", "idealisation.facets=mirror",
                           "idealisation.entrance=lossless"};
  const materials::CieTable cie = materials::shipped_cie_table();
  for (const bool is_a : {true, false}) {
    Overrides lit = amber;
    lit.push_back(is_a ? "light.spectrum=A" : "light.spectrum=D65");
    const RrePoint p = point(lit, exactly(0.0));
    for (const SpectralRre& at : p.by_wavelength)
      EXPECT_NEAR(at.rre, std::exp(-path_mm * absorption_per_mm(at.wavelength_nm)), 1e-9) << at.wavelength_nm;
    std::vector<SpectralRre> table;
    for (const double w : cie.illuminant_a.wavelengths_nm)
      table.push_back({w, 0.0, std::exp(-path_mm * absorption_per_mm(w)), 0.0, "exact"});
    const double expected = luminous_mean(is_a ? cie.illuminant_a : cie.illuminant_d65, cie.photopic_efficiency, table);
    EXPECT_NEAR(p.rre, expected, 1e-6);
    EXPECT_NEAR(p.ledger[Account::absorbed], 1.0 - expected, 1e-6);
  }
  EXPECT_EQ(complaint(design({"body.absorption_per_mm=[[500, 0.2], [780, 0]]", "light.spectrum=[[490, 1], [600, 1]]"}),
                      exactly(0.0)),
            "--set body.absorption_per_mm=[[500, 0.2], [780, 0]]: body.absorption_per_mm");
}

TEST(SpectrumOfLight, AFileIsReadFromTheFolderOfTheDesign) {
  const fs::path folder = fs::temp_directory_path() / "retrace_spectrum_of_light";
  fs::create_directories(folder);
  const materials::CieTable cie = materials::shipped_cie_table();
  {
    std::ofstream csv(folder / "a.csv");
    csv << "wavelength_nm,power\n";
    for (std::size_t k = 0; k < cie.illuminant_a.values.size(); ++k)
      csv << shortest(cie.illuminant_a.wavelengths_nm[k]) << ',' << shortest(cie.illuminant_a.values[k]) << '\n';
  }
  const std::string text = kPrisms + "[light]\nspectrum = \"a.csv\"\n";
  const design::Design of_file = design::parse_design(text, (folder / "d.toml").string(), {});
  EXPECT_EQ(RreStudy({of_file}, exactly(5.0)).run().points.at(0).rre, point({"light.spectrum=A"}, exactly(5.0)).rre);
  std::ofstream(folder / "a.csv") << "wavelength_nm,power\n500,1\n490,1\n";
  EXPECT_EQ(complaint(of_file, exactly(5.0)), "TMP/d.toml:10: light.spectrum");
  fs::remove_all(folder);
  EXPECT_EQ(complaint(of_file, exactly(5.0)), "TMP/d.toml:10: light.spectrum");
}

TEST(SpectrumOfLight, WhatCannotBeTracedIsRefused) {
  const auto refused = [](const Overrides& overrides) { return complaint(design(overrides), exactly(0.0)); };
  const std::string unseen = refused({"light.spectrum=[[1064, 1]]"});
  EXPECT_EQ(unseen, "--set light.spectrum=[[1064, 1]]: light.spectrum");
  EXPECT_EQ(refused({"light.spectrum=[[555, 0]]", "light.weighting=radiant"}),
            "--set light.spectrum=[[555, 0]]: light.spectrum");
  const std::string no_index = refused({"light.spectrum=[[555, 1], [1e8, 1]]", "light.weighting=radiant"});
  EXPECT_EQ(no_index, "--set light.spectrum=[[555, 1], [1e8, 1]]: light.spectrum");
}

TEST(SpectrumOfLight, WhatShowsOneWavelengthIsRefused) {
  for (const int which : {0, 1, 2}) {
    RreSettings request = exactly(0.0);
    (which == 0 ? request.derivatives : which == 1 ? request.footprint : request.far_field) = true;
    EXPECT_EQ(complaint(design({"light.spectrum=A"}), request), "--set light.spectrum=A: light.spectrum");
    EXPECT_EQ(complaint(design({"light.spectrum=[[572,1]]"}), request), "");
  }
}

TEST(SpectrumOfLight, ExtrapolatedIndicesAreTold) {
  const RreResult seen = RreStudy({design({"light.spectrum=A"})}, exactly(0.0)).run();
  EXPECT_TRUE(seen.warnings.empty()) << "the data of PMMA cover what the eye sees of it";
  const RreResult lines =
      RreStudy({design({"light.spectrum=[[405, 1], [410, 1], [500, 2]]", "light.weighting=radiant"})}, exactly(0.0))
          .run();
  ASSERT_EQ(lines.warnings.size(), 1U);
  EXPECT_EQ(facts_of(lines.warnings[0]), "index_extrapolated at d.toml");
}

// A warning is given if the data of aluminium are extrapolated. The data of the material of the body are not used,
// because the index is given.
TEST(SpectrumOfLight, ExtrapolatedMetalsAreTold) {
  const std::vector<std::string> metal = {"body.facet_coating=aluminium", "body.refractive_index=1.5",
                                          "light.wavelength_nm=50"};
  const RreResult result = RreStudy({design(metal)}, exactly(0.0)).run();
  ASSERT_EQ(result.warnings.size(), 1U);
  EXPECT_EQ(facts_of(result.warnings[0]), "index_extrapolated at d.toml");
}

TEST(SpectrumOfLight, JsonHoldsWavelengthsAndWhatEachBringsBack) {
  const RreResult result = RreStudy({design({"light.spectrum=A"}), design({})}, exactly(10.0)).run();
  const auto json = nlohmann::ordered_json::parse(rre_json(result));
  const auto& lamp = json["designs"][0];
  EXPECT_EQ(lamp["light"]["spectrum"], "A");
  EXPECT_EQ(lamp["light"]["weighting"], "photopic");
  EXPECT_FALSE(lamp["light"].contains("wavelength_nm"));
  EXPECT_EQ(lamp["spectrum"]["wavelengths_nm"].size(), 10U);
  EXPECT_EQ(lamp["spectrum"]["weights"].size(), 10U);
  EXPECT_GT(lamp["spectrum"]["refractive_index"][0], lamp["spectrum"]["refractive_index"][9]) << "normal dispersion";
  EXPECT_EQ(json["points"][0]["wavelength_nm"], lamp["spectrum"]["centroid_nm"]);
  double mean = 0.0;
  for (const auto& at : json["points"][0]["by_wavelength"])
    mean += at["weight"].get<double>() * at["rre"].get<double>();
  EXPECT_NEAR(mean, json["points"][0]["rre"].get<double>(), 1e-14);
  EXPECT_FALSE(json["designs"][1].contains("spectrum"));
  EXPECT_EQ(json["designs"][1]["light"]["wavelength_nm"], 587.56);
  EXPECT_FALSE(json["points"][1].contains("by_wavelength"));
}

TEST(InspectSpectrum, LimitOfTotalReflectionIsThatOfTheLeastIndex) {
  const auto library = materials::MaterialLibrary::shipped();
  const Inspection lit = inspect(design({"light.spectrum=A"}), library);
  const double reddest_nm = lit.light.back().wavelength_nm;
  const Inspection red = inspect(design({"light.wavelength_nm=" + shortest(reddest_nm)}), library);
  const Inspection blue =
      inspect(design({"light.wavelength_nm=" + shortest(lit.light.front().wavelength_nm)}), library);
  EXPECT_EQ(lit.tir_limit_deg, red.tir_limit_deg);
  EXPECT_LT(*lit.tir_limit_deg, *blue.tir_limit_deg);
  EXPECT_LT(lit.refractive_index, blue.refractive_index);
  EXPECT_GT(lit.refractive_index, red.refractive_index);
  EXPECT_TRUE(lit.warnings.empty());
}

// Tests the warning if the facets reflect only a part of the spectrum totally. The index behind the facets is chosen
// such that total reflection ends between the red and the blue wavelengths.
TEST(InspectSpectrum, WarnsWherePartOfTheLightIsNotTotallyReflected) {
  const auto library = materials::MaterialLibrary::shipped();
  const double index = inspect(design({"light.wavelength_nm=560"}), library).refractive_index;
  const Inspection lit =
      inspect(design({"light.spectrum=A", "body.back_index=" + shortest(index / std::sqrt(2.0))}), library);
  EXPECT_FALSE(lit.tir_limit_deg);
  ASSERT_EQ(lit.warnings.size(), 1U);
  EXPECT_EQ(facts_of(lit.warnings[0]), "no_total_reflection at d.toml");
}

}  // namespace
}  // namespace retrace::studies::spectrum_of_light_test
