// Tests of diffraction by facets with a form, a smooth deviation from the plane: comparison with a pixel model of a
// cube corner, Fresnel integrals, tilted facets, and rays.
#include "raytrace/observers/formed_aperture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>

#include "core/error.h"
#include "raytrace/observers/far_field.h"
#include "raytrace/paths/monte_carlo.h"
#include "tests/support/closed_forms.h"
#include "tests/support/designs.h"
#include "tests/support/pixel_cube.h"
#include "tests/support/return_frames.h"
#include "tests/support/traced_far_fields.h"

namespace retrace::testing::formed_aperture_test {
namespace {

using namespace geometry;
using namespace raytrace;
using surface_models::FacetForm;
using Complex = std::complex<double>;

constexpr double kWave = 1e-6 * kPixelCubeWaveNm;

Vec3 tilted(const Vec2& q) {
  return {q.x(), q.y(), std::sqrt(1.0 - q.squaredNorm())};
}

FarField field_of(const PartSpec& spec, Optics optics, const FacetForm& form, const Illumination& light = {},
                  FarFieldPolicy policy = {}) {
  const Part part = build_part(spec);
  optics.facet_form = form;
  policy.wavelength_nm = kPixelCubeWaveNm;
  if (!form.is_plane()) policy.form = &form;
  return far_field_of_cells(part, optics, light, policy);
}

FacetForm paraboloid(double depth_mm, double radius_mm) {
  FacetForm form;
  form.add(2, 0, depth_mm / (radius_mm * radius_mm));
  form.add(0, 2, depth_mm / (radius_mm * radius_mm));
  return form;
}

// Compares the far field of a cube corner with a pixel model for two form errors of the facets: a paraboloid (sink
// mark), and a form without symmetry, which reveals errors of positions, signs and axes.
TEST(FormedAperture, CubeCornerAgreesWithAPixelModel) {
  constexpr double kAperture = 0.5;
  const double radius = 0.5 * kAperture / std::sqrt(4.0 / 3.0);  // half the diagonal of a square facet
  FacetForm skewed;
  skewed.add(1, 0, 2e-4);
  skewed.add(1, 1, -8e-5 / std::pow(radius, 2.0));
  skewed.add(0, 3, 1e-4 / std::pow(radius, 3.0));
  skewed.add(2, 1, 6e-5 / std::pow(radius, 3.0));
  for (const bool mirrors : {true, false})
    for (const FacetForm& form : {paraboloid(1e-4, radius), skewed}) {
      Optics optics = pmma();
      optics.mirror_facets = mirrors;
      optics.lossless_entrance = true;
      const FarField field = field_of(single(HexagonalCube{kAperture}, 0.3), optics, form);
      const PixelCube cube({.aperture_mm = kAperture,
                            .wavelength_mm = kWave,
                            .mirrors = mirrors,
                            .height = [&](double level, double down) {
                              return form.height_mm({level, down});
                            }});
      const double peak = cube.area_mm2() / (kWave * kWave);
      double most = 0.0;
      for (const double radius_in_fringes : {0.0, 0.7, 1.5, 2.5})
        for (const double turn_deg : {0.0, 47.0, 140.0, 222.0, 301.0}) {
          const Vec2 q =
              radius_in_fringes * kWave / kAperture * Vec2(std::cos(turn_deg * kDeg), std::sin(turn_deg * kDeg));
          const double found = field.diffracted_per_sr(tilted(q)) / peak;
          EXPECT_NEAR(found, cube.at(q), 3e-3) << mirrors << " " << radius_in_fringes << " " << turn_deg;
          most = std::max(most, found);
        }
      EXPECT_GT(most, 0.03);
      EXPECT_LT(most, 0.9);
    }
}

/// Returns the mean of exp(i c x^2) over |x| < a.
Complex fresnel_mean(double c, double a) {
  const GaussRule rule = gauss_legendre(64);
  Complex sum = 0.0;
  for (std::size_t k = 0; k < rule.nodes.size(); ++k)
    sum += rule.weights[k] * std::polar(1.0, c * std::pow(a * (2.0 * rule.nodes[k] - 1.0), 2.0));
  return sum;
}

// The form of the facets lengthens both paths through a prism by P (2 x^2 + y^2). In plan, x is the distance across the
// roof edge from the centroid of a facet. The field on the axis is therefore a product of two Fresnel integrals. For
// small heights, the relative intensity is 1 less the variance of the phase (Marechal).
TEST(FormedAperture, SunkPrismHasTheProductOfTwoFresnelIntegrals) {
  constexpr double kBase = 0.5, kWidth = 0.4;
  const double radius2 = kBase * kBase / 8.0 + kWidth * kWidth / 4.0;
  const PartSpec spec = single(RtpElement{kBase, kWidth, 90.0}, 0.3);
  for (const double depth_mm : {2e-5, -5e-5, 1e-4, 3e-4}) {
    const double c = 2.0 * std::numbers::pi / kWave * 4.0 * kPmma * std::sqrt(0.5) * depth_mm / radius2;
    const double strehl = std::norm(fresnel_mean(2.0 * c, 0.25 * kBase) * fresnel_mean(c, 0.5 * kWidth));
    const FarField field = field_of(spec, ideal(), paraboloid(depth_mm, std::sqrt(radius2)));
    const double found = field.diffracted_per_sr(Vec3::UnitZ()) * kWave * kWave / (kBase * kWidth);
    EXPECT_NEAR(found, strehl, 1.5e-3) << depth_mm;
    const double variance = c * c * 4.0 / 45.0 * (4.0 * std::pow(0.25 * kBase, 4.0) + std::pow(0.5 * kWidth, 4.0));
    if (variance < 0.3) {
      EXPECT_NEAR(found, 1.0 - variance, variance * variance + 1.5e-3) << depth_mm;
    }
  }
}

// The form in this test has a constant slope down every facet. Except for terms of second order, the field must equal
// that of a cube corner with tilted facets.
TEST(FormedAperture, SlopeIsTheTiltOfFacets) {
  constexpr double kTiltArcmin = 0.7;
  FacetForm slope;
  slope.add(0, 1, -std::tan(kTiltArcmin / 60.0 * kDeg));
  PartSpec spec = single(HexagonalCube{0.5}, 0.3);
  const Illumination light = from(5.0, 20.0);
  Optics optics = pmma();
  optics.lossless_entrance = true;
  const FarField formed = field_of(spec, optics, slope, light);
  const FarField plane = field_of(spec, optics, {}, light);
  spec.angle_errors.facet_tilt_arcmin.fill(kTiltArcmin);
  const FarField tilts = field_of(spec, optics, {}, light);
  const Vec2 back = direction_to_source(light).head<2>();
  const double peak = area(aperture_outline(HexagonalCube{0.5})) / (kWave * kWave);
  double most_change = 0.0;
  for (int j = -3; j <= 3; ++j)
    for (int i = -3; i <= 3; ++i) {
      const Vec3 at = tilted(back + 6e-4 * Vec2(i, j));
      EXPECT_NEAR(formed.diffracted_per_sr(at) / peak, tilts.diffracted_per_sr(at) / peak, 2e-3) << i << " " << j;
      most_change = std::max(most_change, std::abs(formed.diffracted_per_sr(at) - plane.diffracted_per_sr(at)) / peak);
    }
  EXPECT_GT(most_change, 0.05);
}

TEST(FormedAperture, PowerStaysAndNoHeightChangesNothing) {
  const PartSpec spec = single(HexagonalCube{0.5}, 0.3);
  const FarField plane = field_of(spec, ideal(), {});
  const FarField formed = field_of(spec, ideal(), paraboloid(1e-4, 0.2));
  EXPECT_GT(formed.groups()[0].polygons.size(), 10 * plane.groups()[0].polygons.size());
  EXPECT_NEAR(formed.diffracted_power(), plane.diffracted_power(), 1e-12);
  EXPECT_NEAR(formed.total_power(), plane.total_power(), 1e-12);
  double area_mm2 = 0.0;
  for (const FieldPolygon& p : formed.groups()[0].polygons) area_mm2 += p.transform.area_mm2();
  EXPECT_NEAR(area_mm2, area(aperture_outline(HexagonalCube{0.5})), 1e-12);
  const FarField::Split split = formed.split(frame_at({}), 0.03);
  EXPECT_NEAR(split.inside + split.outside, formed.total_power(), 2e-3);
  // Heights of 1e-300 have the same effect as plane facets.
  FacetForm none;
  none.add(2, 0, 1e-300);
  const FarField still = field_of(spec, ideal(), none);
  for (const double x : {0.0, 5e-4, 2e-3})
    EXPECT_NEAR(still.diffracted_per_sr(tilted({x, 0.0})), plane.diffracted_per_sr(tilted({x, 0.0})),
                1e-9 * plane.diffracted_per_sr(Vec3::UnitZ()));
}

// The light of cells that are too wide to be diffracted is represented by rays, whose directions depend on the slopes
// of the form. The intensities averaged over the discs must agree with Monte Carlo, for oblique light that passes from
// cell to cell.
TEST(FormedAperture, WideCellsSendRaysWhereMonteCarloDoes) {
  const PartSpec spec = infinite(HexagonalCube{3.0}, Arrangement::honeycomb, 2.0);
  const double radius = 1.5 / std::sqrt(4.0 / 3.0);
  FacetForm form = paraboloid(1.2e-3, radius);
  form.add(0, 3, 4e-4 / std::pow(radius, 3.0));
  form.add(1, 1, 3e-4 / std::pow(radius, 2.0));
  const Illumination light = from(8.0, 25.0);
  const Part part = build_part(spec);
  const ApertureKernel kernel({Angle::from_deg(0.2), Angle::from_deg(0.2)});
  DirectionScore score{frame_at(light), kernel, {}, {}};
  for (const Vec2& deg : {Vec2(0.0, 0.0), Vec2(0.0, 0.25), Vec2(0.2, -0.1), Vec2(-0.3, 0.0), Vec2(0.1, -0.35)})
    score.receivers.push_back(score.frame.direction(kDeg * deg));
  Optics optics = pmma();
  optics.facet_form = form;
  const MonteCarloResult traced =
      MonteCarlo(part, MonteCarlo::Engine::cell).trace(optics, light, {0.5}, rays(1U << 16), {}, nullptr, &score);
  FarFieldPolicy policy;
  policy.finest_detail_rad = 1.0;
  const FarField field = field_of(spec, pmma(), form, light, policy);
  EXPECT_TRUE(field.groups().empty());
  for (std::size_t k = 0; k < score.receivers.size(); ++k) {
    EXPECT_NEAR(field.intensity(score.receivers[k], kernel).per_sr, traced.score[k],
                4.0 * traced.score_error[k] + 0.01 * traced.score[0])
        << k;
    EXPECT_GT(traced.score[k], 0.1 * traced.score[0]) << k;
  }
}

TEST(FormedAperture, FormsThatBendTooMuchAreRefused) {
  FarFieldPolicy policy;
  policy.max_polygons = 50;
  const PartSpec spec = single(HexagonalCube{0.5}, 0.3);
  EXPECT_NO_THROW(field_of(spec, ideal(), paraboloid(1e-6, 0.2), {}, policy));
  EXPECT_THROW(field_of(spec, ideal(), paraboloid(3e-3, 0.2), {}, policy), BudgetError);
}

}  // namespace
}  // namespace retrace::testing::formed_aperture_test
