#include "geometry/part/faceted_solid.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <map>
#include <stdexcept>

#include "geometry/check/boundary_check.h"
#include "geometry/part/mould_boundary.h"
#include "geometry/part/part.h"
#include "geometry/part/welded_part.h"
#include "tests/studies/solids/solid_specs.h"

namespace retrace::geometry::faceted_solid_test {
namespace {

using test::array_part;
using test::single_part;

/// Returns the volume by the divergence theorem, as a sum over faces. It does not depend on the division of faces into
/// triangles.
double volume(const FacetedSolid& solid) {
  double volume = 0.0;
  for (const SolidFace& face : solid.faces) {
    Vec3 twice = Vec3::Zero();
    for (const auto& loop : face.loops)
      for (std::size_t i = 0; i < loop.size(); ++i)
        twice += solid.vertices[loop[i]].cross(solid.vertices[loop[(i + 1) % loop.size()]]);
    volume += twice.dot(solid.vertices[face.loops.front().front()]) / 6.0;
  }
  return volume;
}

/// Expects that each edge belongs to two faces, which run through it in opposite directions, and that all vertices of a
/// face are in its plane.
void expect_sound(const FacetedSolid& solid) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> passed;
  for (const SolidFace& face : solid.faces)
    for (const auto& loop : face.loops) {
      ASSERT_GE(loop.size(), 3U);
      for (std::size_t i = 0; i < loop.size(); ++i) {
        ++passed[{loop[i], loop[(i + 1) % loop.size()]}];
        EXPECT_NEAR(face.normal.dot(solid.vertices[loop[i]] - solid.vertices[loop[0]]), 0.0, 1e-9);
      }
    }
  for (const auto& [edge, times] : passed) {
    EXPECT_EQ(times, 1);
    EXPECT_EQ(passed.count({edge.second, edge.first}), 1U);
  }
}

TEST(FacetedSolid, AnElementHasTheFacesOneCounts) {
  // The faces are the entrance face, four sides (two of which include the triangular ends of the prism), and two
  // facets.
  const BoundaryMesh prism = closed_boundary(build_part(single_part(RtpElement{0.5, 0.4, 90.0})));
  const FacetedSolid solid = faceted_solid(prism);
  EXPECT_EQ(solid.faces.size(), 7U);
  EXPECT_EQ(solid.vertices.size(), 10U);
  expect_sound(solid);
  // The faces are the entrance face, six sides and three square facets.
  const FacetedSolid cube = faceted_solid(closed_boundary(build_part(single_part(HexagonalCube{1.6}))));
  EXPECT_EQ(cube.faces.size(), 10U);
  expect_sound(cube);
}

TEST(FacetedSolid, VolumesAreThoseOfClosedForms) {
  const double t = 0.7;
  EXPECT_NEAR(volume_mm3(closed_boundary(build_part(single_part(RtpElement{0.5, 0.4, 90.0})))),
              0.5 * 0.4 * t + test::prism_volume_mm3(0.5, 0.4), 1e-12);
  EXPECT_NEAR(volume_mm3(closed_boundary(build_part(single_part(HexagonalCube{1.6})))),
              test::hexagon_area_mm2(1.6) * t + test::hexagonal_volume_mm3(1.6), 1e-12);
  EXPECT_NEAR(volume_mm3(closed_boundary(build_part(single_part(TriangularCube{1.6})))),
              test::triangle_area_mm2(1.6) * t + test::triangular_volume_mm3(1.6), 1e-12);
}

TEST(FacetedSolid, MergedFacesEncloseWhatTrianglesDo) {
  for (PartSpec spec : {array_part(RtpElement{0.5, 0.5, 90.0}, Arrangement::offset, 3.0, 3.0),
                        array_part(RtpElement{0.5, 0.5, 90.0}, Arrangement::checker, 3.1, 2.7),
                        array_part(HexagonalCube{1.0}, Arrangement::honeycomb, 5.0, 4.0),
                        array_part(TriangularCube{1.0}, Arrangement::triangular, 5.0, 4.0)}) {
    for (const PartialElements partial : {PartialElements::cut, PartialElements::omit}) {
      spec.array.partial_elements = partial;
      if (std::holds_alternative<RtpElement>(spec.element)) spec.array.x_gap_mm = spec.array.y_gap_mm = 0.04;
      const Part part = build_part(spec);
      for (const BoundaryMesh& mesh : {closed_boundary(part), mould_boundary(part, 0.3)}) {
        ASSERT_TRUE(is_closed_manifold(mesh));
        const FacetedSolid solid = faceted_solid(mesh);
        expect_sound(solid);
        EXPECT_LT(solid.faces.size(), mesh.triangles.size() / 2);
        EXPECT_NEAR(volume(solid), volume_mm3(mesh), 1e-9 * volume_mm3(mesh));
      }
    }
  }
}

TEST(Mould, IsClosedAndFillsWhatThePartLeaves) {
  const double block_mm = 0.3;
  for (PartSpec spec :
       {single_part(RtpElement{0.5, 0.4, 90.0}), single_part(HexagonalCube{1.6}), single_part(TriangularCube{1.6}),
        array_part(RtpElement{0.5, 0.5, 90.0}, Arrangement::offset, 2.0, 2.0),
        array_part(HexagonalCube{1.0}, Arrangement::honeycomb, 3.3, 2.9),
        array_part(TriangularCube{1.0}, Arrangement::triangular, 3.3, 2.9)}) {
    const Part part = build_part(spec);
    const BoundaryMesh mesh = mould_boundary(part, block_mm);
    const BoundaryReport report = check_boundary(mesh);
    EXPECT_TRUE(report.ok());
    // Together, part and mould fill the volume from the bottom of the block to the entrance face.
    const double whole_mm3 = part.entrance_area_mm2 * (part.thickness_mm + part.element_depth_mm + block_mm);
    EXPECT_NEAR(volume_mm3(mesh) + volume_mm3(closed_boundary(part)), whole_mm3, 1e-12 * whole_mm3);
  }
}

TEST(Mould, NeedsABlock) {
  const Part part = build_part(single_part(RtpElement{0.5, 0.4, 90.0}));
  EXPECT_THROW(mould_boundary(part, 0.0), std::logic_error);
}

TEST(FacetedSolid, OpenMeshesAreRefused) {
  BoundaryMesh mesh = closed_boundary(build_part(single_part(RtpElement{0.5, 0.4, 90.0})));
  mesh.triangles.pop_back();
  EXPECT_FALSE(is_closed_manifold(mesh));
  EXPECT_THROW(faceted_solid(mesh), std::logic_error);
}

TEST(WeldedPart, IsOnePatchAndHoldsWhatTheSharedOnesDo) {
  // For more than 2048 elements, build_part() places the same patch several times.
  const PartSpec spec = array_part(RtpElement{0.1, 0.1, 90.0}, Arrangement::aligned, 5.0, 5.0);
  EXPECT_GT(build_part(spec).placements.size(), 1U);
  const Part part = build_welded_part(spec);
  ASSERT_EQ(part.placements.size(), 1U);
  const BoundaryMesh mesh = closed_boundary(part);
  EXPECT_TRUE(is_closed_manifold(mesh));
  EXPECT_NEAR(volume_mm3(mesh), 25.0 * 0.7 + 2500.0 * test::prism_volume_mm3(0.1, 0.1), 1e-9);
}

}  // namespace
}  // namespace retrace::geometry::faceted_solid_test
