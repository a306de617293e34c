// Catalogues of glass: lines of the format, its dispersion formulas by hand, and what is wrong with files.

#include "materials/io/glass_catalogue.h"

#include <gtest/gtest.h>

#include <cmath>

#include "materials/io/material_library.h"
#include "tests/support/refusals.h"

namespace retrace::materials::glass_catalogue_test {
namespace {

const std::string kFile = std::string(RETRACE_SOURCE_DIR) + "/tests/data/glasses.agf";

double abbe_number(const Material& glass) {
  const auto n = [&](double wavelength_nm) { return refractive_index(glass.dispersion, wavelength_nm); };
  return (n(587.5618) - 1.0) / (n(486.1327) - n(656.2725));
}

/// n_d and V_d as the lines NM state them beside the coefficients.
TEST(GlassCatalogue, IndexAndAbbeNumberOfTheCatalogue) {
  struct Case {
    const char* name;
    double n_d, n_within, abbe, abbe_within;
  };
  const GlassCatalogue catalogue = GlassCatalogue::read(kFile);
  for (const auto& [name, n_d, n_within, abbe, abbe_within] :
       {Case{"N-BK7", 1.5168, 1e-6, 64.17, 5e-3}, Case{"POLYCARB", 1.58547, 1e-6, 29.909185, 1e-4},
        Case{"F_SILICA", 1.458464, 1e-6, 67.821433, 1e-3}, Case{"BASF5", 1.603233, 1e-6, 42.504788, 1e-3},
        Case{"CAF2", 1.433849, 1e-6, 94.995854, 1e-3}}) {
    const Material glass = catalogue.glass(name);
    EXPECT_EQ(glass.name, name);
    EXPECT_NEAR(refractive_index(glass.dispersion, 587.5618), n_d, n_within) << name;
    EXPECT_NEAR(abbe_number(glass), abbe, abbe_within) << name;
  }
}

TEST(GlassCatalogue, IsTheShippedGlass) {
  const Material read = GlassCatalogue::read(kFile).glass("n-bk7");
  const MaterialLibrary library = MaterialLibrary::read(std::string(RETRACE_SOURCE_DIR) + "/data/materials.toml");
  const Material& shipped = library.find("N-BK7");
  EXPECT_EQ(read.valid_from_nm, shipped.valid_from_nm);
  EXPECT_EQ(read.valid_to_nm, shipped.valid_to_nm);
  for (const double temperature_c : {-40.0, 20.0, 80.0})
    EXPECT_EQ(index_relative_to_air(read, library.air(), 633.0, temperature_c),
              index_relative_to_air(shipped, library.air(), 633.0, temperature_c));
}

TEST(GlassCatalogue, NoThermoOpticCoefficientsAreNone) {
  const GlassCatalogue catalogue = GlassCatalogue::read(kFile);
  EXPECT_FALSE(catalogue.glass("BASF5").thermo_optic);
  EXPECT_TRUE(catalogue.glass("CAF2").thermo_optic);
  EXPECT_EQ(catalogue.glass("CAF2").temperature_c, 20.0);
}

/// The index at 0.5 um of a glass with that formula and the coefficients 0.1, 0.02, 0.3, ... of CD.
double index_by(int formula, const std::string& coefficients) {
  const std::string text = "NM x " + std::to_string(formula) + " 0 1 1\nCD " + coefficients + "\nLD 0.4 0.7\n";
  return refractive_index(GlassCatalogue(text, "x.agf").glass("x").dispersion, 500.0);
}

// w = 1/2, w^2 = 1/4: every formula by hand.
TEST(GlassCatalogue, EveryFormulaByHand) {
  const double s = 0.25;
  const auto term = [&](double strength, double resonance) { return strength * s / (s - resonance); };
  EXPECT_NEAR(index_by(1, "2 0.1 0.01 0.002 0.0003 0.00004"),
              std::sqrt(2.0 + 0.1 / 4 + 0.01 * 4 + 0.002 * 16 + 0.0003 * 64 + 0.00004 * 256), 1e-15);
  EXPECT_NEAR(index_by(2, "1 0.01 0.2 0.02 0.9 100"),
              std::sqrt(1.0 + term(1.0, 0.01) + term(0.2, 0.02) + term(0.9, 100.0)), 1e-15);
  const double l = 1.0 / (s - 0.028);
  EXPECT_NEAR(index_by(3, "1.5 0.01 0.001 0.02 0.003 0.0004"),
              1.5 + 0.01 * l + 0.001 * l * l + 0.02 / 4 + 0.003 / 16 + 0.0004 / 64, 1e-15);
  EXPECT_NEAR(index_by(4, "0.5 1 0.1 0.02 0.2"), std::sqrt(1.0 + 0.5 + term(1.0, 0.01) + 0.02 / (s - 0.04)), 1e-15);
  EXPECT_NEAR(index_by(5, "1.5 0.01 0.001"), 1.5 + 0.01 * 2 + 0.001 * std::pow(2.0, 3.5), 1e-15);
  EXPECT_NEAR(index_by(6, "1 0.01 0.2 0.02 0.3 0.03 0.9 100"),
              std::sqrt(1.0 + term(1.0, 0.01) + term(0.2, 0.02) + term(0.3, 0.03) + term(0.9, 100.0)), 1e-15);
  EXPECT_NEAR(index_by(7, "2 0.01 0.02 0.1"), std::sqrt(2.0 + 0.01 / (s - 0.02) - 0.1 / 4), 1e-15);
  EXPECT_NEAR(index_by(7, "2 0.01 0 0.1"), std::sqrt(2.0 + 0.01 / s - 0.1 / 4), 1e-15);
  EXPECT_NEAR(index_by(8, "2 0.5 0.02 0.1"), std::sqrt(2.0 + term(0.5, 0.02) - 0.1 / 4), 1e-15);
  EXPECT_NEAR(index_by(9, "1.2 0.5 0.02 0.4 0.03"), std::sqrt(1.2 + term(0.5, 0.02) + term(0.4, 0.03)), 1e-15);
  const double schott = 2.0 + 0.1 / 4 + 0.01 * 4 + 0.002 * 16 + 0.0003 * 64 + 0.00004 * 256;
  EXPECT_NEAR(index_by(10, "2 0.1 0.01 0.002 0.0003 0.00004 0.000005 0.0000006"),
              std::sqrt(schott + 0.000005 * 1024 + 0.0000006 * 4096), 1e-15);
  EXPECT_NEAR(index_by(11, "1 0.01 0.2 0.02 0.3 0.03 0.4 0.04 0.9 100"),
              std::sqrt(1.0 + term(1.0, 0.01) + term(0.2, 0.02) + term(0.3, 0.03) + term(0.4, 0.04) + term(0.9, 100.0)),
              1e-15);
  EXPECT_NEAR(index_by(12, "2 0.1 0.01 0.002 0.0003 0.00004 0.05 0.06"), std::sqrt(schott + 0.05 / 16 + 0.06 / 64),
              1e-15);
  EXPECT_NEAR(index_by(13, "2 0.1 0.05 0.01 0.002 0.0003 0.00004 0.000005 0.0000006"),
              std::sqrt(schott + 0.05 / 16 + 0.000005 * 1024 + 0.0000006 * 4096), 1e-15);
}

// Internal transmittance T of a thickness d is exp(-a d); samples in any order, the thicker of two of one wavelength.
TEST(GlassCatalogue, TransmittanceIsAbsorption) {
  const Material glass = GlassCatalogue(
                             "NM x 1 0 1 1\nCD 2.25\nLD 0.4 0.7\nIT 0.6 0.5 10\nIT 0.4 0.9 5\nIT 0.4 0.8 25\n"
                             "IT 0.3 0 25\nIT 0.5 0.7 0\nIT 0.7 0.9\n",
                             "x.agf")
                             .glass("x");
  EXPECT_NEAR(absorption_per_mm(glass, 600.0), std::log(2.0) / 10.0, 1e-15);
  EXPECT_NEAR(absorption_per_mm(glass, 400.0), -std::log(0.8) / 25.0, 1e-15);
  EXPECT_NEAR(absorption_per_mm(glass, 500.0), 0.5 * (std::log(2.0) / 10.0 - std::log(0.8) / 25.0), 1e-15);
  EXPECT_EQ(absorption_per_mm(glass, 300.0), absorption_per_mm(glass, 400.0));
  EXPECT_EQ(absorption_per_mm(GlassCatalogue::read(kFile).glass("POLYCARB"), 500.0), 0.0);
  EXPECT_EQ(absorption_per_mm(GlassCatalogue::read(kFile).glass("CAF2"), 500.0), 0.0);
}

TEST(GlassCatalogue, Utf16IsRead) {
  const std::string text = "NM \xe9 5 0 1 1\r\nNM x 5 0 1 1\r\nCD 1.5\r\nLD 0.4 0.7\r\n";
  for (const bool is_little : {true, false}) {
    std::string wide = is_little ? "\xff\xfe" : "\xfe\xff";
    for (const char c : text) wide += is_little ? std::string{c, '\0'} : std::string{'\0', c};
    const GlassCatalogue catalogue(wide, "x.agf");
    EXPECT_EQ(catalogue.names(), (std::vector<std::string>{"?", "x"}));
    EXPECT_EQ(refractive_index(catalogue.glass("X").dispersion, 500.0), 1.5);
  }
}

TEST(GlassCatalogue, BadFilesAreRefusedWithTheirLine) {
  const auto complaint = [](const std::string& text) {
    return refusal_of([&] { static_cast<void>(GlassCatalogue(text, "x.agf").glass("x")); });
  };
  const std::string good = "NM x 2 0 1 1\nCD 1 0.01\nLD 0.4 0.7\n";
  EXPECT_EQ(complaint(good), "");
  expect_messages(
      complaint,
      {{"", "x.agf: holds no glass: no line begins with NM"},
       {"CC none\n", "x.agf: holds no glass: no line begins with NM"},
       {"NM\n", "x.agf:1: NM: must have a name"},
       {"NM x\nCD 1\nLD 0.4 0.7\n", "x.agf:1: NM: must have at least 1 numbers, got 0"},
       {"NM x two\nCD 1\nLD 0.4 0.7\n", "x.agf:1: NM: must be finite numbers, got \"two\""},
       {"NM x 14\nCD 1\nLD 0.4 0.7\n", "x.agf:1: NM: the dispersion formula must be 1 to 13, got 14"},
       {"NM x 1.5\nCD 1\nLD 0.4 0.7\n", "x.agf:1: NM: the dispersion formula must be 1 to 13, got 1.5"},
       {"CC\nNM x 1\nLD 0.4 0.7\n", "x.agf:2: x: has no line CD of coefficients"},
       {"CC\nNM x 1\nCD 1\n", "x.agf:2: x: has no line LD of the wavelengths that its formula is for"},
       {"NM x 1\nCD\nLD 0.4 0.7\n", "x.agf:2: CD: must have at least 1 numbers, got 0"},
       {"NM x 1\nCD 1 nan\nLD 0.4 0.7\n", "x.agf:2: CD: must be finite numbers, got \"nan\""},
       {"NM x 1\nCD 1\nLD 0.7\n", "x.agf:3: LD: must have at least 2 numbers, got 1"},
       {"NM x 1\nCD 1\nLD 0.7 0.4\n", "x.agf:3: LD: must be wavelengths that ascend from above 0, got 0.7 and 0.4"},
       {"NM x 1\nCD 1\nLD 0 0.4\n", "x.agf:3: LD: must be wavelengths that ascend from above 0, got 0 and 0.4"},
       {good + "TD 1 2 3\n", "x.agf:4: TD: must have at least 6 numbers, got 3"},
       {good + "TD 1 2 3 4 5 - 20\n", "x.agf:4: TD: must be finite numbers, got \"-\""},
       {good + "IT 0.5 1.1 10\n", "x.agf:4: IT: the transmittance must be >= 0 and <= 1, got 1.1"},
       {good + "IT 0 0.5 10\n", "x.agf:4: IT: the wavelength must be > 0, got 0"},
       {good + "IT 0.5 0.5 -1\n", "x.agf:4: IT: the thickness must be >= 0, got -1"},
       {good + "IT 0.5 clear 1\n", "x.agf:4: IT: must be finite numbers, got \"clear\""}});
}

// What one glass has wrong is no matter of the others.
TEST(GlassCatalogue, OtherGlassesAreNoMatter) {
  const GlassCatalogue catalogue("NM y 99\nNM x 5 0 1 1\nCD 1.5\nLD 0.4 0.7\nNM z\n", "x.agf");
  EXPECT_EQ(refractive_index(catalogue.glass("x").dispersion, 500.0), 1.5);
}

TEST(GlassCatalogue, UnknownNamesAreRefused) {
  const GlassCatalogue catalogue = GlassCatalogue::read(kFile);
  catalogue.require("n-BK7", {});
  const std::string complaint = refusal_of([&] { catalogue.require("POLYCARBO", {"d.toml", 7, "body.material"}); });
  EXPECT_EQ(complaint.find("d.toml:7: body.material: no glass of that name among the 5 of "), 0U) << complaint;
  EXPECT_NE(complaint.find(", got \"POLYCARBO\"; did you mean \"POLYCARB\"?"), std::string::npos) << complaint;
}

}  // namespace
}  // namespace retrace::materials::glass_catalogue_test
