#include "geometry/elements/facet_planes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "core/error.h"
#include "geometry/check/boundary_check.h"
#include "geometry/part/closed_boundary.h"

// Tests of elements with individual facet planes. Nominal planes give the nominal part. Rotated facets meet at the
// intersection of their planes.

namespace retrace::geometry::facet_planes_test {
namespace {

constexpr double kArcmin = std::numbers::pi / 180.0 / 60.0;

PartSpec prisms(Arrangement arrangement) {
  PartSpec spec;
  spec.element = RtpElement{0.5, 0.5, 90.0};
  spec.array.arrangement = arrangement;
  spec.array.x_length_mm = spec.array.y_length_mm = 2.0;
  spec.array.partial_elements = PartialElements::omit;
  spec.thickness_mm = 0.5;
  return spec;
}

/// Rotation of the facets of a prism. `root_sinks`: the root descends towards one gable (end of the prism).
/// `root_turns`: the root is rotated about the vertical.
enum class Twist { root_sinks, root_turns };

/// Returns the planes of a prism. They are nominal except for a slope along the root, whose angle is `twist_rad`.
ElementPlanes planes_at(const Vec2& centre, bool rotated = false, double twist_rad = 0.0,
                        Twist twist = Twist::root_sinks) {
  ElementPlanes element;
  element.centre_mm = centre;
  for (const std::size_t k : {0U, 1U}) {
    const double side = k == 0 ? -1.0 : 1.0;
    Vec2 slope(side, (twist == Twist::root_sinks ? 1.0 : side) * std::tan(twist_rad));
    if (rotated) std::swap(slope.x(), slope.y());
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
      // With `root_sinks`, both planes descend towards a gable, which is 0.25 mm from the centre of the prism. With
      // `root_turns`, the root stays horizontal.
      const double sinks_mm = twist == Twist::root_sinks ? 0.25 * std::tan(arcmin * kArcmin) : 0.0;
      EXPECT_NEAR(part.element_depth_mm, 0.25 + sinks_mm, 1e-12) << arcmin;
    }
}

TEST(FacetPlanes, OneElementAndMissingOnes) {
  PartSpec single = prisms(Arrangement::single);
  single.array.x_length_mm = single.array.y_length_mm = 0.0;
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

PartSpec cubes(const Element& element, Arrangement arrangement) {
  PartSpec spec;
  spec.element = element;
  spec.array.arrangement = arrangement;
  spec.array.x_length_mm = 4.0;
  spec.array.y_length_mm = 4.0;
  spec.array.partial_elements = PartialElements::omit;
  spec.thickness_mm = 0.5;
  return spec;
}

/// Returns the nominal facet planes of a cube corner with its apex at `centre`.
ElementPlanes cube_at(const Element& element, const Vec2& centre, bool rotated = false) {
  ElementPlanes planes;
  planes.centre_mm = centre;
  planes.planes.clear();
  for (const CellFacet& facet : element_cell(element).facets)
    planes.planes.push_back({-element_depth_mm(element), rotated ? Vec2(-facet.plane.slope) : facet.plane.slope});
  return planes;
}

TEST(FacetPlanes, NominalPlanesOfCubeCornersAreTheNominalPart) {
  const Element hexagon = HexagonalCube{1.0, {}};
  const Element triangle = TriangularCube{1.0, {}};
  for (const Element& element : {hexagon, triangle}) {
    const bool is_hexagonal = std::holds_alternative<HexagonalCube>(element);
    const PartSpec spec = cubes(element, is_hexagonal ? Arrangement::honeycomb : Arrangement::triangular);
    // Planes of all cells of the lattice that are completely within the array. The lattice is centred in the array.
    std::vector<ElementPlanes> planes;
    const double row_mm = 0.25 * std::numbers::sqrt3;
    for (int row = -5; row <= 5; ++row)
      for (int column = -4; column <= 4; ++column) {
        if ((row + column) % 2 != 0) continue;
        const Vec2 centre(2.0 + 0.75 * column, 2.0 + row_mm * row);
        const auto add = [&](const Vec2& apex, bool rotated) {
          Polygon outline = element_cell(element).outline;
          for (Vec2& p : outline) p = rotated ? Vec2(apex - p) : Vec2(apex + p);
          const Rectangle box = bounding_box(outline);
          if (box.lower.minCoeff() < 0.0 || box.upper.maxCoeff() > 4.0) return;
          planes.push_back(cube_at(element, apex, rotated));
        };
        add(centre, false);
        if (!is_hexagonal) add(centre - Vec2(0.5, 0.0), true);
      }
    const Part nominal = build_part(spec);
    const Part own = build_part(spec, FacetPlanes(planes, 0.25));
    EXPECT_EQ(own.elements_full, nominal.elements_full);
    EXPECT_NEAR(own.retro_facet_area_mm2, nominal.retro_facet_area_mm2, 1e-10);
    const BoundaryReport report = check_boundary(closed_boundary(own));
    EXPECT_TRUE(report.ok());
    EXPECT_NEAR(report.volume_mm3, check_boundary(closed_boundary(nominal)).volume_mm3, 1e-10);
  }
}

/// A hexagonal cube corner with the edge length a is machined as a triangular cavity. The volume of the cavity is a^3
/// within the hexagon. Outside the hexagon it has six flares with the total volume a^3 / 3.
TEST(FacetPlanes, FlaresOfOneCavityTakeAThirdOfACube) {
  const Element element = HexagonalCube{1.0, {}};
  const PartSpec spec = cubes(element, Arrangement::honeycomb);
  std::vector<ElementPlanes> planes = {cube_at(element, {2.0, 2.0})};
  const auto corner = [](std::size_t k) -> Vec2 {
    const double angle = 2.0 * std::numbers::pi / 3.0 * static_cast<double>(k);
    return 0.5 * Vec2(std::cos(angle), std::sin(angle));
  };
  for (std::size_t k = 0; k < 3; ++k)
    for (const std::size_t other : {(k + 1) % 3, (k + 2) % 3}) {
      ElementPlanes land;
      land.planes.clear();
      land.centre_mm = Vec2(2.0, 2.0) + corner(k) - corner(other);
      HeightPlane plane = planes.front().planes[(other + 1) % 3];
      plane.height_mm += plane.slope.dot(land.centre_mm - Vec2(2.0, 2.0));
      land.flares[other] = plane;
      planes.push_back(land);
    }
  const Part part = build_part(spec, FacetPlanes(planes, 0.25));
  EXPECT_EQ(part.elements_full, 1);
  const BoundaryReport report = check_boundary(closed_boundary(part));
  EXPECT_TRUE(report.ok());
  const double a = std::sqrt(3.0 / 8.0);
  EXPECT_NEAR(report.volume_mm3, 4.0 * 4.0 * 0.5 + a * a * a * 4.0 / 3.0, 1e-9);
  // The area consists of the three square facets of the cube and six flares, each of which has the area of half a
  // square.
  EXPECT_NEAR(part.retro_facet_area_mm2, 3.0 * a * a + 6.0 * 0.5 * a * a, 1e-9);
}

/// A chisel with an edge of 0.2 mm leaves material over an apex. This material consists of a corner of a cube with
/// edges of 0.2 / sqrt(2) mm and of a pyramid above it, whose base is an equilateral triangle with sides of 0.2 mm.
TEST(FacetPlanes, CapsLeaveACoreOverTheApex) {
  const double width = 0.2;
  const double rake = 53.0 * std::numbers::pi / 180.0;
  const double core = 0.5 * std::numbers::sqrt3 * width / (std::numbers::sqrt2 - 1.0 / std::tan(rake));
  for (const Element& element : {Element(HexagonalCube{1.0, {}}), Element(TriangularCube{1.0, {}})}) {
    PartSpec spec;
    spec.element = element;
    spec.array.arrangement = Arrangement::single;
    spec.thickness_mm = 0.5;
    const Vec2 centre = -bounding_box(element_cell(element).outline).lower;
    ElementPlanes planes = cube_at(element, centre);
    for (std::size_t k = 0; k < 3; ++k) {
      // The plane of the cap contains a horizontal line on the facet and a point on the axis. The distance of the line
      // from the apex, up the facet, is half the length of the edge of the chisel. The point is at the height `core`
      // above the apex.
      const double plan = 0.5 * width / std::numbers::sqrt3;
      const double azimuth = std::numbers::pi / 3.0 * (2.0 * static_cast<double>(k) + 1.0);
      const double slope = (std::numbers::sqrt2 * plan - core) / plan;
      planes.caps[k] =
          HeightPlane{core - element_depth_mm(element), slope * Vec2(std::cos(azimuth), std::sin(azimuth))};
    }
    const Part part = build_part(spec, FacetPlanes({planes}, 0.25));
    const BoundaryReport report = check_boundary(closed_boundary(part));
    EXPECT_TRUE(report.ok());
    const double corner = std::pow(width / std::numbers::sqrt2, 3) / 6.0;
    const double pyramid = std::numbers::sqrt3 / 12.0 * width * width * (core - width / std::sqrt(6.0));
    const double whole = check_boundary(closed_boundary(build_part(spec))).volume_mm3;
    EXPECT_NEAR(report.volume_mm3, whole - corner - pyramid, 1e-12);
    EXPECT_NEAR(part.element_depth_mm, element_depth_mm(element) - width / std::sqrt(6.0), 1e-12);
  }
}

TEST(FacetPlanes, PlanesOfNoElementAreRefused) {
  const PartSpec spec = prisms(Arrangement::offset);
  EXPECT_THROW(build_part(spec, FacetPlanes({planes_at({0.25, 0.25}), planes_at({5.25, 0.25})}, 0.5)), InputError);
  // The half element at the border of a shifted row is not a whole element.
  EXPECT_THROW(build_part(spec, FacetPlanes({planes_at({0.25, 0.25}), planes_at({0.0, 0.75})}, 0.5)), InputError);
  EXPECT_THROW(FacetPlanes({planes_at({0.25, 0.25}), planes_at({0.25, 0.25})}, 0.5), InputError);
}

}  // namespace
}  // namespace retrace::geometry::facet_planes_test
