// Tests of facets with a form, a smooth deviation from the plane, traced by rays: positions of the facet frames, slopes
// compared with tilted facets, paraboloids (sinks) compared with closed forms, and ledgers.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "geometry/elements/substrate_checks.h"
#include "raytrace/faces/formed_facet.h"
#include "raytrace/paths/monte_carlo.h"
#include "raytrace/paths/path_tracer.h"
#include "surface_models/scatter/harvey_shack.h"
#include "tests/support/closed_forms.h"
#include "tests/support/designs.h"

namespace retrace::testing::form_test {
namespace {

using namespace geometry;
using namespace raytrace;
using surface_models::FacetForm;

Optics with_form(Optics optics, const FacetForm& form) {
  optics.facet_form = form;
  return optics;
}

FacetForm paraboloid(double depth_mm, double radius_mm) {
  FacetForm form;
  form.add(2, 0, depth_mm / (radius_mm * radius_mm));
  form.add(0, 2, depth_mm / (radius_mm * radius_mm));
  return form;
}

/// Returns a form without symmetries and with large slopes.
FacetForm rough_shape(double slope, double size_mm) {
  FacetForm form;
  form.add(0, 1, 0.3 * slope);
  form.add(1, 1, 0.8 * slope / size_mm);
  form.add(2, 0, -slope / size_mm);
  form.add(0, 3, slope / (size_mm * size_mm));
  return form;
}

std::vector<FacetFrame> frames_of(const SurfacePatch& patch, const PatchCell& cell) {
  std::vector<FacetFrame> frames;
  for (std::uint32_t f = cell.first_facet; f < cell.first_facet + cell.facet_count; ++f) {
    const PatchFacet& facet = patch.facets[f];
    if (!facet.centroid_mm) continue;
    EXPECT_EQ(facet.role, FacetRole::retro_facet);
    frames.emplace_back(facet.normal, facet.offset_mm, *facet.centroid_mm);
    EXPECT_NEAR(facet.normal.dot(frames.back().origin_mm), facet.offset_mm, 1e-12);
    EXPECT_NEAR((frames.back().horizontal.cross(frames.back().down) - facet.normal).norm(), 0.0, 1e-12);
    EXPECT_EQ(frames.back().horizontal.z(), 0.0);
    EXPECT_LT(frames.back().down.z(), 0.0);
  }
  return frames;
}

// Elements are whole, cut, rotated, rounded, canted or on a curved substrate. The distances between the centroids of
// the facets must be those of a single element.
TEST(FormedFacets, MiddlesStayWithTheirElements) {
  const auto finite_of = [](Element element, Arrangement arrangement) {
    return finite(element, arrangement, 3.3, 2.9, 0.8);
  };
  PartSpec rounded = finite_of(RtpElement{0.5, 0.4, 90.0}, Arrangement::offset);
  rounded.edges.root_radius_mm = 0.02;
  PartSpec on_base = finite(RtpElement{0.5, 0.4, 90.0}, Arrangement::aligned, 3.3, 2.9, 2.0);
  on_base.substrate = Substrate{.shape = CylinderSubstrate{.radius_mm = 40.0}, .element_axes = ElementAxes::normal};
  for (const PartSpec& spec :
       {finite_of(RtpElement{0.5, 0.4, 90.0}, Arrangement::offset),
        finite_of(RtpElement{0.5, 0.5, 90.0}, Arrangement::checker),
        finite_of(HexagonalCube{0.6}, Arrangement::honeycomb), finite_of(TriangularCube{0.6}, Arrangement::triangular),
        finite_of(HexagonalCube{0.6, {5.0, 30.0}}, Arrangement::honeycomb), rounded, on_base,
        infinite(HexagonalCube{0.6}, Arrangement::honeycomb, 0.8), single(RtpElement{0.5, 0.4, 90.0}, 0.8)}) {
    const Cell alone = element_cell(spec.element);
    const auto distance = [&](std::size_t a, std::size_t b) {
      const auto at = [&](std::size_t k) {
        const Vec2 p = centroid(alone.facets[k].outline);
        return Vec3(p.x(), p.y(), alone.facets[k].plane.at(p));
      };
      return (at(a) - at(b)).norm();
    };
    const Part part = build_part(spec);
    std::size_t elements = 0;
    for (const SurfacePatch& patch : part.patches)
      for (const PatchCell& cell : patch.cells) {
        const std::vector<FacetFrame> frames = frames_of(patch, cell);
        if (frames.size() != alone.facets.size()) continue;
        ++elements;
        double found = 0.0, expected = 0.0;
        for (std::size_t a = 0; a < frames.size(); ++a)
          for (std::size_t b = a + 1; b < frames.size(); ++b) {
            found += (frames[a].origin_mm - frames[b].origin_mm).norm();
            expected += distance(a, b);
          }
        EXPECT_NEAR(found, expected, 1e-9);
      }
    EXPECT_GE(elements, 1U);
  }
}

struct Exits : ExitObserver {
  std::vector<Vec3> directions;
  void on_exit(const ExitEvent& departure) override {
    if (departure.is_through_entrance() && departure.light.power() > 0.5) directions.push_back(departure.direction);
  }
};

/// Returns the directions in which rays from several points of the entrance face leave, one per ray.
std::vector<Vec3> ways_of(const PartSpec& spec, const Optics& optics, const Illumination& light) {
  const Part part = build_part(spec);
  const Vec2 centre = bounding_box(part.outline).centre();
  const BackSurface back(part, centre);
  const PathSetup setup(part, back, centre, optics, light, {0.5}, {});
  std::vector<Vec3> ways;
  for (const Vec2& entry : {Vec2(0.05, 0.02), Vec2(-0.06, 0.03), Vec2(0.02, -0.09), Vec2(-0.03, -0.05)}) {
    Tally tally(1);
    Exits exits;
    PathWalker(setup, tally, &exits).trace(entry, {1, 2}, 0, 0);
    EXPECT_EQ(exits.directions.size(), 1U);
    ways.insert(ways.end(), exits.directions.begin(), exits.directions.end());
  }
  return ways;
}

// A form with a constant slope down every facet must deviate rays like a tilt of all facets, because the normals are
// the same.
TEST(FormedFacets, SlopeIsTheTiltOfFacets) {
  constexpr double kTiltArcmin = 2.0;
  FacetForm slope;
  slope.add(0, 1, -std::tan(kTiltArcmin / 60.0 * kDeg));
  for (const Element& element : {Element(RtpElement{0.5, 0.4, 90.0}), Element(HexagonalCube{0.5})})
    for (const double incidence_deg : {0.0, 4.0}) {
      PartSpec tilted = single(element, 0.3);
      const std::vector<Vec3> plane = ways_of(tilted, ideal(), from(incidence_deg, 20.0));
      const std::vector<Vec3> formed = ways_of(tilted, with_form(ideal(), slope), from(incidence_deg, 20.0));
      tilted.angle_errors.facet_tilt_arcmin.fill(kTiltArcmin);
      if (std::holds_alternative<RtpElement>(element)) tilted.angle_errors.facet_tilt_arcmin[2] = 0.0;
      const std::vector<Vec3> expected = ways_of(tilted, ideal(), from(incidence_deg, 20.0));
      ASSERT_EQ(formed.size(), expected.size());
      for (std::size_t k = 0; k < formed.size(); ++k) {
        EXPECT_NEAR((formed[k] - expected[k]).norm(), 0.0, 1e-12);
        EXPECT_GT((formed[k] - plane[k]).norm(), 1e-3);
      }
    }
}

// Light along the normal hits both facets of a prism at equal distances from their centroids. A distance x across the
// roof edge corresponds to sqrt(2) x down the facet. The form of both facets lengthens the path by W = P (2 x^2 + y^2),
// and rays leave along the gradient of W. Rays that return within a cone come from an ellipse of the aperture.
TEST(FormedFacets, SinkOfAPrismSpreadsRaysAsItsSlopes) {
  constexpr double kBase = 0.5, kWidth = 0.5, kDepth = 5e-5;
  const double radius2 = kBase * kBase / 8.0 + kWidth * kWidth / 4.0;
  const double p = 4.0 * kPmma * std::sqrt(0.5) * kDepth / radius2;
  const double cone_rad = 4.0 * p * 0.1;  // the cone is reached from an ellipse with the half-axes 0.1 mm and 0.2 mm
  const double share = std::numbers::pi * 0.1 * 0.2 / (0.5 * kBase * kWidth);
  const Part part = build_part(infinite(RtpElement{kBase, kWidth, 90.0}, Arrangement::aligned, 0.5));
  for (const auto engine : {MonteCarlo::Engine::embree, MonteCarlo::Engine::cell})
    for (const double sign : {1.0, -1.0}) {
      const Optics optics = with_form(ideal(), paraboloid(sign * kDepth, std::sqrt(radius2)));
      const double rre = MonteCarlo(part, engine)
                             .trace(optics, from(0.0), {cone_rad / kDeg, 2.5 * cone_rad / kDeg}, rays(1U << 17), {})
                             .cones[0]
                             .rre;
      EXPECT_NEAR(rre, share, 2e-3);
    }
}

void expect_booked(const MonteCarloResult& result, const std::string& name) {
  EXPECT_NEAR(result.cones[0].ledger.total(), 1.0, 1e-9) << name;
  EXPECT_EQ(result.cones[0].ledger[Account::lost], 0.0) << name;
  EXPECT_EQ(result.misses, 0U) << name;
}

TEST(FormedFacets, LedgersCloseAndEnginesAgree) {
  const surface_models::HarveyShack rough({.sq_nm = 30.0, .correlation_length_um = 3.0});
  const FacetForm steep = rough_shape(0.01, 0.25);
  for (const PartSpec& spec : {infinite(RtpElement{0.5, 0.5, 90.0}, Arrangement::offset, 0.5),
                               infinite(HexagonalCube{0.5}, Arrangement::honeycomb, 0.5),
                               finite(HexagonalCube{0.5}, Arrangement::honeycomb, 3.5, 3.0, 0.8)}) {
    const Part part = build_part(spec);
    for (const bool is_rough : {false, true})
      for (const std::pair<double, double>& at : {std::pair{0.0, 0.0}, {42.5, 10.0}, {70.0, 85.0}}) {
        Optics optics = with_form(pmma(), steep);
        if (is_rough) optics.facet_scatter = rough;
        const auto trace = [&](MonteCarlo::Engine engine) {
          const auto result =
              MonteCarlo(part, engine).trace(optics, from(at.first, at.second), {0.5}, rays(1U << 12, 3), {});
          expect_booked(result, std::to_string(at.first));
          return result.cones[0];
        };
        const ConeResult one = trace(MonteCarlo::Engine::embree);
        const ConeResult all = trace(MonteCarlo::Engine::cell);
        EXPECT_NEAR(one.rre, all.rre, 5.0 * std::hypot(one.spread, all.spread) + 1e-6) << at.first << " " << is_rough;
        for (std::size_t k = 0; k < kAccountCount; ++k)
          EXPECT_NEAR(one.ledger.power[k], all.ledger.power[k], 0.02) << kAccountNames[k];
      }
  }
}

// A form whose height is as small as rounding errors has the same effect as plane facets. A form of height 0 is a
// plane.
TEST(FormedFacets, FormGoesToZero) {
  FacetForm none;
  none.add(2, 0, 0.0);
  EXPECT_TRUE(none.is_plane());
  const Part part = build_part(infinite(HexagonalCube{0.5}, Arrangement::honeycomb, 0.5));
  const auto ledger = [&](const FacetForm& form) {
    return MonteCarlo(part, MonteCarlo::Engine::cell)
        .trace(with_form(pmma(), form), from(20.0, 10.0), {0.5}, rays(1U << 13), {})
        .cones[0]
        .ledger;
  };
  const Ledger plane = ledger({});
  const Ledger small = ledger(paraboloid(1e-12, 0.2));
  const Ledger large = ledger(paraboloid(1e-3, 0.2));
  for (std::size_t k = 0; k < kAccountCount; ++k) EXPECT_NEAR(small.power[k], plane.power[k], 1e-9);
  EXPECT_GT(std::abs(large[Account::retroreflected] - plane[Account::retroreflected]), 0.05);
}

}  // namespace
}  // namespace retrace::testing::form_test
