// Rounded and chamfered edges: dead widths by closed form, agreement of the engines, and no effect in the limit.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "geometry/check/boundary_check.h"
#include "geometry/closed_boundary.h"
#include "materials/fresnel.h"
#include "raytrace/beam_tracer.h"
#include "raytrace/monte_carlo.h"
#include "tests/support/designs.h"

namespace retrace::testing {
namespace {

using namespace geometry;
using namespace raytrace;

PartSpec with_edges(PartSpec spec, const EdgeShape& edges) {
  spec.edges = edges;
  return spec;
}

double exact_rre(const PartSpec& spec, const Optics& optics, double incidence_deg = 0.0, double truncated = 1e-9) {
  BeamPolicy policy;
  policy.truncated_goal = truncated;
  return BeamTracer(build_part(spec))
      .trace(optics, from(incidence_deg), {0.5}, policy)
      .ledgers[0][Account::retroreflected];
}

// At normal incidence a root or rim of radius r takes the width sqrt(2) r of a prism.
TEST(Edges, RoundedEdgesOfAPrismTakeTheirWidth) {
  const double base = 0.5;
  const PartSpec sharp = infinite(RtpElement{base, 0.5, 90.0}, Arrangement::aligned, 1.0);
  Optics lossless = pmma();
  lossless.lossless_entrance = true;
  const double fresnel = materials::reflectance(1.0 / kPmma, 1.0);
  for (const double radius : {1e-4, 1e-3, 5e-3, 2e-2}) {
    const double dead = std::numbers::sqrt2 * radius / base;
    for (const EdgeShape& edges : {EdgeShape{radius, 0.0, 0.0}, EdgeShape{0.0, 0.0, radius}}) {
      EXPECT_NEAR(exact_rre(with_edges(sharp, edges), lossless), 1.0 - dead, 1e-8);
      const double loss = exact_rre(sharp, pmma()) - exact_rre(with_edges(sharp, edges), pmma());
      EXPECT_NEAR(loss / ((1.0 - fresnel) * dead), 1.0, 0.01 + dead);
    }
    EXPECT_NEAR(exact_rre(with_edges(sharp, {radius, 0.0, radius}), lossless), 1.0 - 2.0 * dead, 1e-8);
  }
}

// A flat across the root reflects as much as a plane does.
TEST(Edges, ChamferedRootOfAPrismIsAPlane) {
  const PartSpec spec = with_edges(infinite(RtpElement{0.5, 0.5, 90.0}, Arrangement::aligned, 1.0), {0.0, 0.02, 0.0});
  Optics lossless = pmma();
  lossless.lossless_entrance = true;
  const double fresnel = materials::reflectance(1.0 / kPmma, 1.0);
  EXPECT_NEAR(exact_rre(spec, lossless), 1.0 - 0.04 * (1.0 - fresnel), 1e-9);
}

std::vector<PartSpec> all_kinds(const EdgeShape& edges) {
  EdgeShape roots = edges;
  roots.rim_radius_mm = 0.0;
  return {with_edges(infinite(RtpElement{0.5, 0.5, 90.0}, Arrangement::offset, 0.5), edges),
          with_edges(finite(RtpElement{0.5, 0.5, 84.0}, Arrangement::checker, 1.5, 1.5, 0.5), edges),
          with_edges(finite(HexagonalCube{0.8}, Arrangement::honeycomb, 1.9, 1.7, 0.5), roots),
          with_edges(infinite(TriangularCube{0.8}, Arrangement::triangular, 0.5), roots),
          with_edges(single(TriangularCube{0.8}, 0.5), roots)};
}

TEST(Edges, EnginesAgree) {
  for (const EdgeShape& edges : {EdgeShape{0.02, 0.0, 0.01}, EdgeShape{0.0, 0.03, 0.0}})
    for (const PartSpec& spec : all_kinds(edges)) {
      const Part part = build_part(spec);
      BeamPolicy policy;
      policy.truncated_goal = 1e-3;
      const Ledger exact = BeamTracer(part).trace(pmma(), from(3.0), {0.5}, policy).ledgers[0];
      const ConeResult sampled = MonteCarlo(part).trace(pmma(), from(3.0), {0.5}, rays(1U << 16), {}).cones[0];
      EXPECT_NEAR(exact[Account::retroreflected], sampled.rre,
                  4.0 * sampled.std_error + exact[Account::truncated] + 1e-6);
      EXPECT_NEAR(exact.total(), 1.0, 1e-9);
      EXPECT_LT(sampled.ledger[Account::lost], 1e-9);
    }
}

// The wider the edge the less comes back, and none of it at a radius of nothing.
TEST(Edges, EffectGrowsFromNothing) {
  const std::vector<PartSpec> sharp = all_kinds({});
  for (std::size_t k = 0; k < sharp.size(); ++k) {
    double before = exact_rre(sharp[k], pmma(), 0.0, 1e-3);
    EXPECT_NEAR(exact_rre(all_kinds({1e-6, 0.0, 0.0})[k], pmma(), 0.0, 1e-3), before, 2e-3);
    for (const double radius : {0.002, 0.01, 0.03}) {
      const double rre = exact_rre(all_kinds({radius, 0.0, 0.0})[k], pmma(), 0.0, 1e-3);
      EXPECT_LT(rre, before + 1e-3);
      before = rre;
    }
    EXPECT_LT(before, 0.97);
  }
}

TEST(Edges, PartsStayClosed) {
  for (const EdgeShape& edges : {EdgeShape{0.02, 0.0, 0.01}, EdgeShape{0.0, 0.03, 0.0}})
    for (const PartSpec& spec : all_kinds(edges)) {
      if (spec.extent == Extent::infinite) continue;
      const BoundaryReport report = check_boundary(closed_boundary(build_part(spec)));
      EXPECT_TRUE(report.is_closed);
      EXPECT_TRUE(report.is_manifold);
      EXPECT_FALSE(report.self_intersects);
    }
}

}  // namespace
}  // namespace retrace::testing
