#include "geometry/part/mesh_part.h"

#include <gtest/gtest.h>

#include <functional>

#include "core/error.h"
#include "geometry/check/boundary_check.h"
#include "geometry/io/stl_file.h"
#include "geometry/part/faceted_solid.h"
#include "tests/studies/solids/solid_specs.h"
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

/// What was exported is the part again: areas, depth, roles.
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
  EXPECT_EQ(complaint([&] { part_of_mesh(leaning); }),
            "the mesh has no entrance face: its highest points must be one level face, towards +z");
  TriangleMesh wide = good;
  for (Vec3& p : wide.vertices)
    if (p.z() < 0.5) p.head<2>() *= 1.2;
  EXPECT_TRUE(complaint([&] { part_of_mesh(wide); }).starts_with("the mesh must lie below its entrance face"));
  // A box: its back is level; and one without a plate.
  const TriangleMesh tetrahedron = parse_stl(
      "solid\nfacet normal 0 0 0 outer loop vertex 0 0 0 vertex 1 0 0 vertex 0 1 0 endloop endfacet\n"
      "facet normal 0 0 0 outer loop vertex 1 0 0 vertex 0 0 0 vertex 0.3 0.3 -1 endloop endfacet\n"
      "facet normal 0 0 0 outer loop vertex 0 1 0 vertex 1 0 0 vertex 0.3 0.3 -1 endloop endfacet\n"
      "facet normal 0 0 0 outer loop vertex 0 0 0 vertex 0 1 0 vertex 0.3 0.3 -1 endloop endfacet\nendsolid\n",
      "x.stl");
  EXPECT_TRUE(complaint([&] { part_of_mesh(tetrahedron); }).starts_with("the mesh must have a plate"));
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
  EXPECT_NEAR(volume_mm3(boundary_of(turned_over(mesh))), -volume_mm3(boundary_of(mesh)), 1e-12);
}

}  // namespace
}  // namespace retrace::geometry::mesh_part_test
