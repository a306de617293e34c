// Tests of rounded and chamfered edges: closed forms of the ineffective widths, agreement of the engines, and vanishing
// effects as the radius goes to 0.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "geometry/elements/edges.h"
#include "materials/fresnel.h"
#include "raytrace/exact/beam_tracer.h"
#include "raytrace/paths/monte_carlo.h"
#include "tests/support/designs.h"
#include "tests/support/engines.h"

namespace retrace::testing::edges_test {
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

// A root is a valley edge between the facets of one element; a rim is an edge between neighbouring elements. At normal
// incidence, a root or rim of radius r makes the width sqrt(2) r of a prism ineffective.
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

// A flat across the root reflects like a plane surface.
TEST(Edges, ChamferedRootOfAPrismIsAPlane) {
  const PartSpec spec = with_edges(infinite(RtpElement{0.5, 0.5, 90.0}, Arrangement::aligned, 1.0), {0.0, 0.02, 0.0});
  Optics lossless = pmma();
  lossless.lossless_entrance = true;
  const double fresnel = materials::reflectance(1.0 / kPmma, 1.0);
  EXPECT_NEAR(exact_rre(spec, lossless), 1.0 - 0.04 * (1.0 - fresnel), 1e-9);
}

// Land is a flat surface between elements. Between the rim of a prism and horizontal land, the rounded edge is an arc
// of 45 degrees. It covers the width tan(22.5 degrees) r of the land, and the same length of the facet. The land itself
// reflects like a plane surface.
TEST(Edges, RimsBesideLandTakeTheirWidth) {
  const double base = 0.5;
  const double gap = 0.1;
  PartSpec sharp = infinite(RtpElement{base, 0.5, 90.0}, Arrangement::aligned, 1.0);
  sharp.array.x_gap_mm = gap;
  Optics lossless = pmma();
  lossless.lossless_entrance = true;
  const double fresnel = materials::reflectance(1.0 / kPmma, 1.0);
  const double tangent = std::tan(std::numbers::pi / 8.0);
  for (const double radius : {1e-4, 1e-3, 2e-2, 5e-2}) {
    const double facets = base - std::numbers::sqrt2 * tangent * radius;
    const double land = gap - 2.0 * tangent * radius;
    EXPECT_NEAR(exact_rre(with_edges(sharp, {0.0, 0.0, radius}), lossless), (facets + fresnel * land) / (base + gap),
                1e-8);
    EXPECT_NEAR(rim_reach_over_land_mm(with_edges(sharp, {0.0, 0.0, radius})), tangent * radius, 1e-15);
  }
  const double width = 0.02;
  const double leg = 0.5 * width / std::cos(std::numbers::pi / 8.0);
  EXPECT_NEAR(exact_rre(with_edges(sharp, {0.0, 0.0, 0.0, width}), lossless),
              (base - std::numbers::sqrt2 * leg + fresnel * (gap - 2.0 * leg)) / (base + gap), 1e-9);
  EXPECT_NEAR(rim_reach_over_land_mm(with_edges(sharp, {0.0, 0.0, 0.0, width})), leg, 1e-15);
}

// The chamfer of two neighbouring rims is a horizontal plane.
TEST(Edges, ChamferedRimsOfPrismsArePlanes) {
  const PartSpec spec =
      with_edges(infinite(RtpElement{0.5, 0.5, 90.0}, Arrangement::aligned, 1.0), {0.0, 0.0, 0.0, 0.02});
  Optics lossless = pmma();
  lossless.lossless_entrance = true;
  const double fresnel = materials::reflectance(1.0 / kPmma, 1.0);
  EXPECT_NEAR(exact_rre(spec, lossless), 1.0 - 0.04 * (1.0 - fresnel), 1e-9);
}

// At normal incidence, light hits a rounded root of a cube with the edge a if its distances to two of the three facets
// are nearly equal. In plan, these points are within r / sqrt(2) of six half-lines from the axis. A rounded rim makes
// two strips of the aperture ineffective: the strip next to the rim, and the strip through which light that hits the
// rim would leave. The remaining effects are of second order.
TEST(Edges, RoundedEdgesOfCubesTakeTheirWidth) {
  struct Case {
    Element element;
    Arrangement arrangement;
    double sharp_rre;
    double root_slope;
    double rim_slope;
  };
  for (const Case& c : {Case{HexagonalCube{kCubeAperture}, Arrangement::honeycomb, 1.0, 4.0, 2.0},
                        Case{TriangularCube{kCubeAperture}, Arrangement::triangular, 2.0 / 3.0, 4.0, 8.0 / 3.0}}) {
    const PartSpec sharp = infinite(c.element, c.arrangement, 1.0);
    const auto slope = [&](EdgeShape edges, double EdgeShape::*width) {
      const auto loss_per_mm = [&](double radius) {
        edges.*width = radius;
        BeamPolicy policy;
        policy.cutoff = 1e-12;
        const double rre = BeamTracer(build_part(with_edges(sharp, edges)))
                               .trace(ideal(), from(0.0), {0.01}, policy)
                               .ledgers[0][Account::retroreflected];
        return (c.sharp_rre - rre) / radius;
      };
      return 2.0 * loss_per_mm(0.005) - loss_per_mm(0.01);
    };
    EXPECT_NEAR(slope({}, &EdgeShape::root_radius_mm), c.root_slope, 1e-3);
    EXPECT_NEAR(slope({}, &EdgeShape::rim_radius_mm), c.rim_slope, 1e-3);
  }
}

std::vector<PartSpec> all_kinds(const EdgeShape& edges) {
  PartSpec apart = finite(RtpElement{0.5, 0.5, 90.0}, Arrangement::aligned, 1.5, 1.3, 0.5);
  PartSpec checker = finite(RtpElement{0.5, 0.5, 84.0}, Arrangement::checker, 1.5, 1.6, 0.5);
  apart.array.x_gap_mm = 0.06;
  checker.array.y_gap_mm = 0.04;
  PartSpec wrong = single(HexagonalCube{0.8, {6.0, 20.0}}, 0.7);
  wrong.angle_errors = {{20.0, -10.0, 5.0}, {10.0, 0.0, -15.0}};
  return {with_edges(infinite(RtpElement{0.5, 0.5, 90.0}, Arrangement::offset, 0.5), edges),
          with_edges(finite(RtpElement{0.5, 0.5, 84.0}, Arrangement::checker, 1.5, 1.5, 0.5), edges),
          with_edges(apart, edges),
          with_edges(checker, edges),
          with_edges(finite(HexagonalCube{0.8}, Arrangement::honeycomb, 1.9, 1.7, 0.5), edges),
          with_edges(infinite(TriangularCube{0.8}, Arrangement::triangular, 0.5), edges),
          with_edges(single(TriangularCube{0.8}, 0.5), edges),
          with_edges(wrong, edges)};
}

// Each arc is approximated by only four plane strips (chords), because each strip splits the beams of the exact engine.
// The accuracy of the approximation does not matter here: both engines trace the same strips.
TEST(Edges, EnginesAgree) {
  for (EdgeShape edges : {EdgeShape{0.02, 0.0, 0.01}, EdgeShape{0.0, 0.03, 0.0, 0.02}}) {
    edges.chords = 4;
    for (const PartSpec& spec : all_kinds(edges)) expect_engines_agree(spec, 0.06);
  }
}

// The RRE decreases as the radius increases. As the radius goes to 0, the RRE approaches that of sharp edges.
TEST(Edges, EffectGrowsFromNothing) {
  const auto rre = [](const PartSpec& spec) {
    const Part part = build_part(spec);
    return MonteCarlo(part).trace(pmma(), from(0.0), {0.5}, rays(1U << 13), {}).cones[0];
  };
  const std::vector<PartSpec> sharp = all_kinds({});
  for (std::size_t k = 0; k < sharp.size(); ++k) {
    BeamPolicy policy;
    policy.cutoff = 1e-6;
    const Ledger exact = BeamTracer(build_part(sharp[k])).trace(pmma(), from(0.0), {0.5}, policy).ledgers[0];
    double before = exact[Account::retroreflected];
    const ConeResult faint = rre(all_kinds({1e-6, 0.0, 1e-6, 0.0, 8})[k]);
    EXPECT_NEAR(faint.rre, before, 4.0 * faint.spread + exact[Account::truncated] + 5e-5) << k;
    if (before < 0.5) continue;  // errors of angle are so large that rounded edges do not reduce the RRE
    for (const double radius : {0.01, 0.03}) {
      const ConeResult worn = rre(all_kinds({radius, 0.0, radius, 0.0, 8})[k]);
      EXPECT_LT(worn.rre + 4.0 * worn.spread, before) << k << ": " << radius;
      before = worn.rre - 4.0 * worn.spread;
    }
  }
}

TEST(Edges, PartsStayClosed) {
  for (const EdgeShape& edges : {EdgeShape{0.02, 0.0, 0.01}, EdgeShape{0.0, 0.03, 0.0, 0.02}})
    for (const PartSpec& spec : all_kinds(edges)) {
      if (spec.array.extent == Extent::finite) expect_closed_part(spec);
    }
}

}  // namespace
}  // namespace retrace::testing::edges_test
