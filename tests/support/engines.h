#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "geometry/check/boundary_check.h"
#include "geometry/part/closed_boundary.h"
#include "raytrace/exact/stochastic_beams.h"
#include "raytrace/paths/monte_carlo.h"
#include "tests/support/designs.h"
#include "tests/support/reference_tracer.h"
#include "tests/support/statistics.h"

// Checks that the engines (beams, stochastic beams, rays and the reference tracer) give equal results for a part.

namespace retrace::testing {

/// Expects that beams, stochastic beams and rays give the same efficiency for PMMA at 3 degrees of incidence. The
/// powers of each ledger must add up to 1.
/// \param most_truncated maximum power that beams may truncate
inline void expect_engines_agree(const geometry::PartSpec& spec, double most_truncated) {
  using raytrace::Account;
  const geometry::Part part = geometry::build_part(spec);
  raytrace::BeamPolicy policy;
  policy.cutoff = 1e-5;
  const raytrace::Ledger exact = raytrace::BeamTracer(part).trace(pmma(), from(3.0), {0.5}, policy).ledgers[0];
  const raytrace::ConeResult sampled =
      raytrace::MonteCarlo(part).trace(pmma(), from(3.0), {0.5}, rays(1U << 16), {}).cones[0];
  EXPECT_NEAR(exact[Account::retroreflected], sampled.rre, 4.0 * sampled.spread + exact[Account::truncated] + 1e-6);
  EXPECT_LT(exact[Account::truncated], most_truncated);
  EXPECT_NEAR(exact.total(), 1.0, 1e-9);
  raytrace::Sampling sampling;
  sampling.target_error = 1e-3;
  const raytrace::BeamTracer tracer(part);
  raytrace::StochasticBeams stochastic(tracer, nullptr, pmma(), from(3.0), {0.5}, sampling);
  while (!stochastic.advance()) continue;
  const raytrace::ConeResult& resampled = stochastic.result().cones[0];
  EXPECT_NEAR(resampled.rre, sampled.rre, 4.0 * std::hypot(sampled.std_error, resampled.std_error));
  EXPECT_NEAR(resampled.ledger.total(), 1.0, 1e-12);
  EXPECT_LT(sampled.ledger[Account::lost], 1e-9);
}

/// Traces a part with beams. Expects that it returns the fraction `expected` of the light at normal incidence and
/// absorbs the remainder.
inline void expect_returned_or_absorbed(const geometry::Part& part, const raytrace::Optics& optics, double expected) {
  using raytrace::Account;
  raytrace::BeamPolicy policy;
  policy.cutoff = 1e-13;
  const raytrace::Ledger exact = raytrace::BeamTracer(part).trace(optics, {}, {0.5}, policy).ledgers[0];
  EXPECT_NEAR(exact[Account::retroreflected], expected, 1e-9);
  EXPECT_NEAR(exact[Account::absorbed], 1.0 - expected, 1e-9);
  EXPECT_NEAR(exact.total(), 1.0, 1e-12);
}

/// Expects that the boundary of a part is closed, manifold and free of self-intersections.
/// \pre the part is finite
inline void expect_closed_part(const geometry::PartSpec& spec) {
  const geometry::BoundaryReport report =
      geometry::check_boundary(geometry::closed_boundary(geometry::build_part(spec)));
  EXPECT_TRUE(report.is_closed);
  EXPECT_TRUE(report.is_manifold);
  EXPECT_FALSE(report.self_intersects);
}

/// Expects that the ledger contains all light and that no light is lost. All given angles of incidence are tested, with
/// PMMA and with perfect mirrors.
inline void expect_nothing_lost(const geometry::Part& part, const std::vector<double>& incidences_deg,
                                std::uint64_t ray_count, const std::string& name) {
  const raytrace::MonteCarlo tracer(part);
  for (const raytrace::Optics& optics : {pmma(), ideal()})
    for (const double t : incidences_deg)
      for (const double p : {0.0, 70.0, 190.0}) {
        const raytrace::MonteCarloResult result = tracer.trace(optics, from(t, p), {0.5}, rays(ray_count), {});
        const raytrace::Ledger& ledger = result.cones[0].ledger;
        EXPECT_NEAR(ledger.total(), 1.0, 1e-9) << name << " at " << t << ", " << p;
        EXPECT_EQ(ledger[raytrace::Account::lost], 0.0) << name << " at " << t << ", " << p;
        EXPECT_EQ(result.misses, 0U) << name << " at " << t << ", " << p;
      }
}

/// Expects that beams and rays give the same power in each account (energy term) of the ledger. The tolerance is the
/// power that beams truncate at `cutoff`, plus `slack`, which covers the error of the rays.
inline void expect_same_accounts(const geometry::Part& part, const raytrace::Illumination& light, double cutoff,
                                 double slack, const std::string& name, std::uint64_t ray_count = 1U << 16) {
  raytrace::BeamPolicy policy;
  policy.cutoff = cutoff;
  const raytrace::Ledger exact = raytrace::BeamTracer(part).trace(pmma(), light, {8.0}, policy).ledgers[0];
  const raytrace::Ledger traced =
      raytrace::MonteCarlo(part).trace(pmma(), light, {8.0}, rays(ray_count), {}).cones[0].ledger;
  EXPECT_NEAR(exact.total(), 1.0, 1e-9) << name;
  for (std::size_t a = 0; a < raytrace::kAccountCount; ++a)
    EXPECT_NEAR(exact.power[a], traced.power[a], exact[raytrace::Account::truncated] + slack)
        << name << ": " << raytrace::kAccountNames[a];
}

/// Expects that rays give the same power in each account (energy term) of the ledger as the reference. The tolerance is
/// the noise of the reference plus its truncated power and `slack`.
/// \param comparisons total number of comparisons in the test
inline void expect_accounts_of(const ReferenceResult& reference, const raytrace::Ledger& traced,
                               std::size_t comparisons, double slack, const std::string& name) {
  const double z = student_bound(comparisons);
  const double left = reference.mean[raytrace::Account::truncated] + slack;
  for (std::size_t a = 0; a < raytrace::kAccountCount; ++a) {
    if (a == static_cast<std::size_t>(raytrace::Account::truncated)) continue;
    EXPECT_NEAR(traced.power[a], reference.mean.power[a], z * reference.std_error[a] + left)
        << name << ": " << raytrace::kAccountNames[a];
  }
}

/// Expects that rays agree with the reference tracer, for PMMA and a cone of 8 degrees. The statistical bound is for a
/// test with two such comparisons. It is proportional to the standard error of the reference, and thus valid for any
/// number of rays.
inline void expect_agrees_with_reference(const geometry::Part& part, const raytrace::Illumination& light,
                                         std::uint64_t reference_rays, std::uint64_t ray_count,
                                         const std::string& name) {
  const ReferenceResult reference = reference_trace(part, pmma(), light, 8.0, reference_rays, 7);
  const raytrace::MonteCarloResult traced = raytrace::MonteCarlo(part).trace(pmma(), light, {8.0}, rays(ray_count), {});
  expect_accounts_of(reference, traced.cones[0].ledger, 2 * raytrace::kAccountCount, 1e-3, name);
}

}  // namespace retrace::testing
