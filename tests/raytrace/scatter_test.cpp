// Tests of rough facets and absorbing walls in the tracers.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "raytrace/exact/beam_tracer.h"
#include "raytrace/paths/monte_carlo.h"
#include "tests/support/designs.h"
#include "tests/support/sample_size.h"
#include "tests/support/statistics.h"

namespace retrace::testing::scatter_test {
namespace {

using namespace geometry;
using namespace raytrace;
using surface_models::HarveyShack;

Optics rough(Optics optics, double sq_nm, double correlation_length_um = 5.0) {
  optics.facet_scatter = HarveyShack({sq_nm, correlation_length_um, 0.0, 0.0});
  optics.wavelength_nm = 550.0;
  return optics;
}

// Light with the angle of incidence t hits the facets of a prism at 45 degrees -+ t', where t' is the angle inside. The
// specular fractions of both facets are multiplied. The cone is so narrow that it contains no scattered light.
TEST(RoughFacets, SpecularSharesOfTwoFacetsMultiply) {
  const Part part = build_part(single(RtpElement{0.5, 0.5, 90.0}, 0.5));
  Optics smooth = pmma();
  smooth.lossless_entrance = true;
  for (const double t_deg : {0.0, 4.0}) {
    const double inside = std::asin(std::sin(t_deg * std::numbers::pi / 180.0) / kPmma);
    const double all = BeamTracer(part).trace(smooth, from(t_deg), {0.001}, {}).ledgers[0][Account::retroreflected];
    for (const double sq_nm : {5.0, 10.0, 20.0}) {
      double phase2 = 0.0;
      for (const double side : {-1.0, 1.0}) {
        const double phase =
            4.0 * std::numbers::pi * kPmma * sq_nm * std::cos(0.25 * std::numbers::pi + side * inside) / 550.0;
        phase2 += phase * phase;
      }
      const ConeResult result =
          MonteCarlo(part).trace(rough(smooth, sq_nm), from(t_deg), {0.001}, rays(1U << 17), {}).cones[0];
      EXPECT_NEAR(result.rre, all * std::exp(-phase2), student_bound(6) * result.spread + 1e-4) << sq_nm;
      EXPECT_NEAR(result.ledger.total(), 1.0, 1e-9);
      EXPECT_LT(result.ledger[Account::lost], 1e-12);
      EXPECT_GT(result.ledger[Account::scattered_out], 0.0);
    }
  }
}

// The exact engine traces the specular light. The result is the RRE with smooth facets times the specular fractions of
// both facets, without noise.
TEST(MeanField, OfAPrismIsTheSmoothReturnTimesTheSpecularShares) {
  const Part part = build_part(single(RtpElement{0.5, 0.5, 90.0}, 0.5));
  const BeamTracer tracer(part);
  Optics smooth = pmma();
  smooth.lossless_entrance = true;
  const double inside = std::asin(std::sin(4.0 * std::numbers::pi / 180.0) / kPmma);
  const double all = tracer.trace(smooth, from(4.0), {0.001}, {}).ledgers[0][Account::retroreflected];
  double phase2 = 0.0;
  for (const double side : {-1.0, 1.0})
    phase2 += std::pow(
        4.0 * std::numbers::pi * kPmma * 20.0 * std::cos(0.25 * std::numbers::pi + side * inside) / 550.0, 2.0);
  const Ledger ledger = tracer.trace(rough(smooth, 20.0), from(4.0), {0.001}, {}).ledgers[0];
  EXPECT_NEAR(ledger[Account::retroreflected], all * std::exp(-phase2), 1e-8);
  EXPECT_NEAR(ledger.total(), 1.0, 1e-9);
}

// In a cone that is too narrow for scattered light, rays return only the mean field if heights are Gaussian. In all
// other models, rays return at least the power of the mean field.
TEST(MeanField, IsNowhereMoreThanRaysBring) {
  const Part part = build_part(infinite(HexagonalCube{1.0}, Arrangement::honeycomb, 0.5));
  const surface_models::ScatterModel gaussian = HarveyShack({15.0, 20.0, 20.0, 300.0});
  const std::vector<surface_models::ScatterModel> models = {
      gaussian, surface_models::Abg(1e-4, 1e-4, 1.5),
      surface_models::Microfacet::of_waviness(surface_models::SlopeShape::beckmann, 300.0, 80.0),
      HarveyShack({10.0, 20.0, 400.0, 80.0})};
  BeamPolicy policy;
  policy.cutoff = 1e-8;
  for (const auto& model : models) {
    Optics optics = pmma();
    optics.facet_scatter = model;
    const Ledger ledger = BeamTracer(part).trace(optics, from(8.0, 20.0), {1e-4}, policy).ledgers[0];
    const double mean = ledger[Account::retroreflected];
    // The bound contains the spread of the rays, and is thus valid for any number of rays.
    const Sampling sampling = rays(test::sample_size(1U << 15, 1U << 17));
    const ConeResult traced = MonteCarlo(part).trace(optics, from(8.0, 20.0), {1e-4}, sampling, {}).cones[0];
    const double bound = student_bound(4) * traced.spread + 1e-4;
    EXPECT_LE(mean, traced.rre + bound);
    if (&model == &models.front()) {
      EXPECT_NEAR(mean, traced.rre, bound);
      EXPECT_GT(mean, 0.1);
    }
  }
}

// In every kind of array, the effect of roughness vanishes as the roughness goes to 0. More roughness never increases
// the RRE.
TEST(RoughFacets, EffectGrowsFromNothing) {
  for (const PartSpec& spec : {infinite(RtpElement{0.5, 0.5, 90.0}, Arrangement::offset, 0.5),
                               finite(HexagonalCube{1.0}, Arrangement::honeycomb, 2.2, 2.0, 0.5),
                               infinite(TriangularCube{1.0}, Arrangement::triangular, 0.5)}) {
    const Part part = build_part(spec);
    const MonteCarlo tracer(part);
    // The bounds are multiples of the spread of the results, and thus valid for any number of rays.
    const Sampling sampling = rays(test::sample_size(1U << 14, 1U << 16));
    const ConeResult smooth = tracer.trace(pmma(), from(3.0, 0.0), {0.5}, sampling, {}).cones[0];
    double before = smooth.rre;
    for (const double sq_nm : {0.001, 5.0, 15.0, 40.0}) {
      const ConeResult result = tracer.trace(rough(pmma(), sq_nm), from(3.0, 0.0), {0.5}, sampling, {}).cones[0];
      const double error = 4.0 * std::hypot(result.spread, smooth.spread);
      if (sq_nm < 1.0) {
        EXPECT_NEAR(result.rre, smooth.rre, error);
      }
      EXPECT_LT(result.rre, before + error) << sq_nm;
      EXPECT_NEAR(result.ledger.total(), 1.0, 1e-6);
      EXPECT_LT(result.ledger[Account::lost], 1e-9);
      before = result.rre;
    }
    EXPECT_LT(before, 0.5 * smooth.rre);
  }
}

TEST(RoughFacets, EveryModelClosesTheLedger) {
  const Part part = build_part(infinite(HexagonalCube{1.0}, Arrangement::honeycomb, 0.5));
  const std::vector<surface_models::ScatterModel> models = {
      surface_models::Abg(1e-4, 1e-4, 1.5),
      surface_models::Microfacet::of_waviness(surface_models::SlopeShape::beckmann, 300.0, 80.0),
      HarveyShack({10.0, 2.0, 300.0, 80.0})};
  for (const auto& model : models) {
    Optics optics = pmma();
    optics.facet_scatter = model;
    const ConeResult result = MonteCarlo(part).trace(optics, from(15.0, 40.0), {0.5}, rays(1U << 14), {}).cones[0];
    EXPECT_NEAR(result.ledger.total(), 1.0, 1e-6);
    EXPECT_LT(result.ledger[Account::lost], 1e-9);
    EXPECT_GT(result.ledger[Account::scattered_out], 1e-3);
  }
}

// Absorbing walls absorb all light that would leave or be reflected there. The exact engine and Monte Carlo must agree.
TEST(AbsorbingWalls, EnginesAgree) {
  const Part part = build_part(finite(RtpElement{0.5, 0.4, 90.0}, Arrangement::offset, 1.9, 1.4, 0.3));
  Optics optics = pmma();
  optics.absorbing_walls = true;
  BeamPolicy policy;
  policy.truncated_goal = 1e-6;
  const Ledger exact = BeamTracer(part).trace(optics, from(20.0, 60.0), {0.5}, policy).ledgers[0];
  const ConeResult sampled = MonteCarlo(part).trace(optics, from(20.0, 60.0), {0.5}, rays(1U << 17), {}).cones[0];
  EXPECT_GT(exact[Account::absorbed], 0.01);
  EXPECT_NEAR(exact.total(), 1.0, 1e-9);
  for (std::size_t k = 0; k < kAccountCount; ++k) EXPECT_NEAR(exact.power[k], sampled.ledger.power[k], 1e-3);
}

}  // namespace
}  // namespace retrace::testing::scatter_test
