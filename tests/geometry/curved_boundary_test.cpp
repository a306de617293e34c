// Tests of closed boundaries of parts with curved entrance faces: they must be closed, their volumes are compared with
// integrals and closed forms, and the distance between triangles and surface is checked.
#include "geometry/entrance/curved_boundary.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "core/error.h"
#include "geometry/check/boundary_check.h"
#include "geometry/entrance/entrance_mesh.h"
#include "geometry/part/faceted_solid.h"
#include "geometry/part/mesh_part.h"
#include "geometry/part/plate.h"
#include "geometry/part/welded_part.h"
#include "tests/geometry/part_checks.h"
#include "tests/support/designs.h"
#include "tests/support/entrance_surfaces.h"

namespace retrace::testing::curved_boundary_test {
namespace {

using namespace geometry;

struct NamedBoundary {
  std::string name;
  Part part;
};

/// Returns a plate, and parts with steps at their borders, with cut elements or with oblique sides.
std::vector<NamedBoundary> parts() {
  std::vector<NamedBoundary> all;
  all.push_back({"bricks", build_welded_part(finite(RtpElement{0.7, 0.5}, Arrangement::offset, 3.1, 2.3, 1.4))});
  all.push_back({"cubes", build_welded_part(finite(HexagonalCube{0.8}, Arrangement::honeycomb, 3.0, 2.6, 1.4))});
  PartSpec opened = finite(TriangularCube{0.9}, Arrangement::triangular, 3.0, 2.6, 1.6);
  opened.angle_errors.dihedral_error_arcmin = {20.0, 20.0, 20.0};
  all.push_back({"triangles", build_welded_part(opened)});
  all.push_back({"hexagon", build_part(single(HexagonalCube{2.0}, 1.4))});
  all.push_back({"plate", build_plate({3.0, 2.0}, 1.4)});
  return all;
}

/// Integrates a function over a convex polygon. The polygon is divided into small triangles, and the midpoint rule is
/// used.
double integral(const Polygon& outline, const std::function<double(const Vec2&)>& f) {
  constexpr int kSteps = 300;
  double sum = 0.0;
  for (std::size_t k = 1; k + 1 < outline.size(); ++k) {
    const Vec2 u = (outline[k] - outline[0]) / kSteps;
    const Vec2 v = (outline[k + 1] - outline[0]) / kSteps;
    const double small_mm2 = 0.5 * std::abs(u.x() * v.y() - u.y() * v.x());
    for (int i = 0; i < kSteps; ++i)
      for (int j = 0; i + j < kSteps; ++j) {
        const Vec2 corner = outline[0] + i * u + j * v;
        sum += small_mm2 * f(corner + (u + v) / 3.0);
        if (i + j + 1 < kSteps) sum += small_mm2 * f(corner + 2.0 * (u + v) / 3.0);
      }
  }
  return sum;
}

BoundaryReport expect_solid(const CurvedBoundary& boundary, const std::string& name) {
  const BoundaryReport report = check_boundary(boundary.mesh);
  EXPECT_TRUE(report.ok()) << name;
  EXPECT_TRUE(is_closed_manifold(boundary.mesh)) << name;
  return report;
}

TEST(CurvedBoundary, SolidsAreClosedWithTheVolumeBelowTheSurface) {
  struct Surface {
    std::string name;
    Entrance entrance;
    double error_mm;
  };
  const std::vector<Surface> surfaces = {{"sphere", sphere_entrance(9.0, 1.6, {1.4, 1.2}), 1e-3},
                                         {"saddle", formula_entrance("1.5 + 0.04 * x * y - 0.02 * x^2"), 1e-4},
                                         {"egg box", egg_box_entrance(1.5, 0.05, 4.0), 2e-3}};
  for (const NamedBoundary& p : parts())
    for (const Surface& s : surfaces) {
      const std::string name = p.name + " behind " + s.name;
      const CurvedBoundary boundary = curved_boundary(p.part, s.entrance, s.error_mm);
      EXPECT_LE(boundary.entrance_error_mm, s.error_mm) << name;
      EXPECT_GT(boundary.entrance_error_mm, 0.0) << name;
      const BoundaryReport report = expect_solid(boundary, name);
      const double above_mm3 = integral(p.part.outline, [&](const Vec2& at) { return height_mm(s.entrance, at); });
      EXPECT_NEAR(report.volume_mm3, above_mm3 + volume_below(p.part),
                  s.error_mm * p.part.entrance_area_mm2 + 1e-5 * above_mm3)
          << name;
    }
}

// The volume below an inclined plane is the area times the height at the centroid. Triangles represent the plane
// exactly.
TEST(CurvedBoundary, InclinedPlanesAreExact) {
  const Entrance wedge = plane_entrance(1.5, 0.08, -0.05);
  for (const NamedBoundary& p : parts()) {
    const CurvedBoundary boundary = curved_boundary(p.part, wedge, 1e-3);
    EXPECT_LT(boundary.entrance_error_mm, 1e-12) << p.name;
    const BoundaryReport report = expect_solid(boundary, p.name);
    const Vec2 middle = centroid(p.part.outline);
    EXPECT_NEAR(report.volume_mm3,
                p.part.entrance_area_mm2 * (1.5 + 0.08 * middle.x() - 0.05 * middle.y()) + volume_below(p.part), 1e-9)
        << p.name;
  }
}

TEST(CurvedBoundary, CornersAreOnTheSurfaceAndTrianglesWithinTheError) {
  const Part part = build_welded_part(finite(HexagonalCube{0.8}, Arrangement::honeycomb, 3.0, 2.6, 1.4));
  const Entrance sphere = sphere_entrance(9.0, 1.6, {1.4, 1.2});
  std::size_t before = 0;
  for (const double error_mm : {1e-2, 1e-3, 1e-4}) {
    const CurvedBoundary boundary = curved_boundary(part, sphere, error_mm);
    std::mt19937 random(1);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    std::size_t triangles = 0;
    for (std::size_t t = 0; t < boundary.mesh.triangles.size(); ++t) {
      if (boundary.mesh.roles[t] != FacetRole::entrance) continue;
      ++triangles;
      const auto& [a, b, c] = boundary.mesh.triangles[t];
      const auto& v = boundary.mesh.vertices;
      for (const std::uint32_t k : {a, b, c}) EXPECT_NEAR(v[k].z(), height_mm(sphere, v[k].head<2>()), 1e-12);
      const double u = std::sqrt(unit(random));
      const double w = unit(random);
      const Vec3 p = (1.0 - u) * v[a] + u * (1.0 - w) * v[b] + u * w * v[c];
      EXPECT_NEAR(p.z(), height_mm(sphere, p.head<2>()), error_mm);
    }
    EXPECT_GT(triangles, before);
    EXPECT_LT(triangles, 1500.0 * std::max(1.0, 1e-3 / error_mm)) << "triangles are not smaller than necessary";
    before = triangles;
  }
}

// The volume below a mesh is the sum over its triangles. The mesh is larger than the part, so that the outline cuts
// triangles.
TEST(CurvedBoundary, MeshesKeepTheirTriangles) {
  const auto surface = std::get<0>(egg_box_entrance(1.5, 0.05, 4.0));
  const TriangleMesh sheet = meshed(*surface, 4.0, 11);
  for (const NamedBoundary& p : parts()) {
    Part part = p.part;
    const double inside = bounding_box(part.outline).lower.minCoeff() < 0.0 ? 1.5 : 0.0;
    const Entrance mesh = std::make_shared<const SurfacePatch>(
        entrance_of_mesh(sheet, MeshSide::top, Vec3(-inside, -inside, 0.0), part.outline));
    const CurvedBoundary boundary = curved_boundary(part, mesh, 1e-3);
    EXPECT_EQ(boundary.entrance_error_mm, 0.0);
    const BoundaryReport report = expect_solid(boundary, p.name);
    const double above_mm3 = integral(part.outline, [&](const Vec2& at) { return height_mm(mesh, at); });
    EXPECT_NEAR(report.volume_mm3, above_mm3 + volume_below(part), 1e-5 * above_mm3) << p.name;
  }
}

// The facets of a part that is read from a mesh have vertices on straight edges, so that some triangles have no area.
TEST(CurvedBoundary, PartsReadFromMeshesAreClosed) {
  const Part bricks = parts().front().part;
  const BoundaryMesh mesh = closed_boundary(bricks);
  const Part part = part_of_mesh({mesh.vertices, mesh.triangles});
  const Entrance wedge = plane_entrance(1.5, 0.08, -0.05);
  const BoundaryMesh boundary = curved_boundary(part, wedge, 1e-3).mesh;
  EXPECT_TRUE(is_closed_manifold(boundary));
  EXPECT_NEAR(volume_mm3(boundary), volume_mm3(curved_boundary(bricks, wedge, 1e-3).mesh), 1e-5);
}

TEST(CurvedBoundary, TouchingTheBackAndTooManyPolygonsAreErrors) {
  const Part part = build_plate({3.0, 2.0}, 1.4);
  EXPECT_THROW(curved_boundary(part, plane_entrance(0.0, 0.1), 1e-3), InputError);
  EXPECT_THROW(curved_boundary(part, sphere_entrance(9.0, 1.6, {1.4, 1.2}), 1e-9), BudgetError);
}

}  // namespace
}  // namespace retrace::testing::curved_boundary_test
