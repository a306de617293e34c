// Tests of roughness between dielectrics: light that is scattered out at total reflection, ledgers, and agreement of
// the engines.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "raytrace/exact/beam_tracer.h"
#include "raytrace/faces/textured_facet.h"
#include "tests/support/designs.h"
#include "tests/support/statistics.h"

namespace retrace::testing::rough_dielectric_test {
namespace {

using namespace geometry;
using namespace raytrace;
using surface_models::HarveyShack, surface_models::Lobe, surface_models::Polarisation2;

Optics rough(double sq_nm, double length_um, double waviness_sq_nm = 0.0, double waviness_length_um = 0.0) {
  Optics optics = pmma();
  optics.wavelength_nm = 550.0;
  optics.facet_scatter = HarveyShack({sq_nm, length_um, waviness_sq_nm, waviness_length_um}, {kPmma, 1.0, 550.0});
  return optics;
}

/// Returns a ray inside the part that hits a facet with the outward normal -z.
Ray ray_at(double incidence_deg, const Stokes& stokes) {
  const double t = incidence_deg * std::numbers::pi / 180.0;
  Ray ray;
  ray.direction = Vec3(std::sin(t), 0.0, -std::cos(t));
  ray.light = {stokes, -Vec3::UnitY()};
  return ray;
}

/// Returns the power that a facet scatters into transmission in first order, by the midpoint rule.
double scattered_through(const Optics& optics, double incidence_deg, const Polarisation2& coherency) {
  const auto& model = std::get<HarveyShack>(optics.facet_scatter);
  const surface_models::ScatterEvent event = {ray_at(incidence_deg, kUnpolarised).direction, kPmma, 1.0, 550.0, true};
  constexpr int kRings = 200;
  double sum = 0.0;
  for (int r = 0; r < kRings; ++r)
    for (int a = 0; a < kRings; ++a) {
      const double sine2 = (r + 0.5) / kRings, angle = 2.0 * std::numbers::pi * (a + 0.5) / kRings;
      const Vec2 beta = std::sqrt(sine2) * Vec2(std::cos(angle), std::sin(angle));
      sum += model.diffracted_once_density(event, {}, Lobe::transmission, -Vec3::UnitY(), coherency, beta);
    }
  return std::numbers::pi * sum / (kRings * kRings);
}

// One facet is hit many times. Every event conserves power, and the specular light is that of the exact engine. At
// total reflection, the light that leaves through the facet is that of first-order theory, for any choice of branches.
TEST(RoughDielectric, OneFacetKeepsItsPower) {
  constexpr std::uint32_t kDraws = 40000;
  const Optics optics = rough(6.0, 0.39);
  const std::vector<Stokes> lights = {kUnpolarised, {1.0, 1.0, 0.0, 0.0}, {1.0, -1.0, 0.0, 0.0}, {1.0, 0.0, 0.0, 1.0}};
  for (const double incidence_deg : {20.0, 45.0, 54.74})
    for (const Stokes& stokes : lights)
      for (const double split_power : {1.0, 1e-3}) {
        const Ray ray = ray_at(incidence_deg, stokes);
        double through = 0.0, through2 = 0.0, specular = 0.0;
        for (std::uint32_t k = 0; k < kDraws; ++k) {
          surface_models::RandomStream random({5, 6}, k, 0, 0);
          const TexturedReturn back = meet_textured_facet(optics, -Vec3::UnitZ(), ray, split_power, random);
          double total = back.truncated + back.absorbed, out = 0.0;
          for (std::size_t n = 0; n < back.count; ++n) {
            const Ray& one = back.rays[n];
            total += one.light.power();
            EXPECT_EQ(one.inside, one.direction.z() > 0.0);
            EXPECT_NEAR(one.light.s_axis.dot(one.direction), 0.0, 1e-12);
            const Stokes& s = one.light.stokes;
            EXPECT_LE(s.q * s.q + s.u * s.u + s.v * s.v, s.i * s.i * (1.0 + 1e-9));
            if (one.scattered && !one.inside) out += one.light.power();
            if (!one.scattered && one.inside) specular += one.light.power() / kDraws;
          }
          ASSERT_NEAR(total, 1.0, 1e-12);
          ASSERT_NEAR(back.truncated, 0.0, 1e-12);
          through += out / kDraws;
          through2 += out * out / kDraws;
        }
        const double error = 5.0 * std::sqrt((through2 - through * through) / kDraws);
        const double cosine = -ray.direction.z();
        const materials::FresnelCoefficients f = materials::fresnel(kPmma, cosine);
        Light kept = ray.light;
        kept = kept.reflected(mean_field(optics, true, cosine, f));
        EXPECT_NEAR(specular, kept.power(), 5.0 * std::sqrt(kept.power() * (1.0 - kept.power()) / kDraws) + 1e-9);
        if (!f.total_reflection) continue;
        Polarisation2 coherency;
        coherency << 0.5 * (1.0 + stokes.q), std::complex<double>(0.0, 0.5 * stokes.v),
            std::complex<double>(0.0, -0.5 * stokes.v), 0.5 * (1.0 - stokes.q);
        const double expected = scattered_through(optics, incidence_deg, coherency);
        // Light that is diffracted twice reduces this power.
        EXPECT_NEAR(through, expected, error + 0.03 * expected) << incidence_deg << " " << stokes.q;
        EXPECT_GT(expected, 1e-4);
      }
}

// The specular light is the same in the exact engine, with Embree, and in the SIMD lanes of the cell engine. All
// ledgers add up to 1.
TEST(RoughDielectric, EnginesAgreeOnTheMeanField) {
  const Part part = build_part(infinite(HexagonalCube{1.0}, Arrangement::honeycomb, 0.5));
  BeamPolicy policy;
  policy.cutoff = 1e-8;
  for (const Optics& optics : {rough(12.0, 0.39), rough(15.0, 20.0, 10.0, 60.0)}) {
    const Ledger exact = BeamTracer(part).trace(optics, from(8.0, 20.0), {1e-4}, policy).ledgers[0];
    EXPECT_NEAR(exact.total(), 1.0, 1e-9);
    EXPECT_GT(exact[Account::retroreflected], 0.05);
    for (const auto engine : {MonteCarlo::Engine::cell, MonteCarlo::Engine::embree}) {
      const ConeResult traced =
          MonteCarlo(part, engine).trace(optics, from(8.0, 20.0), {1e-4}, rays(1U << 16), {}).cones[0];
      EXPECT_NEAR(exact[Account::retroreflected], traced.rre, student_bound(4) * traced.std_error + 1e-4);
      EXPECT_NEAR(traced.ledger.total(), 1.0, 1e-6);
      EXPECT_LT(traced.ledger[Account::lost], 1e-9);
      EXPECT_LT(std::abs(traced.ledger[Account::truncated]), 1e-6);
    }
  }
}

// For long correlation lengths, the results are those of the phase model, which is used for mirrors and metal films.
TEST(RoughDielectric, IsThePhaseModelForLongHeights) {
  const Part part = build_part(single(RtpElement{0.5, 0.5, 90.0}, 0.5));
  Optics phases = rough(20.0, 100.0);
  const Ledger ours = BeamTracer(part).trace(phases, from(4.0), {0.001}, {}).ledgers[0];
  phases.facet_scatter = HarveyShack({20.0, 100.0, 0.0, 0.0});
  const Ledger theirs = BeamTracer(part).trace(phases, from(4.0), {0.001}, {}).ledgers[0];
  EXPECT_NEAR(ours[Account::retroreflected] / theirs[Account::retroreflected], 1.0, 1e-4);
  EXPECT_NE(ours[Account::retroreflected], theirs[Account::retroreflected]);
}

}  // namespace
}  // namespace retrace::testing::rough_dielectric_test
