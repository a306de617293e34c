#include "geometry/facet_planes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "core/error.h"
#include "geometry/check/boundary_check.h"
#include "geometry/closed_boundary.h"

// Prisms with planes of their own: nominal ones are the nominal part, turned ones meet where their planes do.

namespace retrace::geometry {
namespace {

constexpr double kArcmin = std::numbers::pi / 180.0 / 60.0;

PartSpec prisms(Arrangement arrangement) {
  PartSpec spec;
  spec.element = RtpElement{0.5, 0.5, 90.0};
  spec.arrangement = arrangement;
  spec.x_length_mm = spec.y_length_mm = 2.0;
  spec.partial_elements = PartialElements::omit;
  spec.thickness_mm = 0.5;
  return spec;
}

/// How the facets of a prism are turned: the root sinks towards one gable, or turns in plan.
enum class Twist { root_sinks, root_turns };

/// The planes of a prism, nominal but for slopes along the root.
ElementPlanes planes_at(const Vec2& centre, bool turned = false, double twist_rad = 0.0,
                        Twist twist = Twist::root_sinks) {
  ElementPlanes element;
  element.centre_mm = centre;
  for (const std::size_t k : {0U, 1U}) {
    const double side = k == 0 ? -1.0 : 1.0;
    Vec2 slope(side, (twist == Twist::root_sinks ? 1.0 : side) * std::tan(twist_rad));
    if (turned) std::swap(slope.x(), slope.y());
    element.planes[k] = {-0.25, slope};
  }
  return element;
}

std::vector<ElementPlanes> checker(double twist_rad = 0.0, Twist twist = Twist::root_sinks) {
  std::vector<ElementPlanes> elements;
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < 4; ++i)
      elements.push_back(planes_at(Vec2(0.25 + 0.5 * i, 0.25 + 0.5 * j), (i + j) % 2 == 1, twist_rad, twist));
  return elements;
}

TEST(FacetPlanes, NominalPlanesAreTheNominalPart) {
  const PartSpec spec = prisms(Arrangement::checker);
  const Part nominal = build_part(spec);
  const Part own = build_part(spec, FacetPlanes(checker(), 0.5));
  EXPECT_EQ(own.elements_full, nominal.elements_full);
  EXPECT_NEAR(own.retro_facet_area_mm2, nominal.retro_facet_area_mm2, 1e-12);
  EXPECT_NEAR(own.element_depth_mm, nominal.element_depth_mm, 1e-12);
  EXPECT_EQ(closed_boundary(own).vertices.size(), closed_boundary(nominal).vertices.size());
}

TEST(FacetPlanes, TurnedFacetsStayClosedAndMeetWhereTheirPlanesDo) {
  for (const double arcmin : {0.5, 5.0, 60.0})
    for (const auto& [radius_mm, twist] : {std::pair{0.0, Twist::root_sinks},
                                           {0.0, Twist::root_turns},
                                           {0.005, Twist::root_sinks},
                                           {0.005, Twist::root_turns}}) {
      PartSpec spec = prisms(Arrangement::checker);
      spec.edges.root_radius_mm = radius_mm;
      spec.edges.chords = 4;
      const Part part = build_part(spec, FacetPlanes(checker(arcmin * kArcmin, twist), 0.5));
      const BoundaryReport report = check_boundary(closed_boundary(part));
      EXPECT_TRUE(report.is_closed) << arcmin << " " << radius_mm;
      if (radius_mm > 0.0) continue;
      // Both planes fall towards a gable, a quarter of a millimetre from the middle; turned in plan, the root stays
      // level.
      const double sinks_mm = twist == Twist::root_sinks ? 0.25 * std::tan(arcmin * kArcmin) : 0.0;
      EXPECT_NEAR(part.element_depth_mm, 0.25 + sinks_mm, 1e-12) << arcmin;
    }
}

TEST(FacetPlanes, OneElementAndMissingOnes) {
  PartSpec single = prisms(Arrangement::single);
  single.x_length_mm = single.y_length_mm = 0.0;
  const Part one = build_part(single, FacetPlanes({planes_at({0.25, 0.25}, false, 3.0 * kArcmin)}, 0.5));
  EXPECT_TRUE(check_boundary(closed_boundary(one)).is_closed);
  EXPECT_GT(one.element_depth_mm, 0.25);

  const PartSpec spec = prisms(Arrangement::aligned);
  std::vector<ElementPlanes> elements;
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < 4; ++i)
      if (i != j) elements.push_back(planes_at({0.25 + 0.5 * i, 0.25 + 0.5 * j}));
  const Part part = build_part(spec, FacetPlanes(elements, 0.5));
  EXPECT_EQ(part.elements_full, 12);
  EXPECT_NEAR(part.retro_facet_area_mm2, 12 * 0.25 * std::numbers::sqrt2, 1e-12);
  EXPECT_TRUE(check_boundary(closed_boundary(part)).is_closed);
}

TEST(FacetPlanes, PlanesOfNoElementAreRefused) {
  const PartSpec spec = prisms(Arrangement::offset);
  EXPECT_THROW(build_part(spec, FacetPlanes({planes_at({0.25, 0.25}), planes_at({5.25, 0.25})}, 0.5)), InputError);
  // Half an element at the border of a shifted row is no whole one.
  EXPECT_THROW(build_part(spec, FacetPlanes({planes_at({0.25, 0.25}), planes_at({0.0, 0.75})}, 0.5)), InputError);
  EXPECT_THROW(FacetPlanes({planes_at({0.25, 0.25}), planes_at({0.25, 0.25})}, 0.5), InputError);
}

}  // namespace
}  // namespace retrace::geometry
