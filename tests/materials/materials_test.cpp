#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

#include "core/error.h"
#include "materials/dispersion.h"
#include "materials/fresnel.h"
#include "materials/io/material_library.h"
#include "materials/metal.h"
#include "tests/support/refusals.h"

namespace retrace::materials::materials_test {
namespace {

MaterialLibrary shipped() {
  return MaterialLibrary::read(std::string(RETRACE_SOURCE_DIR) + "/data/materials.toml");
}

// Compares the indices at the d line with published values.
TEST(Dispersion, IndexAtTheDLine) {
  const MaterialLibrary library = shipped();
  const auto n = [&](const char* name) { return index_relative_to_air(library.find(name), library.air(), 587.56); };
  EXPECT_NEAR(n("PMMA"), 1.4925, 5e-5);
  EXPECT_NEAR(n("PMMA-Kasarova"), 1.4914, 5e-5);
  EXPECT_NEAR(n("PMMA-Sultanova"), 1.4906, 5e-5);
  EXPECT_NEAR(n("PC-Kasarova"), 1.5849, 5e-5);
  EXPECT_EQ(n("air"), 1.0);
  EXPECT_NEAR(n("MgF2"), 1.3777, 5e-5);
}

// The formula of the source gives n itself, not its square, in powers of the wavelength.
TEST(Dispersion, HafniumOxideOfAlKuhaili2004) {
  for (double w_um = 0.3; w_um <= 2.0; w_um += 0.1)
    EXPECT_NEAR(refractive_index(shipped().find("HfO2").dispersion, 1e3 * w_um),
                1.875 + 6.28e-3 / std::pow(w_um, 2.0) + 5.80e-4 / std::pow(w_um, 4.0), 1e-12);
}

double n_at(const char* name, double wavelength_nm) {
  const MaterialLibrary library = shipped();
  return index_relative_to_air(library.find(name), library.air(), wavelength_nm);
}

// Compares n_d and V_d = (n_d - 1) / (n_F - n_C) with the values that manufacturers or catalogues publish next to their
// coefficients.
TEST(Dispersion, IndexAndAbbeNumberAsPublished) {
  struct Case {
    const char* name;
    double n_d, half_digit, abbe, abbe_within;
  };
  for (const auto& [name, n_d, half_digit, abbe, abbe_within] :
       {Case{"N-BK7", 1.5168, 5e-6, 64.17, 5e-3},           // Schott
        Case{"fused-silica", 1.458464, 1e-6, 67.82, 5e-3},  // Zemax MISC; refractiveindex.info has 1.45846
        Case{"COC", 1.533732, 1e-6, 56.227932, 1e-4},       // Zemax MISC
        Case{"COC", 1.533202, 1e-3, 56.150461, 0.2},        // TOPAS catalogue, 5013LS-01
        Case{"PC", 1.58547, 1e-6, 29.909185, 1e-4},         // Zemax MISC
        Case{"PC", 1.585, 1e-3, 29.1, 1.0},                 // Sultanova 2009, measured to 1e-3
        Case{"PMMA", 1.491, 2e-3, 59.2, 0.5}}) {            // Sultanova 2009
    EXPECT_NEAR(n_at(name, 587.5618), n_d, half_digit) << name;
    EXPECT_NEAR((n_at(name, 587.5618) - 1.0) / (n_at(name, 486.1327) - n_at(name, 656.2725)), abbe, abbe_within)
        << name;
  }
}

// The indices were measured to 1e-3: Sultanova, Kasarova, Nikolov, Acta Physica Polonica A 116, 585 (2009), table of
// indices.
TEST(Dispersion, PolymersAsMeasured) {
  struct Row {
    double wavelength_nm, pmma, pc;
  };
  for (const auto& [wavelength_nm, pmma, pc] : {Row{436.8, 1.502, 1.612},
                                                {486.1, 1.497, 1.599},
                                                {587.6, 1.491, 1.585},
                                                {632.8, 1.489, 1.580},
                                                {703.0, 1.486, 1.575},
                                                {833.0, 1.484, 1.569},
                                                {879.0, 1.483, 1.568},
                                                {1052.0, 1.481, 1.565}}) {
    EXPECT_NEAR(n_at("PMMA-Kasarova", wavelength_nm), pmma, 1e-3) << wavelength_nm;
    EXPECT_NEAR(n_at("PC-Kasarova", wavelength_nm), pc, 1e-3) << wavelength_nm;
    EXPECT_NEAR(n_at("PC", wavelength_nm), pc, 2.7e-3) << wavelength_nm;
  }
}

// Schott's data sheet of N-BK7 gives dn/dT in 1e-6 per K, as means over 20 degrees, at 1060.0 nm and at the lines e and
// g. The values are relative to air and to vacuum.
TEST(Temperature, NBK7AsItsDataSheetHasIt) {
  const MaterialLibrary library = shipped();
  const Material& glass = library.find("N-BK7");
  const double lines_nm[] = {1060.0, 546.074, 435.8343};
  struct Row {
    double from_c, to_c;
    std::array<double, 3> in_air, in_vacuum;
  };
  for (const auto& [from_c, to_c, in_air, in_vacuum] :
       {Row{-40.0, -20.0, {2.4, 2.9, 3.3}, {0.3, 0.8, 1.2}}, Row{20.0, 40.0, {2.4, 3.0, 3.5}, {1.1, 1.6, 2.1}},
        Row{60.0, 80.0, {2.5, 3.1, 3.7}, {1.5, 2.1, 2.7}}})
    for (std::size_t k = 0; k < 3; ++k) {
      const auto n = [&](double c) { return index_relative_to_air(glass, library.air(), lines_nm[k], c); };
      const auto air = [&, w = lines_nm[k]](double c) {  // index of air; thermal expansion by Kohlrausch
        return 1.0 + (refractive_index(library.air().dispersion, w) - 1.0) / (1.0 + 3.4785e-3 * (c - 15.0));
      };
      const double per_k = 1e6 / (to_c - from_c);
      EXPECT_NEAR(per_k * (n(to_c) - n(from_c)), in_air[k], 0.06) << from_c << ' ' << lines_nm[k];
      EXPECT_NEAR(per_k * (n(to_c) * air(to_c) - n(from_c) * air(from_c)), in_vacuum[k], 0.06)
          << from_c << ' ' << lines_nm[k];
    }
}

// Osaka Gas Chemicals publishes dn/dT of PMMA and polycarbonate in 1e-5 per K, measured with an Abbe refractometer.
TEST(Temperature, PolymersAsTabled) {
  const MaterialLibrary library = shipped();
  for (const auto& [name, per_k] : {std::pair("PMMA", -10e-5), {"PC", -12e-5}}) {
    const auto n = [&, material = library.find(name)](double c) {
      return index_relative_to_air(material, library.air(), 589.3, c);
    };
    EXPECT_NEAR((n(30.0) - n(20.0)) / 10.0, per_k, 1.5e-5) << name;
  }
}

// Compares the formula, including every coefficient, with an independent calculation for n = 1.5. The test replaces the
// air by vacuum.
TEST(Temperature, IsTheClosedForm) {
  Material m;
  m.name = "m";
  m.dispersion = ConstantIndex{1.5};
  m.temperature_c = 25.0;
  m.thermo_optic = ThermoOptic{.d0_per_k = 1e-5,
                               .d1_per_k2 = 2e-8,
                               .d2_per_k3 = -3e-10,
                               .e0_um2_per_k = 4e-7,
                               .e1_um2_per_k2 = 5e-10,
                               .resonance_um = 0.2,
                               .source = "made up"};
  Material air;
  air.dispersion = ConstantIndex{1.0};
  const double t = 40.0;
  const double expected =
      1.5 + (2.25 - 1.0) / 3.0 * (1e-5 * t + 2e-8 * t * t - 3e-10 * t * t * t + (4e-7 * t + 5e-10 * t * t) / 0.32);
  EXPECT_NEAR(index_relative_to_air(m, air, 600.0, 65.0), expected, 1e-15);
  EXPECT_EQ(index_relative_to_air(m, air, 600.0, 25.0), 1.5);
  // Warmer air has a lower density, so that the index of the body relative to air is larger. (n - 1) T / p is constant.
  // The index 1.0003 at 0 degrees C therefore becomes 1 + 0.0003 / 1.367 at 100 degrees C.
  air.dispersion = ConstantIndex{1.0003};
  air.temperature_c = 0.0;
  m.temperature_c = 0.0;
  m.thermo_optic = ThermoOptic{};
  EXPECT_NEAR(index_relative_to_air(m, air, 600.0, 100.0), 1.5 * 1.0003 / (1.0 + 0.0003 / 1.367), 1e-15);
  m.thermo_optic.reset();
  EXPECT_EQ(index_relative_to_air(m, air, 600.0, 0.0), 1.5);
  EXPECT_THROW(static_cast<void>(index_relative_to_air(m, air, 600.0, 1.0)), InputError);
}

// The internal transmittance of 10 mm follows from the extinction coefficients of the source: exp(-4 pi k 10 mm / w).
TEST(Absorption, OfNBK7IsThatOfItsExtinction) {
  const Material glass = shipped().find("N-BK7");
  for (const auto& [wavelength_nm, k] :
       {std::pair(350.0, 9.2894e-8), {400.0, 1.0227e-8}, {546.0, 6.9658e-9}, {1060.0, 1.0137e-8}})
    EXPECT_NEAR(std::exp(-10.0 * absorption_per_mm(glass, wavelength_nm)),
                std::exp(-4.0 * std::numbers::pi * k * 10.0 / (1e-6 * wavelength_nm)), 1e-5)
        << wavelength_nm;
  EXPECT_NEAR(absorption_per_mm(glass, 410.0), 0.000281, 1e-9) << "linear between";
  EXPECT_EQ(absorption_per_mm(glass, 200.0), 0.1198) << "beyond as at the end";
  EXPECT_EQ(absorption_per_mm(shipped().find("PMMA"), 550.0), 0.0);
}

// Edlen's older formula (1953) for standard air agrees with Ciddor's formula to a few 1e-8.
TEST(Dispersion, AirAgreesWithEdlen) {
  for (double w_um = 0.4; w_um <= 0.8; w_um += 0.05) {
    const double s2 = 1.0 / (w_um * w_um);
    const double edlen = 1.0 + 1e-8 * (6432.8 + 2949810.0 / (146.0 - s2) + 25540.0 / (41.0 - s2));
    EXPECT_NEAR(refractive_index(shipped().air().dispersion, 1e3 * w_um), edlen, 5e-8);
  }
}

TEST(Dispersion, IsNormalInTheVisible) {
  const MaterialLibrary library = shipped();
  for (const Material& m : library.all())
    for (double w_nm = std::max(m.valid_from_nm, 380.0); w_nm <= 770.0; w_nm += 10.0)
      EXPECT_GT(refractive_index(m.dispersion, w_nm), refractive_index(m.dispersion, w_nm + 10.0)) << m.name << w_nm;
}

TEST(Dispersion, NoRealIndexIsAnError) {
  EXPECT_THROW(refractive_index(Sellmeier{{{1.0, 1.0}}}, 999.0), InputError);
}

// Compares the index with rows of the table of refractiveindex.info (public domain, CC0), which was computed from the
// paper of Rakic et al. (1998).
TEST(Metal, SilverOfRakic1998) {
  const LorentzDrude model = shipped().find_metal("silver").model;
  for (const auto& [wavelength_nm, n, k] : {std::array{397.46, 0.16007, 1.7990}, std::array{503.21, 0.13208, 2.7927},
                                            std::array{588.91, 0.13804, 3.4755}, std::array{702.89, 0.15482, 4.3257}}) {
    const std::complex<double> index = complex_index(model, wavelength_nm);
    EXPECT_NEAR(index.real(), n, 2e-4 * n) << wavelength_nm;
    EXPECT_NEAR(index.imag(), k, 2e-4 * k) << wavelength_nm;
  }
}

TEST(FresnelMetal, NormalIncidenceAndLimits) {
  const std::complex<double> metal(1.13, 6.85);
  const FresnelCoefficients normal = fresnel_metal(1.49 / metal, 1.0);
  EXPECT_NEAR(std::norm(normal.r_s), std::norm((1.49 - metal) / (1.49 + metal)), 1e-15);
  EXPECT_NEAR(std::abs(normal.r_s + normal.r_p), 0.0, 1e-15);
  for (double c = 0.0; c <= 1.0; c += 0.05) {
    const FresnelCoefficients f = fresnel_metal(1.49 / metal, c);
    EXPECT_LE(std::norm(f.r_s), 1.0);
    EXPECT_LE(std::norm(f.r_p), std::norm(f.r_s) + 1e-15);
    // Without absorption, the formulas of metals give the results of glass, including the phases of total reflection.
    for (const double ratio : {0.7, 1.49}) {
      const FresnelCoefficients glass = fresnel(ratio, c);
      const FresnelCoefficients limit = fresnel_metal(ratio / std::complex<double>(1.0, 1e-12), c);
      EXPECT_NEAR(std::abs(limit.r_s - glass.r_s), 0.0, 1e-5) << ratio << ' ' << c;
      EXPECT_NEAR(std::abs(limit.r_p - glass.r_p), 0.0, 1e-5) << ratio << ' ' << c;
    }
  }
}

TEST(MaterialLibrary, UnknownNameListsWhatThereIs) {
  try {
    shipped().find("glass", {"d.toml", 7, "body.material"});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(recorded_place_of(error), "d.toml:7: body.material");
  }
}

TEST(MaterialLibrary, BadFilesAreRefusedWithTheirLine) {
  const auto read = [](const std::string& text) {
    const auto path = std::filesystem::temp_directory_path() / "retrace_bad_materials.toml";
    std::ofstream(path) << text;
    std::string message;
    try {
      MaterialLibrary::read(path);
    } catch (const InputError& error) {
      message = recorded_place_of(error);
    }
    std::filesystem::remove(path);
    return message;
  };
  EXPECT_EQ(read("[[material]]\nname = 3\n"), "TMP:2: material[1].name");
  EXPECT_EQ(read("[[material]]\nname = \"x\"\ndescription = \"y\"\nformula = \"z\"\n"), "TMP:4: material[1].formula");
  const std::string good =
      "[[material]]\nname = \"x\"\ndescription = \"y\"\nformula = \"constant\"\ncoefficients = [1.5]\n"
      "valid_nm = [400, 700]\nsource = \"z\"\n";
  expect_refusals(read,
                  {{good, ""},
                   {good + "temperature_c = 25\nthermo_optic = [1, 0, 0, 0, 0, 0]\nthermo_optic_source = \"s\"\n", ""},
                   {good + "temperature_c = \"warm\"\n", "TMP:8: material[1].temperature_c"},
                   {good + "thermo_optic = [1, 2]\nthermo_optic_source = \"s\"\n", "TMP:8: material[1].thermo_optic"},
                   {good + "thermo_optic = [1, 0, 0, 0, 0, 0]\n", "TMP:1: material[1].thermo_optic_source"},
                   {good + "thermo_optic_source = \"s\"\n", "TMP:8: material[1].thermo_optic_source"},
                   {good + "absorption_per_mm = [[400, 0.1], [390, 0.2]]\n", "TMP:8: material[1].absorption_per_mm"},
                   {good + "absorption_per_mm = [[400, 0.1]]\n", "TMP:8: material[1].absorption_per_mm"},
                   {good + "absorption_per_mm = -1\n", "TMP:8: material[1].absorption_per_mm"},
                   {"material = 1\n", "TMP:1: material"},
                   {"[\n", "TMP:1"}});
}

TEST(Fresnel, PowerIsConserved) {
  for (const double ratio : {1.0 / 1.4917, 1.4917, 1.0, 2.0, 0.5})
    for (double c = 0.0; c <= 1.0; c += 1.0 / 64.0) {
      const FresnelCoefficients f = fresnel(ratio, c);
      EXPECT_NEAR(std::norm(f.r_s) + std::norm(f.t_s), 1.0, 1e-14);
      EXPECT_NEAR(std::norm(f.r_p) + std::norm(f.t_p), 1.0, 1e-14);
      EXPECT_EQ(f.total_reflection, c == 0.0 || ratio * ratio * (1.0 - c * c) >= 1.0);
    }
}

TEST(Fresnel, NormalIncidenceAndBrewster) {
  const double n = 1.4917;
  EXPECT_NEAR(reflectance(1.0 / n, 1.0), std::pow((n - 1.0) / (n + 1.0), 2.0), 1e-15);
  EXPECT_NEAR(reflectance(n, 1.0), std::pow((n - 1.0) / (n + 1.0), 2.0), 1e-15);
  EXPECT_NEAR(std::abs(fresnel(1.0 / n, std::cos(std::atan(n))).r_p), 0.0, 1e-14);
  EXPECT_NEAR(std::abs(fresnel(1.0 / n, 1.0).r_s + fresnel(1.0 / n, 1.0).r_p), 0.0, 1e-15);
}

// Stokes' relations: for a ray and the reversed ray, the amplitudes of reflection have opposite signs, and the
// transmittance is the same.
TEST(Fresnel, Reversible) {
  const double n = 1.585;
  for (double c = 0.05; c <= 1.0; c += 0.05) {
    const FresnelCoefficients in = fresnel(1.0 / n, c);
    const FresnelCoefficients out = fresnel(n, in.cos_refracted);
    EXPECT_NEAR(std::abs(in.r_s + out.r_s), 0.0, 1e-14);
    EXPECT_NEAR(std::abs(in.r_p + out.r_p), 0.0, 1e-14);
    EXPECT_NEAR(std::abs(in.t_s - out.t_s), 0.0, 1e-14);
    EXPECT_NEAR(out.cos_refracted, c, 1e-14);
  }
}

// The phase d between p and s at total reflection is given by tan(d/2) = cos t sqrt(sin^2 t - 1/n^2) / sin^2 t (Born
// and Wolf, 1.5.4).
TEST(Fresnel, PhaseOfTotalReflection) {
  const double n = 1.4917;
  for (double t = 0.75; t < 1.5; t += 0.05) {
    const FresnelCoefficients f = fresnel(n, std::cos(t));
    ASSERT_TRUE(f.total_reflection);
    // In this basis, r_p = -r_s at normal incidence. The phase is relative to this value.
    const double phase = std::arg(-f.r_p / f.r_s);
    const double s2 = std::sin(t) * std::sin(t);
    const double expected = 2.0 * std::atan(std::cos(t) * std::sqrt(s2 - 1.0 / (n * n)) / s2);
    EXPECT_NEAR(std::abs(std::remainder(std::abs(phase) - (std::numbers::pi - expected), 2.0 * std::numbers::pi)), 0.0,
                1e-12);
  }
}

}  // namespace
}  // namespace retrace::materials::materials_test
