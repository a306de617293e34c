// Tests of the colour of returned light: closed forms; sums over the table of the CIE for dyes, dispersion and
// diffraction; and errors.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "materials/io/spectrum_reader.h"
#include "studies/photometry/io/photometry_files.h"
#include "studies/photometry/photometer.h"
#include "tests/studies/photometric_requests.h"
#include "tests/support/refusals.h"

namespace retrace::studies::photometric_colour_test {
namespace {

using namespace photometric_requests;
using namespace testing;

const std::string kData = RETRACE_SOURCE_DIR "/data/";

/// Returns a request for the colour in the light of an illuminant.
PhotometrySettings colour_request(PhotometricLight light = PhotometricLight::illuminant_a,
                                  double observation_deg = 0.05) {
  PhotometrySettings request = request_of(points_at({observation_deg}, 1.0));
  request.light = light;
  request.colour = true;
  return request;
}

materials::Chromaticity colour_of(const design::Design& design, const PhotometrySettings& request) {
  return run(design, request).colour.value().chromaticity.value();
}

ColourBoundary at_most(double of_x, double of_y, double most) {
  ColourBoundary boundary;
  boundary.status = LimitStatus::read;
  boundary.observation_deg = 0.05;
  boundary.x_coefficient = of_x;
  boundary.y_coefficient = of_y;
  boundary.limit = most;
  return boundary;
}

/// Returns a design whose RRE is the same at all wavelengths: mirrors behind a lossless entrance face, with a constant
/// index.
design::Design colourless(double base_mm = 0.5) {
  return design_of(infinite(geometry::RtpElement{base_mm, base_mm, 90.0}, geometry::Arrangement::aligned, 2.0), true);
}

// A part that treats all wavelengths equally returns the colour of the lamp.
TEST(PhotometricColour, OfAColourlessPartIsThatOfTheLamp) {
  const materials::Chromaticity a = colour_of(colourless(), colour_request());
  EXPECT_NEAR(a.x, 0.44757, 2e-5);
  EXPECT_NEAR(a.y, 0.40745, 2e-5);
  const materials::Chromaticity d65 = colour_of(colourless(), colour_request(PhotometricLight::illuminant_d65));
  EXPECT_NEAR(d65.x, 0.31271, 2e-5);
  EXPECT_NEAR(d65.y, 0.32902, 2e-5);
}

// The transmittance of a dye is exp(-a L) with L = 2 (plate + depth). The expected colour is a sum over the table of
// the CIE.
TEST(PhotometricColour, OfADyedPartIsTheSumOverTheTable) {
  const double way_mm = 2.0 * 2.25;
  const materials::CieTable cie = materials::read_cie_table(kData + "cie_v_a_d65_5nm.csv");
  for (const std::string name : {"red", "amber"}) {
    const materials::SpectralCurve dye = materials::read_spectral_absorption(kData + "dye_" + name + ".csv");
    materials::SpectralCurve back = cie.illuminant_a;
    for (std::size_t k = 0; k < back.values.size(); ++k)
      back.values[k] *= std::exp(-way_mm * dye.at(back.wavelengths_nm[k]));
    const materials::Chromaticity expected = materials::chromaticity(
        materials::tristimulus(back, materials::read_colour_matching(kData + "cie_xyz_1931_5nm.csv")));
    PhotometrySettings request = colour_request();
    request.dye_absorption_per_mm = dye;
    const materials::Chromaticity found = colour_of(colourless(), request);
    EXPECT_NEAR(found.x, expected.x, 1e-5) << name;
    EXPECT_NEAR(found.y, expected.y, 1e-5) << name;
    EXPECT_NEAR(found.z(), expected.z(), 1e-5) << name;
    // The key `absorption_per_mm` of the design gives the same result as the absorption of the dye in the request.
    design::Design coloured = colourless();
    std::vector<design::SpectralAbsorption> own;
    for (std::size_t k = 0; k < dye.values.size(); ++k) own.push_back({dye.wavelengths_nm[k], dye.values[k]});
    coloured.substance.absorption_per_mm = own;
    const materials::Chromaticity again = colour_of(coloured, colour_request());
    EXPECT_NEAR(again.x, found.x, 1e-12) << name;
    EXPECT_NEAR(again.y, found.y, 1e-12) << name;
  }
}

// The part has the dispersion of PMMA, Fresnel reflection, and diffraction of cells of half a millimetre. The reference
// is a set of runs with one wavelength every 10 nm.
TEST(PhotometricColour, WithDispersionAndDiffractionIsThatOfItsSpectrum) {
  design::Design design = design_of(honeycomb(0.75, 0.5));
  design.substance.refractive_index.reset();
  design.substance.material = "PMMA";
  PhotometrySettings request = colour_request(PhotometricLight::illuminant_a, 1.0 / 3.0);
  request.diffraction = true;
  request.engine = raytrace::Engine::exact;  // without the noise of resampled weak beams
  const materials::Chromaticity found = colour_of(design, request);
  const materials::ColourMatching functions = materials::read_colour_matching(kData + "cie_xyz_1931_5nm.csv");
  materials::SpectralCurve back = materials::read_cie_table(kData + "cie_v_a_d65_5nm.csv").illuminant_a;
  request.light = PhotometricLight::of_design;
  materials::SpectralCurve r_a;
  for (double w = 380.0; w <= 780.0; w += 10.0) {
    design.light.colour = w;
    r_a.wavelengths_nm.push_back(w);
    const Photometer photometer(design, request, 1);
    r_a.values.push_back(photometer.measure({{0.0, 0.0, 0.0, {1.0 / 3.0}, 0, false}}, nullptr, nullptr)->at(0).r_a[0]);
  }
  for (std::size_t k = 0; k < back.values.size(); ++k) back.values[k] *= r_a.at(back.wavelengths_nm[k]);
  const materials::Chromaticity expected = materials::chromaticity(materials::tristimulus(back, functions));
  EXPECT_NEAR(found.x, expected.x, 2e-4);
  EXPECT_NEAR(found.y, expected.y, 2e-4);
  const bool is_colourless = std::hypot(expected.x - 0.44757, expected.y - 0.40745) < 1e-3;
  EXPECT_FALSE(is_colourless) << "diffraction colours what it sends aside";
}

// Diffraction colours the light of cube corners differently in each rotation. The colour with the smallest margin to a
// boundary is reported, whatever the order of the rotations.
TEST(PhotometricColour, IsTheWorstOfAllRotations) {
  design::Design design = design_of(honeycomb(0.75, 0.5));
  PhotometrySettings request = colour_request(PhotometricLight::illuminant_a, 1.0 / 3.0);
  request.diffraction = true;
  request.engine = raytrace::Engine::exact;
  request.test_plan.boundaries = {at_most(1.0, 0.0, 0.6)};
  request.test_plan.boundaries[0].observation_deg = 1.0 / 3.0;
  const auto margin = [&](const std::vector<double>& rotation_deg) {
    request.rotation_deg = rotation_deg;
    return run(design, request).colour.value().boundaries.at(0).margin;
  };
  const double one = margin({0.0}), other = margin({20.0});
  EXPECT_GT(std::abs(one - other), 1e-4);
  EXPECT_NEAR(margin({0.0, 20.0}), std::min(one, other), 1e-9);
  EXPECT_NEAR(margin({20.0, 0.0}), std::min(one, other), 1e-9);
}

// Total reflection in prisms of N-BK7 ends at an angle of incidence that depends on the wavelength, from 5.6 to 6
// degrees. At such angles, readings agree with those of a spectrum that has a line every 2 nm.
TEST(PhotometricColour, IsExactWhereTotalReflectionEnds) {
  const materials::SpectralCurve lamp = lamp_power(PhotometricLight::illuminant_a);
  const materials::ColourMatching functions = materials::shipped_colour_matching();
  design::Design design =
      design_of(infinite(geometry::RtpElement{3.0, 3.0, 90.0}, geometry::Arrangement::aligned, 2.0));
  design.substance.refractive_index.reset();
  design.substance.material = "N-BK7";
  const PhotometrySettings request = colour_request();
  for (const double h_deg : {5.7, 5.9}) {
    const auto r_a = [&](const design::Design& lit, PhotometricLight light, std::size_t response) {
      PhotometrySettings of_light = request;
      of_light.engine = raytrace::Engine::exact;
      of_light.light = light;
      return Photometer(lit, of_light, 4, static_cast<PhotometricResponse>(response))
          .measure({{0.0, h_deg, 0.0, {0.05}, 0, false}}, nullptr, nullptr)
          ->front()
          .r_a[0];
    };
    materials::Tristimulus found{}, expected{};
    for (std::size_t k = 0; k < 3; ++k) {
      design::LightSpectrum lines;
      lines.kind = design::LightSpectrum::Kind::lines;
      lines.photopic = false;
      double sent = 0.0;
      for (double w = 400.0; w <= 720.0; w += 2.0) {
        lines.lines.push_back({w, lamp.at(w) * functions[k].at(w)});
        sent += lines.lines.back().power;
      }
      design::Design of_lines = design;
      of_lines.light.colour = lines;
      expected[k] = sent * r_a(of_lines, PhotometricLight::of_design, k);
      found[k] = sent * r_a(design, PhotometricLight::illuminant_a, k);
      EXPECT_NEAR(found[k], expected[k], 3e-4 * expected[k]) << k << " at " << h_deg;
    }
    EXPECT_NEAR(materials::chromaticity(found).x, materials::chromaticity(expected).x, 1e-4) << h_deg;
    EXPECT_NEAR(materials::chromaticity(found).y, materials::chromaticity(expected).y, 1e-4) << h_deg;
  }
}

TEST(PhotometricColour, HasTheErrorOfItsRays) {
  PhotometrySettings request = colour_request();
  request.dye_absorption_per_mm = materials::read_spectral_absorption(kData + "dye_amber.csv");
  const design::Design design = design_of(honeycomb(0.0, 20.0));
  const materials::Chromaticity exact = colour_of(design, request);
  request.engine = raytrace::Engine::montecarlo;
  request.rays = 1U << 14;
  double chi_squared = 0.0;
  constexpr int kSeeds = 12;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    request.seed = static_cast<std::uint32_t>(seed);
    const PhotometricColour colour = run(design, request).colour.value();
    ASSERT_GT(colour.std_error.x, 0.0);
    ASSERT_GT(colour.std_error.y, 0.0);
    chi_squared += std::pow((colour.chromaticity->x - exact.x) / colour.std_error.x, 2.0);
    chi_squared += std::pow((colour.chromaticity->y - exact.y) / colour.std_error.y, 2.0);
  }
  // x and y are correlated, so that the sum has 12 to 24 degrees of freedom. 51 is the 99.9 % quantile for 24 degrees
  // of freedom.
  EXPECT_LT(chi_squared, 51.0);
}

TEST(PhotometricColour, VerdictIsThatOfTheBoundaries) {
  const design::Design wide = colourless(20.0);  // traced by rays; diffraction is negligible
  PhotometrySettings request = colour_request();
  const auto verdict = [&](std::vector<ColourBoundary> boundaries) {
    request.test_plan.boundaries = std::move(boundaries);
    return run(wide, request).colour.value().verdict();
  };
  EXPECT_EQ(verdict({}), std::nullopt);
  EXPECT_EQ(verdict({at_most(1.0, 0.0, 0.448)}), Verdict::pass);
  EXPECT_EQ(verdict({at_most(1.0, 0.0, 0.448), at_most(0.0, 1.0, 0.407)}), Verdict::fail);
  ColourBoundary recalled = at_most(1.0, 0.0, 0.448);
  recalled.status = LimitStatus::recalled;
  EXPECT_EQ(verdict({recalled}), Verdict::unconfirmed);
  EXPECT_EQ(run(wide, request).verdict, Verdict::pass) << "that of the points is another";
  request.light = PhotometricLight::illuminant_d65;
  EXPECT_EQ(verdict({at_most(1.0, 0.0, 0.448)}), Verdict::undetermined);
  EXPECT_EQ(run(wide, request).colour.value().reason.cause, UndeterminedReason::Cause::another_light);
}

TEST(PhotometricColour, NearABoundaryOrWithoutDiffractionIsUndetermined) {
  PhotometricColour colour;
  colour.chromaticity = {0.4, 0.4};
  colour.boundaries = {{at_most(1.0, 0.0, 0.41), 0.01, 0.004}};
  EXPECT_EQ(colour.verdict(), Verdict::pass);
  colour.boundaries[0].std_error = 0.006;
  EXPECT_EQ(colour.verdict(), Verdict::undetermined);
  colour.boundaries[0].margin = -0.02;
  EXPECT_EQ(colour.verdict(), Verdict::fail);
  colour.lacks_diffraction = true;
  EXPECT_EQ(colour.verdict(), Verdict::undetermined);
  // Cells of half a millimetre are traced by rays, without diffraction.
  PhotometrySettings request = colour_request();
  request.test_plan.boundaries = {at_most(1.0, 0.0, 0.9)};
  request.engine = raytrace::Engine::montecarlo;
  request.rays = 1U << 10;
  const PhotometryResult result = run(design_of(honeycomb(0.0, 0.5)), request);
  EXPECT_EQ(result.colour->verdict(), Verdict::undetermined);
  EXPECT_EQ(result.colour->reason.cause, UndeterminedReason::Cause::diffraction);
  EXPECT_EQ(result.colour->reason.no_diffraction, NoDiffraction(Undiffracted::not_requested));
  record_message(result.colour->reason.text);
  EXPECT_NE(photometry_table(result).find(result.colour->reason.text), std::string::npos);
}

// Perfect cube corners return no light at an observation angle of 1 degree.
TEST(PhotometricColour, OfNoLightIsUndetermined) {
  PhotometrySettings request = colour_request(PhotometricLight::illuminant_a, 1.0);
  request.test_plan.boundaries = {at_most(1.0, 0.0, 0.9)};
  request.test_plan.boundaries[0].observation_deg = 1.0;
  const PhotometryResult result = run(design_of(honeycomb(0.0, 20.0), true), request);
  EXPECT_FALSE(result.colour->chromaticity);
  EXPECT_EQ(result.colour->verdict(), Verdict::undetermined);
  EXPECT_EQ(result.colour->reason.cause, UndeterminedReason::Cause::no_light);
  record_message(result.colour->reason.text);
  EXPECT_EQ(photometry_json(result).find("\"x\""), std::string::npos);
}

// If the entrance face returns a mirror image of the lamp, the colour is measured at V = 5 and V = -5 instead of V = 0.
// The worse value counts.
TEST(PhotometricColour, IsMeasuredBesideTheMirrorImage) {
  PhotometrySettings request = colour_request();
  request.test_plan.boundaries = {at_most(1.0, 0.0, 0.448)};
  request.test_plan.boundaries[0].substitute_v_deg = {5.0, -5.0};
  EXPECT_EQ(run(colourless(), request).colour->v_deg, 0.0);
  EXPECT_EQ(std::abs(run(design_of(honeycomb()), request).colour->v_deg), 5.0);
}

// The reported colour is that of the geometry with the smallest margin to any boundary. The margin to the boundary -x
// <= 5 is large in all geometries. If this is the only boundary, it selects the geometry with the smaller x. If there
// is also a boundary nearer to the colours, it has no effect.
TEST(PhotometricColour, SmallestMarginDeterminesTheGeometry) {
  PhotometrySettings request = colour_request();
  const auto v_deg = [&](std::vector<ColourBoundary> boundaries) {
    request.test_plan.boundaries = std::move(boundaries);
    request.test_plan.boundaries[0].substitute_v_deg = {5.0, 20.0};
    return run(design_of(honeycomb()), request).colour->v_deg;
  };
  const double of_larger_x = v_deg({at_most(1.0, 0.0, 0.448)});
  EXPECT_NE(v_deg({at_most(-1.0, 0.0, 5.0)}), of_larger_x);
  EXPECT_EQ(v_deg({at_most(1.0, 0.0, 0.448), at_most(-1.0, 0.0, 5.0)}), of_larger_x);
}

}  // namespace
}  // namespace retrace::studies::photometric_colour_test
