#pragma once

#include <gtest/gtest.h>

#include "geometry/check/boundary_check.h"
#include "geometry/part/closed_boundary.h"
#include "raytrace/exact/beam_tracer.h"
#include "raytrace/paths/monte_carlo.h"
#include "tests/support/designs.h"

namespace retrace::testing {

/// Beams and rays find the same efficiency of PMMA at 3 degrees, and all light is in the ledgers.
/// \param most_truncated that beams may leave behind
inline void expect_engines_agree(const geometry::PartSpec& spec, double most_truncated) {
  using raytrace::Account;
  const geometry::Part part = geometry::build_part(spec);
  raytrace::BeamPolicy policy;
  policy.cutoff = 1e-5;
  const raytrace::Ledger exact = raytrace::BeamTracer(part).trace(pmma(), from(3.0), {0.5}, policy).ledgers[0];
  const raytrace::ConeResult sampled =
      raytrace::MonteCarlo(part).trace(pmma(), from(3.0), {0.5}, rays(1U << 16), {}).cones[0];
  EXPECT_NEAR(exact[Account::retroreflected], sampled.rre, 4.0 * sampled.std_error + exact[Account::truncated] + 1e-6);
  EXPECT_LT(exact[Account::truncated], most_truncated);
  EXPECT_NEAR(exact.total(), 1.0, 1e-9);
  EXPECT_LT(sampled.ledger[Account::lost], 1e-9);
}

/// Closed, manifold and free of self-intersections. \pre a finite part
inline void expect_closed_part(const geometry::PartSpec& spec) {
  const geometry::BoundaryReport report =
      geometry::check_boundary(geometry::closed_boundary(geometry::build_part(spec)));
  EXPECT_TRUE(report.is_closed);
  EXPECT_TRUE(report.is_manifold);
  EXPECT_FALSE(report.self_intersects);
}

}  // namespace retrace::testing
