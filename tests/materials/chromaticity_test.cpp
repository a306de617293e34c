#include "materials/chromaticity.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "core/error.h"
#include "materials/io/spectrum_reader.h"
#include "tests/support/refusals.h"

// Tests of the colour matching functions against published values of the CIE for its illuminants.

namespace retrace::materials::chromaticity_test {
namespace {

const std::string kData = RETRACE_SOURCE_DIR "/data/";

ColourMatching functions() {
  return read_colour_matching(kData + "cie_xyz_1931_5nm.csv");
}

Chromaticity colour_of(const SpectralCurve& power) {
  return chromaticity(tristimulus(power, functions()));
}

SpectralCurve equal_energy() {
  return {{380.0, 780.0}, {1.0, 1.0}};
}

// Compares the chromaticities with CIE 015:2018: (x, y) = (0.44757, 0.40745) for A and (0.31271, 0.32902) for D65. The
// published values are sums in steps of 1 nm. Sums in steps of 5 nm differ from them in the fifth digit.
TEST(Chromaticity, OfIlluminantsIsThatOfTheCie) {
  const CieTable cie = read_cie_table(kData + "cie_v_a_d65_5nm.csv");
  constexpr double digit = 1.5e-5;
  const Chromaticity a = colour_of(cie.illuminant_a);
  EXPECT_NEAR(a.x, 0.44757, digit);
  EXPECT_NEAR(a.y, 0.40745, digit);
  const Chromaticity d65 = colour_of(cie.illuminant_d65);
  EXPECT_NEAR(d65.x, 0.31271, digit);
  EXPECT_NEAR(d65.y, 0.32902, digit);
  const Chromaticity e = colour_of(equal_energy());
  EXPECT_NEAR(e.x, 1.0 / 3.0, digit);
  EXPECT_NEAR(e.y, 1.0 / 3.0, digit);
  EXPECT_NEAR(e.z(), 1.0 / 3.0, digit);
}

TEST(Chromaticity, OfAMixtureLiesBetweenItsParts) {
  const SpectralCurve red{{600.0, 700.0}, {1.0, 1.0}};
  const SpectralCurve blue{{430.0, 480.0}, {3.0, 3.0}};
  const Tristimulus r = tristimulus(red, functions());
  const Tristimulus b = tristimulus(blue, functions());
  const double share = (r[0] + r[1] + r[2]) / (r[0] + r[1] + r[2] + b[0] + b[1] + b[2]);
  const Chromaticity both = chromaticity({r[0] + b[0], r[1] + b[1], r[2] + b[2]});
  EXPECT_NEAR(both.x, std::lerp(chromaticity(b).x, chromaticity(r).x, share), 1e-12);
  EXPECT_NEAR(both.y, std::lerp(chromaticity(b).y, chromaticity(r).y, share), 1e-12);
}

// The colour matching function of y equals the luminous efficiency V, which is in another table.
TEST(ColourMatching, OfYIsTheLuminousEfficiency) {
  const SpectralCurve v = read_cie_table(kData + "cie_v_a_d65_5nm.csv").photopic_efficiency;
  const SpectralCurve y = functions()[1];
  EXPECT_EQ(y.wavelengths_nm, v.wavelengths_nm);
  EXPECT_EQ(y.values, v.values);
}

/// A Gaussian with different widths on both sides of its center. `below_per_nm` and `above_per_nm` are the reciprocal
/// widths.
struct Lobe {
  double height, middle_nm, below_per_nm, above_per_nm;
};

double at(const std::vector<Lobe>& lobes, double wavelength_nm) {
  double sum = 0.0;
  for (const Lobe& l : lobes) {
    const double d = wavelength_nm - l.middle_nm;
    const double t = d * (d < 0.0 ? l.below_per_nm : l.above_per_nm);
    sum += l.height * std::exp(-0.5 * t * t);
  }
  return sum;
}

// Compares the colour matching functions with published fits, which are sums of lobes and differ from the functions by
// at most 0.022 (C. Wyman, P.-P. Sloan and P. Shirley, JCGT 2 (2), 1 (2013)).
TEST(ColourMatching, AgreesWithAPublishedFit) {
  const std::array<std::vector<Lobe>, 3> fit = {{
      {{0.362, 442.0, 0.0624, 0.0374}, {1.056, 599.8, 0.0264, 0.0323}, {-0.065, 501.1, 0.0490, 0.0382}},
      {{0.821, 568.8, 0.0213, 0.0247}, {0.286, 530.9, 0.0613, 0.0322}},
      {{1.217, 437.0, 0.0845, 0.0278}, {0.681, 459.0, 0.0385, 0.0725}},
  }};
  const ColourMatching table = functions();
  for (std::size_t k = 0; k < table.size(); ++k)
    for (std::size_t w = 0; w < table[k].values.size(); ++w)
      EXPECT_NEAR(table[k].values[w], at(fit[k], table[k].wavelengths_nm[w]), 0.0225) << k << " " << w;
}

TEST(ColourMatching, MalformedTablesAreRefusedByTheirLine) {
  const std::string missing = refusal_of([] { read_colour_matching(kData + "dye_red.csv"); }, "accepted");
  EXPECT_EQ(missing, "data/dye_red.csv:4");
}

}  // namespace
}  // namespace retrace::materials::chromaticity_test
