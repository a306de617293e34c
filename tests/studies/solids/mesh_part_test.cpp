#include "geometry/part/mesh_part.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <optional>
#include <set>

#include "geometry/check/boundary_check.h"
#include "geometry/check/mesh_union.h"
#include "geometry/io/stl_file.h"
#include "geometry/part/faceted_solid.h"
#include "geometry/part/plate.h"
#include "tests/studies/solids/solid_specs.h"
#include "tests/support/mesh_variants.h"
#include "tests/support/refusals.h"

namespace retrace::geometry::mesh_part_test {
namespace {

TriangleMesh mesh_of(const PartSpec& spec) {
  return parse_stl(stl_text(closed_boundary(build_part(spec)), "x"), "x.stl");
}

std::string complaint(const std::function<void()>& act) {
  return refusal_of(act);
}

double level(const Part& part, FacetRole role) {
  double area = 0.0;
  for (const PatchFacet& facet : part.patches[0].facets)
    if (facet.role == role) area += facet_area(part.patches[0], facet);
  return area;
}

double box_top(const TriangleMesh& mesh) {
  double top = -INFINITY;
  for (const Vec3& p : mesh.vertices) top = std::max(top, p.z());
  return top;
}

/// An exported part is read as an equal part: areas, depth and roles of faces are the same.
TEST(MeshPart, ExportedPartsComeBack) {
  PartSpec prisms = test::array_part(RtpElement{0.5, 0.5, 90.0}, Arrangement::offset, 3.0, 2.0);
  prisms.array.x_gap_mm = 0.05;
  for (const PartSpec& spec : {prisms, test::single_part(HexagonalCube{1.6}), test::single_part(TriangularCube{1.6}),
                               test::array_part(TriangularCube{1.0}, Arrangement::triangular, 4.0, 3.0)}) {
    const Part direct = build_part(spec);
    const Part part = part_of_mesh(mesh_of(spec));
    EXPECT_NEAR(part.thickness_mm, direct.thickness_mm, 1e-6);
    EXPECT_NEAR(part.element_depth_mm, direct.element_depth_mm, 1e-6);
    EXPECT_NEAR(part.entrance_area_mm2, direct.entrance_area_mm2, 1e-5);
    EXPECT_NEAR(part.retro_facet_area_mm2, direct.retro_facet_area_mm2, 1e-5);
    EXPECT_NEAR(level(part, FacetRole::flat_back), level(direct, FacetRole::flat_back), 1e-5);
    EXPECT_EQ(part.outline.size(), direct.outline.size());
    std::size_t facets = 0;
    for (const PatchCell& cell : part.patches[0].cells) facets += cell.facet_count;
    EXPECT_EQ(facets, part.patches[0].facets.size()) << "every facet is in a cell";
  }
}

/// Returns the number of elements with retroreflecting facets.
std::size_t retro_elements(const Part& part) {
  std::set<std::uint64_t> elements;
  for (const PatchCell& cell : part.patches[0].cells)
    for (std::uint32_t f = cell.first_facet; f < cell.first_facet + cell.facet_count; ++f)
      if (part.patches[0].facets[f].role == FacetRole::retro_facet)
        elements.insert(part.element_id(part.patches[0], cell));
  return elements.size();
}

/// Counts the distinct normals of the retroreflecting facets of each element and returns the sum over all elements.
/// Normals whose facets have a total area below 1e-7 mm^2 are ignored: rounding turns low walls into such small facets.
std::ptrdiff_t retro_planes(const Part& part) {
  std::map<std::array<double, 4>, double> area_of_plane;
  for (const PatchCell& cell : part.patches[0].cells)
    for (std::uint32_t f = cell.first_facet; f < cell.first_facet + cell.facet_count; ++f) {
      const PatchFacet& facet = part.patches[0].facets[f];
      if (facet.role != FacetRole::retro_facet) continue;
      const Vec3 rounded = (1e5 * facet.normal).array().round();
      const auto element = static_cast<double>(part.element_id(part.patches[0], cell));
      area_of_plane[{element, rounded.x(), rounded.y(), rounded.z()}] += facet_area(part.patches[0], facet);
    }
  return std::count_if(area_of_plane.begin(), area_of_plane.end(), [](const auto& p) { return p.second > 1e-7; });
}

void expect_plane_convex_facets(const Part& part, const std::string& name) {
  const SurfacePatch& patch = part.patches[0];
  for (const PatchFacet& facet : patch.facets)
    for (std::uint32_t k = 0; k < facet.corner_count; ++k) {
      const auto corner = [&](std::uint32_t c) -> const Vec3& {
        return patch.vertices[patch.corners[facet.first_corner + c % facet.corner_count]];
      };
      const Vec3 one = corner(k + 1) - corner(k);
      const Vec3 two = corner(k + 2) - corner(k + 1);
      EXPECT_LT(std::abs(facet.normal.dot(corner(k)) - facet.offset_mm), 1e-9 * part.size_mm) << name;
      EXPECT_GE(facet.normal.dot(one.cross(two)), -1e-12 * one.norm() * two.norm()) << name;
    }
}

struct Solid {
  const char* name;
  PartSpec spec;
};

std::vector<Solid> solids() {
  PartSpec cube = test::single_part(HexagonalCube{2.0});
  cube.angle_errors.dihedral_error_arcmin = {1.0, 2.0, 3.0};
  const PartSpec honeycomb = test::array_part(HexagonalCube{1.0}, Arrangement::honeycomb, 3.0, 2.0);
  PartSpec walls = honeycomb;
  walls.angle_errors = cube.angle_errors;
  return {{"cube", cube},
          {"honeycomb", honeycomb},
          {"honeycomb with walls", walls},
          {"triangles", test::array_part(TriangularCube{1.0}, Arrangement::triangular, 4.0, 3.0)},
          {"bricks", test::array_part(RtpElement{0.5, 0.5, 90.0}, Arrangement::offset, 3.0, 2.0)}};
}

/// Facets and elements depend on the solid only, not on the triangles of its mesh.
TEST(MeshPart, FacetsAndElementsDoNotDependOnTheTriangles) {
  for (const Solid& solid : solids()) {
    const Part direct = build_part(solid.spec);
    for (const testing::MeshVariant& variant : testing::variants_of(testing::stl_mesh_of(solid.spec))) {
      const std::string name = std::string(solid.name) + ", " + variant.name;
      const Part meshed = part_of_mesh(variant.mesh);
      EXPECT_EQ(retro_elements(meshed), retro_elements(direct)) << name;
      EXPECT_EQ(retro_planes(meshed), retro_planes(direct)) << name;
      EXPECT_NEAR(meshed.retro_facet_area_mm2, direct.retro_facet_area_mm2, 3e-5) << name;
      expect_plane_convex_facets(meshed, name);
    }
  }
}

/// The flat land around a single prism is a facet with a hole. This facet must be divided into convex polygons.
TEST(MeshPart, FacetsWithHolesAreDivided) {
  PartSpec spec = test::array_part(RtpElement{0.5, 0.5, 90.0}, Arrangement::aligned, 1.5, 1.5);
  spec.array.x_offset_mm = spec.array.y_offset_mm = 0.5;
  for (const testing::MeshVariant& variant : testing::variants_of(testing::stl_mesh_of(spec))) {
    const Part part = part_of_mesh(variant.mesh);
    EXPECT_NEAR(level(part, FacetRole::flat_back), 2.0, 1e-5) << variant.name;
    EXPECT_NEAR(level(part, FacetRole::retro_facet), 0.25 * std::sqrt(2.0), 1e-5) << variant.name;
    EXPECT_EQ(retro_elements(part), 1U);
    EXPECT_LE(part.patches[0].facets.size(), 12U) << variant.name;
    expect_plane_convex_facets(part, variant.name);
  }
}

/// A facet that is slightly curved stays in one element with its neighbours, although the solid is concave at some
/// edges between the triangles of the facet.
TEST(MeshPart, BentFacetsStayInOneElement) {
  TriangleMesh mesh =
      testing::divided_in_four(testing::divided_in_four(mesh_of(test::single_part(HexagonalCube{2.0}))));
  const double top = box_top(mesh);
  for (Vec3& p : mesh.vertices)
    if (p.z() < top) p.z() += 2e-4 * std::sin(7.0 * p.x()) * std::sin(5.0 * p.y());
  const Part part = part_of_mesh(mesh);
  EXPECT_GT(retro_planes(part), 20) << "curved facets have many planes";
  EXPECT_EQ(retro_elements(part), 1U);
}

TEST(MeshPart, HeightsCountFromTheHighestPointOfTheBack) {
  TriangleMesh mesh = mesh_of(test::single_part(RtpElement{0.5, 0.5, 90.0}));
  for (Vec3& p : mesh.vertices) p.z() += 12.0;
  const Part part = part_of_mesh(mesh);
  EXPECT_NEAR(part.thickness_mm, 0.7, 1e-5);
  EXPECT_NEAR(part.element_depth_mm, 0.25, 1e-5);
}

TEST(MeshPart, ShapesThatAreNoPartAreRefused) {
  const TriangleMesh good = mesh_of(test::single_part(RtpElement{0.5, 0.5, 90.0}));
  TriangleMesh leaning = good;
  for (Vec3& p : leaning.vertices) p.z() += 0.1 * p.x();
  EXPECT_EQ(complaint([&] { part_of_mesh(leaning); }), "refused");
  TriangleMesh wide = good;
  for (Vec3& p : wide.vertices)
    if (p.z() < 0.5) p.head<2>() *= 1.2;
  EXPECT_EQ(complaint([&] { part_of_mesh(wide); }), "refused");
  // This mesh is only a tetrahedron and has no plate.
  const TriangleMesh tetrahedron = parse_stl(
      "solid\nfacet normal 0 0 0 outer loop vertex 0 0 0 vertex 1 0 0 vertex 0 1 0 endloop endfacet\n"
      "facet normal 0 0 0 outer loop vertex 1 0 0 vertex 0 0 0 vertex 0.3 0.3 -1 endloop endfacet\n"
      "facet normal 0 0 0 outer loop vertex 0 1 0 vertex 1 0 0 vertex 0.3 0.3 -1 endloop endfacet\n"
      "facet normal 0 0 0 outer loop vertex 0 0 0 vertex 0 1 0 vertex 0.3 0.3 -1 endloop endfacet\nendsolid\n",
      "x.stl");
  EXPECT_EQ(complaint([&] { part_of_mesh(tetrahedron); }), "refused");
}

TEST(MeshPart, OpeningsAreClosedAndCounted) {
  const TriangleMesh whole = mesh_of(test::single_part(HexagonalCube{1.6}));
  const double volume = volume_mm3(boundary_of(whole));
  TriangleMesh open = whole;
  open.triangles.erase(open.triangles.begin());
  EXPECT_FALSE(check_boundary(boundary_of(open)).is_closed);
  const ClosedMesh closed = with_openings_closed(open);
  EXPECT_EQ(closed.openings, 1U);
  EXPECT_EQ(closed.open_edges, 3U);
  EXPECT_TRUE(check_boundary(boundary_of(closed.mesh)).ok());
  EXPECT_NEAR(volume_mm3(boundary_of(closed.mesh)), volume, 1e-9);
  EXPECT_EQ(with_openings_closed(whole).openings, 0U);
}

TEST(MeshPart, TurnedOverTrianglesHaveTheOppositeVolume) {
  const TriangleMesh mesh = mesh_of(test::single_part(HexagonalCube{1.6}));
  EXPECT_NEAR(volume_mm3(boundary_of(with_reversed_orientation(mesh))), -volume_mm3(boundary_of(mesh)), 1e-12);
}

/// Returns a cube that stands on the corner `tip`, with a vertical space diagonal.
TriangleMesh cube_on_its_corner(const Vec3& tip, double edge_mm) {
  TriangleMesh cube = box_mesh({1.0, 1.0}, 1.0);
  Eigen::Matrix3d edges;
  for (Eigen::Index k = 0; k < 3; ++k) {
    const double angle = 2.0 * std::numbers::pi / 3.0 * static_cast<double>(k);
    edges.col(k) =
        Vec3(std::sqrt(2.0 / 3.0) * std::cos(angle), std::sqrt(2.0 / 3.0) * std::sin(angle), std::sqrt(1.0 / 3.0));
  }
  for (Vec3& p : cube.vertices) p = tip + edge_mm * edges * p;
  return cube;
}

TriangleMesh both(TriangleMesh one, const TriangleMesh& other) {
  const auto first = static_cast<std::uint32_t>(one.vertices.size());
  one.vertices.insert(one.vertices.end(), other.vertices.begin(), other.vertices.end());
  for (const auto& [a, b, c] : other.triangles) one.triangles.push_back({first + a, first + b, first + c});
  return one;
}

/// A cube stands on one corner, the tip. The volume of the cube below the height h above the tip is a tetrahedron.
/// Three of its edges have the length a = h sqrt(3), and its volume is a^3 / 6.
TEST(MeshUnion, AddsWhatABodyHasOutsideOfAnother) {
  const TriangleMesh plate = box_mesh({4.0, 4.0}, 2.0);
  const double edge_of_corner = 0.3 * std::sqrt(3.0);
  for (const double edge_mm : {0.8, 1.1}) {
    const TriangleMesh crossing = both(plate, cube_on_its_corner({1.9, 2.2, -0.3}, edge_mm));
    const BoundaryReport report = check_boundary(boundary_of(crossing));
    EXPECT_TRUE(report.self_intersects);
    ASSERT_TRUE(report.crossing_mm);
    EXPECT_LT((*report.crossing_mm - Vec3(1.9, 2.2, 0.0)).norm(), 1.0);
    const std::optional<MeshUnion> all = union_of_bodies(crossing);
    ASSERT_TRUE(all);
    EXPECT_EQ(all->bodies, 2U);
    EXPECT_TRUE(check_boundary(boundary_of(all->mesh)).is_closed);
    EXPECT_NEAR(volume_mm3(boundary_of(all->mesh)), 32.0 + std::pow(edge_of_corner, 3.0) / 6.0, 1e-12);
    const Part part = part_of_mesh(all->mesh);
    EXPECT_EQ(retro_elements(part), 1U);
    EXPECT_EQ(retro_planes(part), 3);
    EXPECT_NEAR(part.retro_facet_area_mm2, 1.5 * edge_of_corner * edge_of_corner, 1e-12);
  }
}

TEST(MeshUnion, HeldBodiesVanishAndBodiesThatCrossThemselvesAreNotUnited) {
  const TriangleMesh plate = box_mesh({4.0, 4.0}, 2.0);
  EXPECT_FALSE(union_of_bodies(plate));
  const std::optional<MeshUnion> held = union_of_bodies(both(plate, cube_on_its_corner({2.0, 2.0, 0.5}, 0.5)));
  ASSERT_TRUE(held);
  EXPECT_NEAR(volume_mm3(boundary_of(held->mesh)), 32.0, 1e-12);
  TriangleMesh twisted = cube_on_its_corner({2.0, 2.0, -0.3}, 0.8);
  std::swap(twisted.vertices[4], twisted.vertices[7]);
  EXPECT_FALSE(union_of_bodies(both(plate, twisted)));
  EXPECT_FALSE(union_of_bodies(both(plate, with_reversed_orientation(cube_on_its_corner({2.0, 2.0, -0.3}, 0.8)))));
}

}  // namespace
}  // namespace retrace::geometry::mesh_part_test
