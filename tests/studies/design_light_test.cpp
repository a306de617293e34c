// Tests of the keys of designs for light and absorption.
#include "design/io/design_reader.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "tests/studies/design_texts.h"
#include "tests/support/refusals.h"

namespace retrace::studies::design_light_test {
namespace {

TEST(DesignReader, PolarisationIsAWordOrStokesParameters) {
  const auto stokes = [](const std::vector<std::string>& overrides) {
    return set(overrides).light.polarisation.values();
  };
  using Values = std::array<double, 4>;
  EXPECT_EQ(stokes({"light.polarisation=unpolarised"}), (Values{1, 0, 0, 0}));
  EXPECT_EQ(stokes({"light.polarisation=linear"}), (Values{1, 1, 0, 0}));
  EXPECT_EQ(stokes({"light.polarisation=right_circular"}), (Values{1, 0, 0, 1}));
  EXPECT_EQ(stokes({"light.polarisation=left_circular"}), (Values{1, 0, 0, -1}));
  EXPECT_EQ(stokes({"light.polarisation=[1, 0, 0, 0]"}), (Values{1, 0, 0, 0}));
  EXPECT_EQ(stokes({"light.polarisation=[2, 1, -0.5, 0.25]"}), (Values{1, 0.5, -0.25, 0.125}));
  EXPECT_EQ(stokes({"light.polarisation=[1, 0.6, 0.8, 0]"}), (Values{1, 0.6, 0.8, 0}));
  const auto expect_linear = [&](const std::string& angle, double q, double u) {
    const Values values = stokes({"light.polarisation=linear", "light.polarisation_angle_deg=" + angle});
    EXPECT_EQ(values[0], 1.0);
    EXPECT_NEAR(values[1], q, 1e-15);
    EXPECT_NEAR(values[2], u, 1e-15);
    EXPECT_EQ(values[3], 0.0);
  };
  expect_linear("45", 0.0, 1.0);
  expect_linear("90", -1.0, 0.0);
  expect_linear("-30", 0.5, -0.5 * std::sqrt(3.0));
  expect_linear("360", 1.0, 0.0);
}

TEST(DesignReader, WhatIsNoPolarisationIsRefused) {
  const auto refused = [](const std::string& value) {
    return complaint(with_line(11, "[light]\npolarisation = " + value));
  };
  const std::string where = "d.toml:12: light.polarisation";
  expect_refusals(refused, {{"\"liner\"", where},
                            {"1", where},
                            {"[1, 0, 0]", where},
                            {"[]", where},
                            {"[1, 0, 0, \"x\"]", where},
                            {"[1, 0, 0, inf]", where}});
  expect_refusals(refused, {{"[0, 0, 0, 0]", where},
                            {"[-1, 0, 0, 1]", where},
                            {"[1, 0.8, 0, 0.7]", where},
                            {"\"linear\"\npolarisation_angle_deg = 361", "d.toml:13: light.polarisation_angle_deg"}});
  const std::string alone = "--set light.polarisation_angle_deg=0: light.polarisation_angle_deg";
  EXPECT_EQ(set_complaint({"light.polarisation_angle_deg=0"}), alone);
  EXPECT_EQ(set_complaint({"light.polarisation=left_circular", "light.polarisation_angle_deg=0"}), alone);
  EXPECT_EQ(set_complaint({"light.polarisation=[1, 1, 0, 0]", "light.polarisation_angle_deg=0"}), alone);
}

TEST(DesignReader, SpectrumIsANameAFileOrLines) {
  using Kind = design::LightSpectrum::Kind;
  EXPECT_FALSE(set({}).light.spectrum());
  const auto spectrum = [](const std::string& value) { return *set({"light.spectrum=" + value}).light.spectrum(); };
  EXPECT_EQ(spectrum("A").kind, Kind::illuminant_a);
  EXPECT_EQ(spectrum("D65").kind, Kind::illuminant_d65);
  EXPECT_TRUE(spectrum("A").photopic);
  EXPECT_FALSE(set({"light.spectrum=A", "light.weighting=radiant"}).light.spectrum()->photopic);
  EXPECT_TRUE(set({"light.spectrum=A", "light.weighting=photopic"}).light.spectrum()->photopic);
  const design::LightSpectrum file = spectrum("\"lamps/led.csv\"");
  EXPECT_EQ(file.kind, Kind::file);
  EXPECT_EQ(file.name, "lamps/led.csv");
  EXPECT_EQ(file.file, "lamps/led.csv") << "of an override: from the working directory";
  EXPECT_EQ(
      design::parse_design(joined(kLines) + "[light]\nspectrum = \"led.csv\"\n", "a/d.toml", {}).light.spectrum()->file,
      "a/led.csv");
  const design::LightSpectrum lines = spectrum("[[589.6, 1], [589.0, 2]]");
  EXPECT_EQ(lines.kind, Kind::lines);
  ASSERT_EQ(lines.lines.size(), 2U);
  EXPECT_EQ(lines.lines[0].wavelength_nm, 589.0) << "ascending";
  EXPECT_EQ(lines.lines[0].power, 2.0);
  EXPECT_EQ(lines.lines[1].wavelength_nm, 589.6);
  EXPECT_EQ(
      design::parse_design(joined(kLines) + "[light]\nspectrum = \"A\"\n", "d.toml", {}).where("light.spectrum").line,
      12);
}

TEST(DesignReader, AbsorptionIsANumberOrPairsOverTheWavelength) {
  const std::string key = "body.absorption_per_mm";
  const design::Design red = set({key + "=[[400, 2], [600, 0.5], [800, 0]]"});
  const auto curve = std::get<std::vector<design::SpectralAbsorption>>(red.substance.absorption_per_mm);
  ASSERT_EQ(curve.size(), 3U);
  EXPECT_EQ(curve[1].wavelength_nm, 600.0);
  EXPECT_EQ(curve[1].per_mm, 0.5);
  EXPECT_EQ(set({key + "=0.1"}).substance.absorption_per_mm, design::Absorption(0.1));
  const auto refused = [&](const std::string& value) {
    return complaint(with_line(11, "absorption_per_mm = " + value));
  };
  const std::string where = "d.toml:11: body.absorption_per_mm";
  expect_refusals(refused, {{"[[400, 1], [400, 2]]", where},
                            {"[[500, 1], [400, 2]]", where},
                            {"[[500, 1]]", where},
                            {"[[500, -1], [600, 1]]", where},
                            {"[500, 600]", where},
                            {"[]", where},
                            {"\"much\"", where}});
}

TEST(DesignReader, WhatIsNoSpectrumIsRefused) {
  const auto refused = [](const std::string& value) {
    return complaint(with_line(11, "[light]\nspectrum = " + value));
  };
  const std::string where = "d.toml:12: light.spectrum";
  expect_refusals(refused, {{"\"F11\"", where},
                            {"\"a\"", where},
                            {"\"\"", where},
                            {"\"a\\u0000.csv\"", where},
                            {"555", where},
                            {"{ a = 1 }", where}});
  expect_refusals(refused, {{"[]", where},
                            {"[555, 1]", where},
                            {"[[555]]", where},
                            {"[[555, 1, 2]]", where},
                            {"[[555, \"x\"]]", where},
                            {"[[555, 1], [0, 1]]", where},
                            {"[[555, -1]]", where},
                            {"[[555, nan]]", where},
                            {"[[555, 1], [555.0, 2]]", where}});
  EXPECT_EQ(refused("\"A\"\nwavelength_nm = 555"), "d.toml:13: light.wavelength_nm");
  EXPECT_EQ(refused("\"A\"\nweighting = \"eye\""), "d.toml:13: light.weighting");
  EXPECT_EQ(set_complaint({"light.weighting=photopic"}), "--set light.weighting=photopic: light.weighting");
}

}  // namespace
}  // namespace retrace::studies::design_light_test
