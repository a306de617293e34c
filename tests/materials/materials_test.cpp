#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

#include "core/error.h"
#include "materials/dispersion.h"
#include "materials/fresnel.h"
#include "materials/io/material_library.h"
#include "materials/metal.h"

namespace retrace::materials::materials_test {
namespace {

MaterialLibrary shipped() {
  return MaterialLibrary::read(std::string(RETRACE_SOURCE_DIR) + "/data/materials.toml");
}

// Published indices at the d line.
TEST(Dispersion, IndexAtTheDLine) {
  const MaterialLibrary library = shipped();
  const auto n = [&](const char* name) { return index_relative_to_air(library.find(name), library.air(), 587.56); };
  EXPECT_NEAR(n("PMMA"), 1.4925, 5e-5);
  EXPECT_NEAR(n("PMMA-Kasarova"), 1.4914, 5e-5);
  EXPECT_NEAR(n("PMMA-Sultanova"), 1.4906, 5e-5);
  EXPECT_NEAR(n("PC"), 1.585, 1e-12);
  EXPECT_EQ(n("air"), 1.0);
}

// Edlen 1953, the older formula for standard air, agrees with Ciddor's to a few 1e-8.
TEST(Dispersion, AirAgreesWithEdlen) {
  for (double w_um = 0.4; w_um <= 0.8; w_um += 0.05) {
    const double s2 = 1.0 / (w_um * w_um);
    const double edlen = 1.0 + 1e-8 * (6432.8 + 2949810.0 / (146.0 - s2) + 25540.0 / (41.0 - s2));
    EXPECT_NEAR(refractive_index(shipped().air().dispersion, 1e3 * w_um), edlen, 5e-8);
  }
}

TEST(Dispersion, IsNormalInTheVisible) {
  const MaterialLibrary library = shipped();
  for (const char* name : {"PMMA", "PMMA-Kasarova", "PMMA-Sultanova"})
    EXPECT_GT(refractive_index(library.find(name).dispersion, 486.1),
              refractive_index(library.find(name).dispersion, 656.3));
}

TEST(Dispersion, NoRealIndexIsAnError) {
  EXPECT_THROW(refractive_index(Sellmeier{{{1.0, 1.0}}}, 999.0), InputError);
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
    // Without absorption it is glass; phases of total reflection included.
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
    EXPECT_STREQ(error.what(),
                 "d.toml:7: body.material: no material of that name, got \"glass\"; there are PMMA, PMMA-Kasarova, "
                 "PMMA-Sultanova, PC, air");
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
      message = error.what();
    }
    std::filesystem::remove(path);
    return message;
  };
  EXPECT_NE(read("[[material]]\nname = 3\n").find(":2: material[1].name: must be a string, got 3"), std::string::npos);
  EXPECT_NE(read("[[material]]\nname = \"x\"\ndescription = \"y\"\nformula = \"z\"\n").find(":4: material[1].formula"),
            std::string::npos);
  EXPECT_NE(read("material = 1\n").find("material: must be tables, got 1"), std::string::npos);
  EXPECT_NE(read("[\n").find(":1: "), std::string::npos);
}

TEST(Fresnel, PowerIsConserved) {
  for (const double ratio : {1.0 / 1.4917, 1.4917, 1.0, 2.0, 0.5})
    for (double c = 0.0; c <= 1.0; c += 1.0 / 64.0) {
      const FresnelCoefficients f = fresnel(ratio, c);
      EXPECT_NEAR(std::norm(f.r_s) + f.t_s * f.t_s, 1.0, 1e-14);
      EXPECT_NEAR(std::norm(f.r_p) + f.t_p * f.t_p, 1.0, 1e-14);
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

// Stokes' relations: a ray and its reverse see opposite amplitudes of reflection and the same transmission.
TEST(Fresnel, Reversible) {
  const double n = 1.585;
  for (double c = 0.05; c <= 1.0; c += 0.05) {
    const FresnelCoefficients in = fresnel(1.0 / n, c);
    const FresnelCoefficients out = fresnel(n, in.cos_refracted);
    EXPECT_NEAR(std::abs(in.r_s + out.r_s), 0.0, 1e-14);
    EXPECT_NEAR(std::abs(in.r_p + out.r_p), 0.0, 1e-14);
    EXPECT_NEAR(in.t_s, out.t_s, 1e-14);
    EXPECT_NEAR(out.cos_refracted, c, 1e-14);
  }
}

// Phase between p and s at total reflection: tan(d/2) = cos t sqrt(sin^2 t - 1/n^2) / sin^2 t (Born and Wolf, 1.5.4).
TEST(Fresnel, PhaseOfTotalReflection) {
  const double n = 1.4917;
  for (double t = 0.75; t < 1.5; t += 0.05) {
    const FresnelCoefficients f = fresnel(n, std::cos(t));
    ASSERT_TRUE(f.total_reflection);
    // r_p = -r_s at normal incidence in this basis: the phase is counted from there.
    const double phase = std::arg(-f.r_p / f.r_s);
    const double s2 = std::sin(t) * std::sin(t);
    const double expected = 2.0 * std::atan(std::cos(t) * std::sqrt(s2 - 1.0 / (n * n)) / s2);
    EXPECT_NEAR(std::abs(std::remainder(std::abs(phase) - (std::numbers::pi - expected), 2.0 * std::numbers::pi)), 0.0,
                1e-12);
  }
}

}  // namespace
}  // namespace retrace::materials::materials_test
