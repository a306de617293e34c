// Tests of the reader of glass catalogues: records of the file format, dispersion formulas compared with independent
// calculations, and faulty files.

#include "materials/io/glass_catalogue.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/atomic_file.h"
#include "core/text.h"
#include "materials/io/material_library.h"
#include "tests/support/lines.h"
#include "tests/support/refusals.h"

namespace retrace::materials::glass_catalogue_test {
namespace {

using testing::lines_of;

const std::string kFile = std::string(RETRACE_SOURCE_DIR) + "/tests/data/glasses.agf";

double abbe_number(const Material& glass) {
  const auto n = [&](double wavelength_nm) { return refractive_index(glass.dispersion, wavelength_nm); };
  return (n(587.5618) - 1.0) / (n(486.1327) - n(656.2725));
}

/// Compares n_d and V_d, computed from the coefficients, with the values in the records NM.
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

/// Returns the index at 0.5 um of a glass with this formula and the given coefficients of the record CD.
double index_by(int formula, const std::string& coefficients) {
  const std::string text = "NM x " + std::to_string(formula) + " 0 1 1\nCD " + coefficients + "\nLD 0.4 0.7\n";
  return refractive_index(GlassCatalogue(text, "x.agf").glass("x").dispersion, 500.0);
}

// Compares every formula with an independent calculation at w = 1/2 um, where w^2 = 1/4 um^2.
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

// The internal transmittance T of a thickness d is exp(-a d). Samples may be in any order. If two samples have the same
// wavelength, the thicker one is used.
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
  expect_refusals(complaint, {{"", "x.agf"},
                              {"CC none\n", "x.agf"},
                              {"NM\n", "x.agf:1: NM"},
                              {"NM x\nCD 1\nLD 0.4 0.7\n", "x.agf:1: NM"},
                              {"NM x two\nCD 1\nLD 0.4 0.7\n", "x.agf:1: NM"},
                              {"NM x 14\nCD 1\nLD 0.4 0.7\n", "x.agf:1: NM"},
                              {"NM x 1.5\nCD 1\nLD 0.4 0.7\n", "x.agf:1: NM"},
                              {"CC\nNM x 1\nLD 0.4 0.7\n", "x.agf:2: x"},
                              {"CC\nNM x 1\nCD 1\n", "x.agf:2: x"},
                              {"NM x 1\nCD\nLD 0.4 0.7\n", "x.agf:2: CD"},
                              {"NM x 1\nCD 1 nan\nLD 0.4 0.7\n", "x.agf:2: CD"},
                              {"NM x 1\nCD 1\nLD 0.7\n", "x.agf:3: LD"},
                              {"NM x 1\nCD 1\nLD 0.7 0.4\n", "x.agf:3: LD"},
                              {"NM x 1\nCD 1\nLD 0 0.4\n", "x.agf:3: LD"},
                              {good + "TD 1 2 3\n", "x.agf:4: TD"},
                              {good + "TD 1 2 3 4 5 - 20\n", "x.agf:4: TD"},
                              {good + "TD 0 0 0 0 0\n0 20\n7\n", "x.agf:6: TD"},
                              {good + "0.02\n", "x.agf:4: LD"},
                              {good + "ED 1\nCD 1 0.02\n", "x.agf:5: CD"},
                              {"NM x 2 0 1 1\nCD 1\nLD 0.4 0.7\n", "x.agf:2: CD"},
                              {"NM x 4 0 1 1\nCD 1 1\nLD 0.4 0.7\n", "x.agf:2: CD"}});
}

std::string text_of(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

/// Returns the lines of tests/data/glasses.agf, with samples of the transmittance added to the last glass.
std::vector<std::string> catalogue_lines() {
  std::vector<std::string> lines = lines_of(read_file(kFile));
  for (const char* const sample : {"IT 0.6 0.99 10", "IT 0.4 0.9 25", "IT 0.5 0.95 25"}) lines.push_back(sample);
  return lines;
}

const std::vector<std::string> kNames = {"N-BK7", "POLYCARB", "F_SILICA", "BASF5", "CAF2"};

void expect_same_glass(const Material& a, const Material& b) {
  EXPECT_EQ(a.warnings, b.warnings);
  EXPECT_EQ(a.valid_from_nm, b.valid_from_nm);
  EXPECT_EQ(a.valid_to_nm, b.valid_to_nm);
  EXPECT_EQ(a.temperature_c, b.temperature_c);
  EXPECT_EQ(a.thermo_optic.has_value(), b.thermo_optic.has_value());
  for (const double wavelength_nm : {400.0, 550.0, 587.56, 700.0}) {
    EXPECT_EQ(refractive_index(a.dispersion, wavelength_nm), refractive_index(b.dispersion, wavelength_nm));
    EXPECT_EQ(absorption_per_mm(a, wavelength_nm), absorption_per_mm(b, wavelength_nm));
  }
}

// A line that is broken between two of its fields gives the same glass as the unbroken line.
TEST(GlassCatalogue, BrokenLinesAreJoined) {
  const std::vector<std::string> whole = catalogue_lines();
  const GlassCatalogue expected(text_of(whole), "x.agf");
  for (std::size_t at = 0; at < whole.size(); ++at) {
    for (std::size_t blank = whole[at].find(' '); blank != std::string::npos; blank = whole[at].find(' ', blank + 1)) {
      std::vector<std::string> broken = whole;
      broken[at][blank] = '\n';
      SCOPED_TRACE(broken[at]);
      const GlassCatalogue read(text_of(broken), "x.agf");
      ASSERT_EQ(read.names(), expected.names());
      for (const std::string& name : kNames) expect_same_glass(read.glass(name), expected.glass(name));
    }
  }
}

// The first two characters of a line are the code of its record, for example NM or CD. If a line has lost this code,
// the glass is refused or keeps its index and its wavelength range.
TEST(GlassCatalogue, LostCodesNeverChangeAnIndex) {
  const std::vector<std::string> whole = catalogue_lines();
  const GlassCatalogue expected(text_of(whole), "x.agf");
  int refused = 0;
  for (std::size_t at = 0; at < whole.size(); ++at) {
    std::vector<std::string> without = whole;
    without[at] = whole[at].substr(2);
    SCOPED_TRACE(whole[at]);
    const GlassCatalogue read(text_of(without), "x.agf");
    for (const std::string& name : read.names()) {
      try {
        const Material glass = read.glass(name);
        EXPECT_EQ(refractive_index(glass.dispersion, 550.0), refractive_index(expected.glass(name).dispersion, 550.0));
        EXPECT_EQ(glass.valid_from_nm, expected.glass(name).valid_from_nm);
      } catch (const InputError& error) {
        ++refused;
        EXPECT_GT(error.where().line, 0);
      }
    }
  }
  EXPECT_GT(refused, 10);
}

// If two coefficients are swapped and the index at the d line changes, this index no longer agrees with the value n_d
// of the record NM. A warning is then given.
TEST(GlassCatalogue, SwappedCoefficientsAreWarnedOf) {
  const std::vector<std::string> whole = catalogue_lines();
  const GlassCatalogue right(text_of(whole), "x.agf");
  const std::map<std::string, double> n_d = {
      {"N-BK7", 1.5168}, {"POLYCARB", 1.58547}, {"F_SILICA", 1.458464}, {"BASF5", 1.603233}, {"CAF2", 1.433849}};
  int moved = 0;
  std::string name;
  int line_of_name = 0;
  for (std::size_t at = 0; at < whole.size(); ++at) {
    const std::vector<std::string_view> fields = words_in(whole[at]);
    if (fields.front() == "NM") {
      name = fields[1];
      line_of_name = static_cast<int>(at) + 1;
      EXPECT_TRUE(right.glass(name).warnings.empty()) << name;
    }
    if (fields.front() != "CD") continue;
    for (std::size_t a = 1; a < 7; ++a)
      for (std::size_t b = a + 1; b < 7; ++b) {
        std::vector<std::string> swapped(fields.begin(), fields.end());
        std::swap(swapped[a], swapped[b]);
        std::vector<std::string> lines = whole;
        lines[at].clear();
        for (const std::string& field : swapped) lines[at] += field + " ";
        SCOPED_TRACE(name + ": " + lines[at]);
        const Material glass = GlassCatalogue(text_of(lines), "x.agf").glass(name);
        double n = 0.0;
        try {
          n = refractive_index(glass.dispersion, 587.5618);
        } catch (const InputError&) {  // the swapped coefficients give no real index
        }
        const bool is_off = !(std::abs(n - n_d.at(name)) <= 1e-3);
        moved += is_off ? 1 : 0;
        ASSERT_EQ(glass.warnings.size(), is_off ? 1U : 0U) << n;
        if (!is_off) continue;
        EXPECT_EQ(glass.warnings.front().id, "index_disagrees");
        EXPECT_TRUE(glass.warnings.front().text.starts_with("x.agf:" + std::to_string(line_of_name) + ": NM: "));
      }
  }
  EXPECT_GT(moved, 30);
}

TEST(GlassCatalogue, PlaceholdersOfNdAreNoDoubt) {
  const auto warnings = [](const std::string& nd, const std::string& range) {
    return GlassCatalogue("NM x 5 0 " + nd + " 60\nCD 1.5\nLD " + range + "\n", "x.agf").glass("x").warnings.size();
  };
  EXPECT_EQ(warnings("1.5", "0.4 0.7"), 0U);
  EXPECT_EQ(warnings("1.5009", "0.4 0.7"), 0U);
  EXPECT_EQ(warnings("1.5011", "0.4 0.7"), 1U);
  EXPECT_EQ(warnings("1.4989", "0.4 0.7"), 1U);
  EXPECT_EQ(warnings("-", "0.4 0.7"), 1U);
  EXPECT_EQ(warnings("0", "0.4 0.7"), 0U);
  EXPECT_EQ(warnings("1", "0.4 0.7"), 0U);
  EXPECT_EQ(warnings("1.7", "2 12"), 0U) << "the data of infrared glasses do not reach the d line";
}

// A sample of the transmittance that cannot be used affects neither the index nor the other samples. A warning reports
// the line of this sample.
TEST(GlassCatalogue, BlemishesOfTheTransmittanceAreWarnedOf) {
  const std::vector<std::string> good = {"NM x 5 0 1.5 60", "CD 1.5", "LD 0.4 0.7", "IT 0.4 0.9 25", "IT 0.6 0.95 25"};
  const Material right = GlassCatalogue(text_of(good), "x.agf").glass("x");
  ASSERT_TRUE(right.warnings.empty());
  for (const std::string bad :
       {"IT 0.5 -8e-10 25", "IT 0.5 -999 25", "IT 0.5 12 25", "IT 0.5 99.5 25", "IT 0.5 nan 25", "IT 0.5 0.9 -1",
        "IT 0 0.9 25", "IT -0.5 0.9 25", "IT 0.5 clear 25", "IT 0.5 0.9 25\n0.55 0.9 25"}) {
    for (std::size_t at = 3; at <= good.size(); ++at) {
      std::vector<std::string> lines = good;
      lines.insert(lines.begin() + static_cast<std::ptrdiff_t>(at), bad);
      SCOPED_TRACE(text_of(lines));
      const Material glass = GlassCatalogue(text_of(lines), "x.agf").glass("x");
      EXPECT_EQ(refractive_index(glass.dispersion, 500.0), 1.5);
      for (const double wavelength_nm : {400.0, 500.0, 600.0})
        EXPECT_EQ(absorption_per_mm(glass, wavelength_nm), absorption_per_mm(right, wavelength_nm));
      ASSERT_EQ(glass.warnings.size(), 1U);
      const bool is_joined = bad.find('\n') != std::string::npos;
      EXPECT_EQ(facts_of(glass.warnings.front()),
                "absorption_sample_ignored at x.agf:" + std::to_string(at + (is_joined ? 2 : 1)) + ": IT");
    }
  }
  const auto with = [&](const std::string& more) { return GlassCatalogue(text_of(good) + more, "x.agf").glass("x"); };
  const Material equal = with("IT 0.4 0.9 25\nIT 0.6 0.95 25\n");
  EXPECT_TRUE(equal.warnings.empty());
  EXPECT_EQ(absorption_per_mm(equal, 450.0), absorption_per_mm(right, 450.0));
  const Material two_values = with("IT 0.6 0.90 25\n");
  EXPECT_EQ(two_values.warnings.size(), 1U);
  EXPECT_EQ(absorption_per_mm(two_values, 600.0), absorption_per_mm(right, 400.0));
  const Material noisy = with("IT 0.5 1.0004 25\n");
  EXPECT_EQ(noisy.warnings.size(), 1U);
  EXPECT_EQ(absorption_per_mm(noisy, 500.0), 0.0);
  const Material nothing =
      GlassCatalogue("NM x 5\nCD 1.5\nLD 0.4 0.7\nIT 0.5 12 25\nIT 0.6 12 25\n", "x.agf").glass("x");
  EXPECT_EQ(nothing.warnings.size(), 2U) << "one for both samples, one that no absorption is left";
  EXPECT_EQ(absorption_per_mm(nothing, 500.0), 0.0);
}

TEST(GlassCatalogue, ByteOrderMarkOfUtf8IsNoText) {
  const std::string text = "NM x 5 0 1.5 60\nCD 1.5\nLD 0.4 0.7\n";
  EXPECT_EQ(GlassCatalogue("\xef\xbb\xbf" + text, "x.agf").names(), std::vector<std::string>{"x"});
}

// Errors in the records of one glass do not affect other glasses.
TEST(GlassCatalogue, OtherGlassesAreNoMatter) {
  const GlassCatalogue catalogue("NM y 99\nNM x 5 0 1 1\nCD 1.5\nLD 0.4 0.7\nNM z\n", "x.agf");
  EXPECT_EQ(refractive_index(catalogue.glass("x").dispersion, 500.0), 1.5);
}

TEST(GlassCatalogue, UnknownNamesAreRefused) {
  const GlassCatalogue catalogue = GlassCatalogue::read(kFile);
  catalogue.require("n-BK7", {});
  const std::string complaint = refusal_of([&] { catalogue.require("POLYCARBO", {"d.toml", 7, "body.material"}); });
  EXPECT_EQ(complaint, "d.toml:7: body.material");
}

}  // namespace
}  // namespace retrace::materials::glass_catalogue_test
