#include "materials/spectrum.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <functional>
#include <string>

#include "core/error.h"
#include "materials/dispersion.h"
#include "materials/fresnel.h"
#include "materials/io/material_library.h"
#include "materials/io/spectrum_reader.h"
#include "tests/support/refusals.h"

namespace retrace::materials::spectrum_test {
namespace {

namespace fs = std::filesystem;

CieTable cie() {
  return read_cie_table(std::string(RETRACE_SOURCE_DIR) + "/data/cie_v_a_d65_5nm.csv");
}

/// Returns the luminous mean of a function f: sum S V f / sum S V over the table, as the CIE defines photometric
/// means. S is the power of the lamp and V the luminous efficiency.
double luminous_mean(const SpectralCurve& lamp, const std::function<double(double)>& f) {
  const CieTable table = cie();
  double sum = 0.0;
  double weighted = 0.0;
  for (std::size_t k = 0; k < lamp.values.size(); ++k) {
    const double flux = lamp.values[k] * table.photopic_efficiency.values[k];
    sum += flux;
    weighted += flux * f(lamp.wavelengths_nm[k]);
  }
  return weighted / sum;
}

double mean(const Spectrum& spectrum, const std::function<double(double)>& f) {
  double sum = 0.0;
  for (std::size_t k = 0; k < spectrum.size(); ++k) sum += spectrum.weights[k] * f(spectrum.wavelengths_nm[k]);
  return sum;
}

// Compares the table with the formula of CIE 015:2018, 3.1: S(w) = 100 (560/w)^5 (exp(c / 560) - 1) / (exp(c / w) - 1),
// with c = 1.435e7 / 2848 and the wavelength w in nm.
TEST(CieTable, IlluminantAIsThatOfItsFormula) {
  const double c = 1.435e7 / 2848.0;
  const SpectralCurve a = cie().illuminant_a;
  ASSERT_EQ(a.wavelengths_nm.size(), 81U);
  for (std::size_t k = 0; k < a.values.size(); ++k) {
    const double w = a.wavelengths_nm[k];
    const double expected = 100.0 * std::pow(560.0 / w, 5) * std::expm1(c / 560.0) / std::expm1(c / w);
    EXPECT_NEAR(a.values[k], expected, 1e-5 * expected) << w;
  }
}

TEST(CieTable, EfficiencyPeaksAt555AndLampsAreNormalisedAt560) {
  const CieTable table = cie();
  EXPECT_EQ(table.photopic_efficiency.at(555.0), 1.0);
  EXPECT_EQ(table.illuminant_a.at(560.0), 100.0);
  EXPECT_EQ(table.illuminant_d65.at(560.0), 100.0);
  EXPECT_EQ(table.photopic_efficiency.wavelengths_nm.front(), 380.0);
  EXPECT_EQ(table.photopic_efficiency.wavelengths_nm.back(), 780.0);
}

TEST(SpectralCurve, IsLinearBetweenItsSamplesAndZeroOutside) {
  const SpectralCurve curve{{400.0, 500.0, 600.0}, {1.0, 3.0, 0.0}};
  EXPECT_EQ(curve.at(400.0), 1.0);
  EXPECT_DOUBLE_EQ(curve.at(425.0), 1.5);
  EXPECT_EQ(curve.at(500.0), 3.0);
  EXPECT_EQ(curve.at(600.0), 0.0);
  EXPECT_EQ(curve.at(399.9), 0.0);
  EXPECT_EQ(curve.at(600.1), 0.0);
}

// Compares the luminous centroids with sums over the table. The trapezoidal rule halves the weights of the two ends of
// the table, which contain less than 2e-6 of the flux.
TEST(Spectrum, LuminousCentroidsAreTheSumsOfTheTable) {
  const CieTable table = cie();
  for (const SpectralCurve* lamp : {&table.illuminant_a, &table.illuminant_d65}) {
    const double expected = luminous_mean(*lamp, [](double w) { return w; });
    const Spectrum resolved = resolved_spectrum(*lamp, &table.photopic_efficiency);
    EXPECT_NEAR(resolved.centroid_nm(), expected, 1e-3);
    EXPECT_NEAR(traced_spectrum(resolved).centroid_nm(), resolved.centroid_nm(), 1e-9);
  }
  EXPECT_GT(resolved_spectrum(table.illuminant_a, &table.photopic_efficiency).centroid_nm(),
            resolved_spectrum(table.illuminant_d65, &table.photopic_efficiency).centroid_nm())
      << "A is the redder of the two";
}

TEST(Spectrum, WeightsAddToOneAndWavelengthsAscend) {
  const CieTable table = cie();
  const auto expect_sound = [](const Spectrum& rule) {
    EXPECT_NEAR(mean(rule, [](double) { return 1.0; }), 1.0, 1e-13);
    for (std::size_t k = 0; k < rule.size(); ++k) {
      EXPECT_GT(rule.weights[k], 0.0);
      EXPECT_GE(rule.wavelengths_nm[k], k > 0 ? rule.wavelengths_nm[k - 1] : 380.0);
      EXPECT_LE(rule.wavelengths_nm[k], 780.0);
    }
  };
  for (const SpectralCurve* efficiency : {static_cast<const SpectralCurve*>(nullptr), &table.photopic_efficiency}) {
    const Spectrum resolved = resolved_spectrum(table.illuminant_d65, efficiency);
    for (std::size_t count = 1; count <= 24; ++count) {
      EXPECT_EQ(gauss_rule(resolved, count).size(), count);
      expect_sound(gauss_rule(resolved, count));
      EXPECT_LE(traced_spectrum(resolved, count).size(), 2 * count);
      expect_sound(traced_spectrum(resolved, count));
    }
    EXPECT_EQ(traced_spectrum(resolved).size(), 2 * kSpectralParts);
  }
}

// If the flux is distributed unevenly, one sample may extend over several spans of the spectrum. Together, these
// spans must keep the weight of the sample.
TEST(Spectrum, OneStrongSampleAmongManyKeepsItsShare) {
  SpectralCurve lamp;
  for (int k = 0; k < 61; ++k) {
    lamp.wavelengths_nm.push_back(400.0 + 5.0 * k);
    lamp.values.push_back(k == 20 ? 540.0 : 1.0);
  }
  const Spectrum rule = traced_spectrum(resolved_spectrum(lamp, nullptr));
  double at_500 = 0.0;
  for (std::size_t k = 0; k < rule.size(); ++k) at_500 += rule.wavelengths_nm[k] == 500.0 ? rule.weights[k] : 0.0;
  EXPECT_NEAR(at_500, 0.6, 1e-12) << "three whole parts of five lie on it";
  EXPECT_NEAR(rule.centroid_nm(), resolved_spectrum(lamp, nullptr).centroid_nm(), 1e-9);
}

TEST(Spectrum, GaussRuleIsExactForPolynomialsOfDegree2NodesLess1) {
  const CieTable table = cie();
  const Spectrum resolved = resolved_spectrum(table.illuminant_a, &table.photopic_efficiency);
  for (const std::size_t nodes : {1U, 2U, 5U, 9U}) {
    const Spectrum rule = gauss_rule(resolved, nodes);
    for (std::size_t degree = 0; degree <= 2 * nodes; ++degree) {
      const auto power = [&](double w) { return std::pow((w - 580.0) / 200.0, static_cast<double>(degree)); };
      const double error = std::abs(mean(rule, power) - mean(resolved, power));
      if (degree < 2 * nodes)
        EXPECT_LT(error, 1e-14) << nodes << " nodes, degree " << degree;
      else
        EXPECT_GT(error, 1e-10) << nodes << " nodes must not be exact for degree " << degree;
    }
  }
}

// The index of PMMA, its reflectance and a strong absorption band are smooth functions of the wavelength. The number
// of nodes is sufficient if twice as many nodes change the means by less than the tolerances.
TEST(Spectrum, NodesAreEnoughForSmoothProperties) {
  const CieTable table = cie();
  const auto library = MaterialLibrary::read(std::string(RETRACE_SOURCE_DIR) + "/data/materials.toml");
  const auto index = [&](double w) { return index_relative_to_air(library.find("PMMA"), library.air(), w); };
  const auto entered_twice = [&](double w) { return std::pow(1.0 - reflectance(1.0 / index(w), 1.0), 2); };
  const auto band = [](double w) { return std::exp(-2.0 * std::exp(-0.5 * std::pow((w - 620.0) / 60.0, 2))); };
  for (const SpectralCurve* lamp : {&table.illuminant_a, &table.illuminant_d65})
    for (const SpectralCurve* efficiency : {static_cast<const SpectralCurve*>(nullptr), &table.photopic_efficiency}) {
      const Spectrum resolved = resolved_spectrum(*lamp, efficiency);
      const Spectrum rule = traced_spectrum(resolved);
      const Spectrum twice = traced_spectrum(resolved, 2 * kSpectralParts);
      const bool is_luminous = efficiency != nullptr;
      EXPECT_NEAR(mean(rule, entered_twice), mean(resolved, entered_twice), is_luminous ? 3e-8 : 4e-7);
      EXPECT_NEAR(mean(rule, entered_twice), mean(twice, entered_twice), is_luminous ? 3e-8 : 4e-7);
      EXPECT_NEAR(mean(rule, band), mean(resolved, band), is_luminous ? 5e-4 : 5e-3);
      EXPECT_LT(std::abs(mean(twice, band) - mean(resolved, band)),
                0.3 * std::abs(mean(rule, band) - mean(resolved, band)));
    }
}

// Tests bounds for the errors of the means of two functions of the wavelength: a step and a square root. Total
// reflection that ends at a wavelength causes a step. The reflectance, which falls from 1 at this wavelength, changes
// like a square root.
TEST(Spectrum, AStepCostsLessThanATenthOfIt) {
  const CieTable table = cie();
  for (const SpectralCurve* lamp : {&table.illuminant_a, &table.illuminant_d65}) {
    const Spectrum resolved = resolved_spectrum(*lamp, &table.photopic_efficiency);
    const Spectrum rule = traced_spectrum(resolved);
    for (double edge = 400.0; edge < 760.0; edge += 0.7) {
      const auto step = [&](double w) { return w < edge ? 1.0 : 0.0; };
      const auto root = [&](double w) { return w > edge ? std::sqrt((w - edge) / 200.0) : 0.0; };
      EXPECT_LE(std::abs(mean(rule, step) - mean(resolved, step)), 0.1) << edge;
      EXPECT_LE(std::abs(mean(rule, root) - mean(resolved, root)), 0.016) << edge;
    }
  }
}

TEST(Spectrum, LinesAreKeptAndWeighted) {
  const CieTable table = cie();
  const std::vector<SpectralLine> lines = {{300.0, 5.0}, {450.0, 2.0}, {555.0, 1.0}, {700.0, 0.0}};
  const Spectrum seen = line_spectrum(lines, &table.photopic_efficiency);
  ASSERT_EQ(seen.wavelengths_nm, (std::vector<double>{450.0, 555.0}));
  EXPECT_NEAR(seen.weights[0], 2.0 * 0.038 / (2.0 * 0.038 + 1.0), 1e-15);
  const Spectrum radiant = line_spectrum(lines, nullptr);
  ASSERT_EQ(radiant.wavelengths_nm, (std::vector<double>{300.0, 450.0, 555.0}));
  EXPECT_NEAR(radiant.weights[0], 5.0 / 8.0, 1e-15);
  EXPECT_EQ(traced_spectrum(radiant).weights, radiant.weights);
}

// The centroid of a lamp with constant power is at the centre of its range, even if only two samples describe the
// lamp.
TEST(Spectrum, FewSamplesDescribeASmoothLamp) {
  const Spectrum flat = resolved_spectrum({{400.3, 699.7}, {2.0, 2.0}}, nullptr);
  EXPECT_NEAR(flat.centroid_nm(), 550.0, 1e-9);
  EXPECT_GT(flat.size(), 50U);
  const CieTable table = cie();
  const Spectrum seen = resolved_spectrum({{380.0, 780.0}, {1.0, 1.0}}, &table.photopic_efficiency);
  EXPECT_NEAR(
      seen.centroid_nm(),
      luminous_mean({table.illuminant_a.wavelengths_nm, std::vector<double>(81, 1.0)}, [](double w) { return w; }),
      1e-3);
}

TEST(Spectrum, UnitsOfPowerDoNotMatter) {
  const SpectralCurve lamp{{400.0, 584.2, 700.0}, {1e200, 1e308, 5e307}};
  SpectralCurve small = lamp;
  for (double& power : small.values) power = std::ldexp(power, -1000);
  EXPECT_EQ(resolved_spectrum(lamp, nullptr).weights, resolved_spectrum(small, nullptr).weights);
  const Spectrum lines = line_spectrum({{500.0, 1e308}, {600.0, 1e308}}, nullptr);
  EXPECT_EQ(lines.weights, (std::vector<double>{0.5, 0.5}));
  EXPECT_EQ(line_spectrum({{500.0, 1e-310}}, nullptr).weights, std::vector<double>{1.0}) << "subnormal";
}

TEST(Spectrum, NoFluxIsAnError) {
  const CieTable table = cie();
  const std::string unseen = refusal_of([&] { line_spectrum({{1064.0, 1.0}}, &table.photopic_efficiency); });
  EXPECT_EQ(unseen, "refused");
  EXPECT_EQ(refusal_of([&] { line_spectrum({{550.0, 0.0}}, nullptr); }), "refused");
  EXPECT_EQ(refusal_of([&] { resolved_spectrum({{400.0, 500.0}, {0.0, 0.0}}, nullptr); }), "refused");
  EXPECT_EQ(refusal_of([&] { line_spectrum({{1064.0, 1.0}}, nullptr); }), "");
}

TEST(SpectrumReader, ReadsPowerOverWavelength) {
  const SpectralCurve lamp = parse_spectral_power(
      "\xef\xbb\xbf# a lamp\r\nwavelength_nm , power\r\n\r\n400,1e-3\r\n 500.5 , 2\n600,0", "l.csv");
  EXPECT_EQ(lamp.wavelengths_nm, (std::vector<double>{400.0, 500.5, 600.0}));
  EXPECT_EQ(lamp.values, (std::vector<double>{1e-3, 2.0, 0.0}));
}

TEST(SpectrumReader, WhatIsNoSpectrumIsRefusedWithFileLineAndColumn) {
  const auto refused = [](const std::string& text) { return refusal_of([&] { parse_spectral_power(text, "l.csv"); }); };
  const std::string head = "wavelength_nm,power\n";
  expect_refusals(refused, {{"", "l.csv"},
                            {"# only words\n", "l.csv"},
                            {"400,1\n500,2\n", "l.csv:1"},
                            {"wavelength_nm;power\n", "l.csv:1"},
                            {head, "l.csv"},
                            {head + "400,1\n", "l.csv"},
                            {head + "400,1\n500\n", "l.csv:3"},
                            {head + "400,1,2\n", "l.csv:2"},
                            {head + "400,1\n500,nan\n", "l.csv:3: power"},
                            {head + "400,1\n500,inf\n", "l.csv:3: power"},
                            {head + "400,\n", "l.csv:2: power"},
                            {head + "400,1x\x01\n", "l.csv:2: power"},
                            {head + "400,1\n500,-0.5\n", "l.csv:3: power"},
                            {head + "400,1\n400,1\n", "l.csv:3: wavelength_nm"},
                            {head + "500,1\n400,1\n", "l.csv:3: wavelength_nm"},
                            {head + "0.5,1\n", "l.csv:2: wavelength_nm"},
                            {std::string((1U << 20) + 1, '#'), "l.csv"}});
}

TEST(SpectrumReader, FilesThatCannotBeReadAreRefused) {
  EXPECT_EQ(refusal_of([] { read_spectral_power("no/such.csv"); }), "no/such.csv");
  EXPECT_NE(refusal_of([] { read_spectral_power(fs::temp_directory_path()); }), "");
  EXPECT_EQ(refusal_of([] { read_spectral_power("/dev/zero"); }), "/dev/zero");
}

}  // namespace
}  // namespace retrace::materials::spectrum_test
