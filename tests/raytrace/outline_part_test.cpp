// Tests of parts with an outline: their solids, and the light that all engines trace in them.
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <random>

#include "geometry/elements/facet_planes.h"
#include "geometry/part/mould_boundary.h"
#include "geometry/part/welded_part.h"
#include "raytrace/sampling/entrance_sampler.h"
#include "tests/geometry/part_checks.h"
#include "tests/support/designs.h"
#include "tests/support/engines.h"
#include "tests/support/outlined_parts.h"
#include "tests/support/sample_size.h"

namespace retrace::testing::outline_part_test {
namespace {

using namespace geometry;
using namespace raytrace;

PartSpec prisms(double size_mm = 0.5) {
  return finite(RtpElement{size_mm, 0.8 * size_mm, 90.0}, Arrangement::offset, 0.0, 0.0, 0.8 * size_mm);
}
PartSpec hexagons(double aperture_mm = 0.6) {
  return finite(HexagonalCube{aperture_mm}, Arrangement::honeycomb, 0.0, 0.0, 0.5);
}

/// Returns a rectangular part of 3.1 mm x 2.3 mm with margins of 0.1 mm.
PartSpec rectangular_part(PartSpec spec) {
  spec.array.x_length_mm = 3.1;
  spec.array.y_length_mm = 2.3;
  spec.array.x_offset_mm = spec.array.y_offset_mm = 0.1;
  return spec;
}

TEST(OutlinePart, ARectangleIsTheRectangle) {
  for (const PartSpec& base : {prisms(), hexagons()}) {
    const PartSpec outlined =
        with_outline(base, oriented({polygon_of_corners({{5, 1}, {8.1, 1}, {8.1, 3.3}, {5, 3.3}})}), 0.1);
    const Part a = build_part(rectangular_part(base));
    const Part b = build_part(outlined);
    EXPECT_EQ(a.elements_full, b.elements_full);
    EXPECT_EQ(a.elements_partial, b.elements_partial);
    EXPECT_NEAR(a.entrance_area_mm2, b.entrance_area_mm2, 1e-12);
    const ConeResult rays_a = MonteCarlo(a).trace(pmma(), from(7.0, 20.0), {0.5}, rays(1U << 12), {}).cones[0];
    const ConeResult rays_b = MonteCarlo(b).trace(pmma(), from(7.0, 20.0), {0.5}, rays(1U << 12), {}).cones[0];
    for (std::size_t k = 0; k < kAccountCount; ++k) EXPECT_NEAR(rays_a.ledger.power[k], rays_b.ledger.power[k], 1e-12);
    BeamPolicy policy;
    policy.cutoff = 1e-4;
    const Ledger beams_a = BeamTracer(a).trace(pmma(), from(7.0, 20.0), {0.5}, policy).ledgers[0];
    const Ledger beams_b = BeamTracer(b).trace(pmma(), from(7.0, 20.0), {0.5}, policy).ledgers[0];
    for (std::size_t k = 0; k < kAccountCount; ++k) EXPECT_NEAR(beams_a.power[k], beams_b.power[k], 1e-12);
  }
}

// A chamfer of a nanometre at a corner changes nothing that can be measured, but the outline is no longer a rectangle.
TEST(OutlinePart, AnOutlineThatIsAlmostARectangleGivesItsNumbers) {
  const double c = 1e-6;
  for (const PartSpec& base : {prisms(), hexagons()}) {
    const Part a = build_part(rectangular_part(base));
    const Part b = build_part(with_outline(
        base, oriented({polygon_of_corners({{0, 0}, {3.1, 0}, {3.1, 2.3}, {c, 2.3}, {0, 2.3 - c}})}), 0.1));
    EXPECT_NEAR(a.retro_facet_area_mm2, b.retro_facet_area_mm2, 1e-6);
    BeamPolicy policy;
    policy.cutoff = 1e-4;
    const Ledger beams_a = BeamTracer(a).trace(pmma(), from(7.0, 20.0), {0.5}, policy).ledgers[0];
    const Ledger beams_b = BeamTracer(b).trace(pmma(), from(7.0, 20.0), {0.5}, policy).ledgers[0];
    for (std::size_t k = 0; k < kAccountCount; ++k) EXPECT_NEAR(beams_a.power[k], beams_b.power[k], 1e-4);
    EXPECT_NEAR(beams_a[Account::retroreflected], beams_b[Account::retroreflected], 1e-5);
  }
}

TEST(OutlinePart, SolidsAreClosed) {
  std::mt19937 random(5);
  for (int k = 0; k < test::sample_size(12, 200); ++k) {
    PartSpec spec = with_random_outline(k % 2 == 0 ? prisms() : hexagons(), random, 1.5, k % 3 == 0 ? 0.04 : 0.0);
    const double exact_mm2 = spec.array.outline->area_mm2();
    if (k % 4 == 0) spec.array.partial_elements = PartialElements::omit;
    const Part part = build_part(spec);
    EXPECT_NEAR(part.entrance_area_mm2, exact_mm2, 1e-9);
    const BoundaryReport report = check_boundary(closed_boundary(part));
    EXPECT_TRUE(report.ok()) << k << " " << report.is_closed << report.is_manifold << report.self_intersects;
    EXPECT_NEAR(report.volume_mm3, exact_mm2 * part.thickness_mm + volume_below(part), 1e-6) << k;
    EXPECT_TRUE(check_boundary(mould_boundary(part, 0.5)).ok()) << k;
  }
}

TEST(OutlinePart, ElementsAreCutOrOmitted) {
  PartSpec cut = with_outline(hexagons(0.3), ring_outline(), 0.1);
  PartSpec omit = cut;
  omit.array.partial_elements = PartialElements::omit;
  const Part cut_part = build_part(cut);
  const Part omit_part = build_part(omit);
  EXPECT_EQ(cut_part.elements_full, omit_part.elements_full);
  EXPECT_GT(cut_part.elements_partial, 20);
  const double aperture = area(aperture_outline(cut.element));
  const double facets = aperture * std::sqrt(3.0);
  EXPECT_NEAR(omit_part.retro_facet_area_mm2, static_cast<double>(omit_part.elements_full) * facets, 1e-9);
  const double elements_mm2 = std::numbers::pi * (1.1 * 1.1 - 0.5 * 0.5);
  EXPECT_NEAR(cut_part.retro_facet_area_mm2, elements_mm2 * std::sqrt(3.0), 0.02);
  EXPECT_EQ(static_cast<std::int64_t>(whole_elements(cut.array, cut.element).size()), cut_part.elements_full);
}

/// A large array is stored as several patches. The same outline in one patch has the same numbers.
TEST(OutlinePart, SeveralPatchesAgreeWithOnePatch) {
  std::mt19937 random(9);
  const PartSpec spec = with_random_outline(prisms(0.5), random, 30.0, 0.1);
  const Part part = build_part(spec);
  const Part one = build_welded_part(spec);
  EXPECT_GT(part.placements.size(), 1U);
  EXPECT_EQ(one.placements.size(), 1U);
  EXPECT_EQ(part.elements_full, one.elements_full);
  EXPECT_EQ(part.elements_partial, one.elements_partial);
  EXPECT_NEAR(part.retro_facet_area_mm2, one.retro_facet_area_mm2, 1e-6);
}

TEST(OutlinePart, RaysStartInside) {
  std::mt19937 random(4);
  for (int k = 0; k < 12; ++k) {
    const PartSpec spec = with_random_outline(hexagons(0.2), random, 1.5, 0.0);
    const Part part = build_part(spec);
    const EntranceSampler sampler(part);
    Vec2 sum = Vec2::Zero();
    constexpr int kColumns = 2048;
    constexpr int kRows = 4;
    for (int i = 0; i < kColumns; ++i)
      for (int j = 0; j < kRows; ++j) {
        const Vec2 at = sampler({(i + 0.5) / kColumns, (j + 0.5) / kRows});
        EXPECT_TRUE(std::ranges::any_of(spec.array.outline->whole.pieces, [&](const Polygon& piece) {
          return contains(piece, at + sampler.centre_mm(), 1e-9);
        }));
        sum += at + sampler.centre_mm();
      }
    Vec2 centroid_mm = Vec2::Zero();
    for (const Polygon& piece : spec.array.outline->whole.pieces)
      centroid_mm += area(piece) / spec.array.outline->area_mm2() * centroid(piece);
    EXPECT_LT((sum / (kColumns * kRows) - centroid_mm).norm(), 0.005);
  }
}

TEST(OutlinePart, AgreesWithTheReferenceTracer) {
  const std::vector<TraceCase> cases = {{"oblique", with_outline(prisms(), oblique_outline()), 12.0, 40.0},
                                        {"bent", with_outline(hexagons(), bent_outline()), 20.0, 110.0},
                                        {"bent with margin", with_outline(prisms(), bent_outline(), 0.08), 35.0, 250.0},
                                        {"ring", with_outline(hexagons(), ring_outline()), 28.0, 15.0}};
  for (const TraceCase& c : cases) {
    const Part part = build_part(c.spec);
    const Illumination light = from(c.incidence_deg, c.azimuth_deg);
    const ReferenceResult reference =
        reference_trace(part, c.optics, light, 8.0, test::sample_size<std::uint64_t>(1000, 40000), 7);
    const MonteCarloResult traced = MonteCarlo(part).trace(c.optics, light, {8.0}, rays(1U << 16), {});
    expect_accounts_of(reference, traced.cones[0].ledger, cases.size() * kAccountCount, 3e-4, c.name);
  }
}

TEST(OutlinePart, EnginesAgree) {
  const Outline sharp = oriented({polygon_of_corners({{0, 0}, {1.5, 0}, {2.0, 1.2}, {0.5, 1.2}})});
  const std::vector<NamedPart> parts = {{"parallelogram", with_outline(prisms(), sharp, 0.05)},
                                        {"angle", with_outline(hexagons(), angle_outline())},
                                        {"hole", with_outline(prisms(), holed_outline())}};
  for (const auto& [name, spec] : parts) expect_same_accounts(build_part(spec), from(11.0, 65.0), 1e-4, 2e-3, name);
}

/// Masks and tables of facets use the same whole elements as an array without partial elements.
TEST(OutlinePart, ElementsWithOwnPlanesAreThoseOfTheArray) {
  for (const Outline& outline : {oblique_outline(), bent_outline(), ring_outline()}) {
    PartSpec spec = with_outline(prisms(0.3), outline, 0.05);
    spec.array.arrangement = Arrangement::aligned;
    spec.array.partial_elements = PartialElements::omit;
    const auto& prism = std::get<RtpElement>(spec.element);
    std::vector<ElementPlanes> planes;
    for (const WholeElement& at : whole_elements(spec.array, spec.element)) {
      ElementPlanes& own = planes.emplace_back();
      own.centre_mm = 0.5 * Vec2(spec.array.x_length_mm, spec.array.y_length_mm) + at.centre_mm;
      own.planes = {{-0.5 * prism.base_mm, {-1.0, 0.0}}, {-0.5 * prism.base_mm, {1.0, 0.0}}};
    }
    const Part plain = build_part(spec);
    const Part own = build_part(spec, FacetPlanes(planes, prism.width_mm));
    EXPECT_EQ(own.elements_full, plain.elements_full);
    EXPECT_NEAR(own.retro_facet_area_mm2, plain.retro_facet_area_mm2, 1e-9);
    const Ledger a = MonteCarlo(plain).trace(pmma(), from(7.0, 20.0), {0.5}, rays(1U << 12), {}).cones[0].ledger;
    const Ledger b = MonteCarlo(own).trace(pmma(), from(7.0, 20.0), {0.5}, rays(1U << 12), {}).cones[0].ledger;
    for (std::size_t k = 0; k < kAccountCount; ++k) EXPECT_NEAR(a.power[k], b.power[k], 1e-9);
  }
}

/// No ray leaks through an edge of the border, and the ledger is closed (10^8 segments in a long run).
TEST(OutlinePart, RandomOutlinesLoseNoRay) {
  std::mt19937 random(1);
  constexpr int kOutlines = 200;
  const std::uint64_t segments = test::sample_size<std::uint64_t>(2'000'000, 100'000'000) / kOutlines;
  std::uint64_t misses = 0;
  for (int k = 0; k < kOutlines; ++k) {
    const Part part =
        build_part(with_random_outline(k % 2 == 0 ? prisms() : hexagons(), random, 1.5, k % 3 == 0 ? 0.04 : 0.0));
    const MonteCarlo tracer(part);
    std::uint32_t seed = 0;
    for (std::uint64_t traced = 0; traced < segments;)
      for (const auto& [t, p] : {std::pair{0.0, 0.0}, {35.0, 30.0}, {61.0, 47.3}}) {
        const MonteCarloResult result = tracer.trace(pmma(), from(t, p), {0.5}, rays(1U << 11, ++seed), {});
        traced += result.segments;
        misses += result.misses;
        EXPECT_NEAR(result.cones[0].ledger.total(), 1.0, 1e-9);
        EXPECT_EQ(result.cones[0].ledger[Account::lost], 0.0);
      }
  }
  EXPECT_EQ(misses, 0U);
}

}  // namespace
}  // namespace retrace::testing::outline_part_test
