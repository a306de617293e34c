#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/error.h"
#include "geometry/elements/element_cells.h"
#include "geometry/part/part.h"
#include "tests/geometry/part_checks.h"
#include "tests/support/refusals.h"

// Tests of canted cube corners: the axis has the requested inclination and azimuth, and the part is a closed solid.

namespace retrace::geometry::cant_test {
namespace {

constexpr double kDeg = std::numbers::pi / 180.0;

std::vector<Vec3> inward_normals(const Cell& cell) {
  std::vector<Vec3> normals;
  for (const CellFacet& facet : cell.facets)
    normals.push_back(-Vec3(facet.plane.slope.x(), facet.plane.slope.y(), -1.0).normalized());
  return normals;
}

std::vector<Cant> cants() {
  return {{1e-3, 10.0}, {5.0, 0.0}, {12.0, 60.0}, {20.0, -135.0}, {30.0, 0.0}, {30.0, 180.0}, {30.0, 77.0}};
}

// The inward normals of the facets are parallel to the edges of the cube. The axis of the cube has equal angles to all
// three normals.
TEST(Cant, TurnsTheAxisTowardsItsAzimuthAndKeepsTheCubeRight) {
  for (const Cant& cant : cants()) {
    const Vec3 axis(std::sin(cant.deg * kDeg) * std::cos(cant.azimuth_deg * kDeg),
                    std::sin(cant.deg * kDeg) * std::sin(cant.azimuth_deg * kDeg), std::cos(cant.deg * kDeg));
    for (const Cell& cell :
         {hexagonal_cube_cell({1.3, cant}, {}, {0.2, 0.3}), triangular_cube_cell({1.3, cant}, {}, {0.2, 0.3}),
          triangular_cube_cell({1.3, cant}, {}, {0.2, 0.3}, true)}) {
      const std::vector<Vec3> normals = inward_normals(cell);
      const Vec3 expected = cell.rotated ? Vec3(-axis.x(), -axis.y(), axis.z()) : axis;
      for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_NEAR(normals[k].dot(expected), 1.0 / std::numbers::sqrt3, 1e-13);
        EXPECT_NEAR(normals[k].dot(normals[(k + 1) % 3]), 0.0, 1e-13);
      }
    }
  }
}

// The cube rotates as a rigid body about a horizontal line through its apex. It does not rotate about its own axis. No
// facet normal therefore rotates by more than the cant.
TEST(Cant, TurnsTheFacetsByTheShortestWay) {
  const Cant cant{20.0, 35.0};
  const std::vector<Vec3> upright = inward_normals(hexagonal_cube_cell({1.0}, {}, Vec2::Zero()));
  const std::vector<Vec3> canted = inward_normals(hexagonal_cube_cell({1.0, cant}, {}, Vec2::Zero()));
  const Vec3 pivot(-std::sin(35.0 * kDeg), std::cos(35.0 * kDeg), 0.0);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(canted[k].dot(pivot), upright[k].dot(pivot), 1e-14);
    EXPECT_LE(std::acos(std::clamp(canted[k].dot(upright[k]), -1.0, 1.0)), 20.0 * kDeg + 1e-9);
  }
}

TEST(Cant, ApexStaysInPlace) {
  for (const Cant& cant : cants())
    for (const Element& element : {Element(HexagonalCube{1.3, cant}), Element(TriangularCube{1.3, cant})})
      for (const CellFacet& facet : element_cell(element).facets)
        EXPECT_NEAR(facet.plane.at(Vec2::Zero()), -element_depth_mm(element), 1e-14);
}

// The facets cover the outline without gaps or overlaps. At each point, the surface is the highest of the three planes,
// so there are no steps between facets.
TEST(Cant, FacetsFillTheOutlineAndMeetWithoutSteps) {
  for (const Cant& cant : cants())
    for (const Element& element : {Element(HexagonalCube{1.3, cant}), Element(TriangularCube{1.3, cant})}) {
      const Cell cell = element_cell(element);
      double filled = 0.0;
      for (const CellFacet& facet : cell.facets) {
        filled += area(facet.outline);
        for (const Vec2& p : facet.outline)
          for (const CellFacet& other : cell.facets) EXPECT_GE(facet.plane.at(p), other.plane.at(p) - 1e-12);
      }
      EXPECT_NEAR(filled, area(cell.outline), 1e-12);
    }
}

TEST(Cant, TopIsTheHighestRimOfThePart) {
  for (const Cant& cant : cants()) {
    PartSpec spec;
    spec.element = TriangularCube{1.0, cant};
    spec.array.arrangement = Arrangement::single;
    spec.thickness_mm = 10.0;
    EXPECT_NEAR(build_part(spec).top_mm, element_top_mm(spec.element, {}), 1e-9) << cant.deg;
    EXPECT_GT(element_top_mm(spec.element, {}), 0.0);
  }
}

// build_part() itself makes this check, so that it also applies to parts that are not read from a design file.
TEST(Cant, RimsMayNotReachTheEntranceFace) {
  PartSpec spec;
  spec.element = HexagonalCube{1.0, {20.0, 35.0}};
  const double top_mm = element_top_mm(spec.element, {});
  for (const Extent extent : {Extent::finite, Extent::infinite}) {
    spec.array.arrangement = Arrangement::honeycomb;
    spec.array.extent = extent;
    spec.array.x_length_mm = spec.array.y_length_mm = 3.0;
    for (const double thickness_mm : {1e-3, 0.5 * top_mm, top_mm}) {
      spec.thickness_mm = thickness_mm;
      try {
        build_part(spec);
        ADD_FAILURE() << thickness_mm;
      } catch (const InputError& error) {
        EXPECT_EQ(recorded_place_of(error), "refused");
      }
    }
    spec.thickness_mm = 1.0001 * top_mm;
    EXPECT_NEAR(build_part(spec).top_mm, top_mm, 1e-12);
  }
}

TEST(Cant, SteepestFacet) {
  const double upright = std::atan(std::numbers::sqrt2) / kDeg;
  EXPECT_NEAR(steepest_facet_deg(HexagonalCube{1.0, {30.0, 0.0}}, {}), upright + 30.0, 1e-12);
  EXPECT_NEAR(steepest_facet_deg(HexagonalCube{1.0, {0.0, 0.0}}, {}), upright, 1e-12);
}

TEST(Cant, PartsAreSolids) {
  for (const Cant& cant : cants()) {
    PartSpec spec;
    spec.thickness_mm = 10.0;
    spec.array.arrangement = Arrangement::single;
    for (const Element& element : {Element(HexagonalCube{1.0, cant}), Element(TriangularCube{1.0, cant})}) {
      spec.element = element;
      expect_valid(spec);
    }
    spec.element = HexagonalCube{1.0, cant};
    spec.array.arrangement = Arrangement::honeycomb;
    spec.array.x_length_mm = 2.3;
    spec.array.y_length_mm = 2.1;
    expect_valid(spec);
    spec.array.partial_elements = PartialElements::omit;
    expect_valid(spec);
  }
}

// Six cells meet at a point, and their heights at this point may alternate between high and low. The part then touches
// itself along the vertical line through the point, so only closedness is tested.
TEST(Cant, TriangularArraysAreClosed) {
  for (const Cant& cant : cants()) {
    PartSpec spec;
    spec.thickness_mm = 10.0;
    spec.element = TriangularCube{1.0, cant};
    spec.array.arrangement = Arrangement::triangular;
    spec.array.x_length_mm = 2.3;
    spec.array.y_length_mm = 2.1;
    const Part part = build_part(spec);
    const BoundaryReport report = check_boundary(closed_boundary(part));
    EXPECT_TRUE(report.is_closed) << cant.deg << " " << cant.azimuth_deg;
  }
}

}  // namespace
}  // namespace retrace::geometry::cant_test
