// Tests of meshes as entrance surfaces. Random sheets without faults are accepted. Holes, overlaps, corners on sides
// and steps are refused with their position, and so are vertical, overhanging and reversed triangles. A mesh with
// faults is also refused if the total area of its triangles equals the area of the outline.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include "geometry/entrance/entrance_mesh.h"
#include "geometry/part/mesh_part.h"
#include "geometry/part/plate.h"
#include "tests/support/refusals.h"

namespace retrace::geometry::front_mesh_test {
namespace {

using Corners = std::array<std::uint32_t, 3>;

/// Mesh of 2 n^2 triangles over the square from (0, 0) to (n, n), where n is the parameter `cells`. Its vertices are
/// displaced at random along x, y and z.
class Sheet {
 public:
  Sheet(std::uint32_t cells, std::mt19937& random) : cells_(cells) {
    std::uniform_real_distribution<double> shift(-0.2, 0.2);
    for (std::uint32_t j = 0; j <= cells; ++j)
      for (std::uint32_t i = 0; i <= cells; ++i) add(Vec3(i + shift(random), j + shift(random), shift(random)));
    for (std::uint32_t j = 0; j < cells; ++j)
      for (std::uint32_t i = 0; i < cells; ++i) {
        const std::uint32_t a = j * (cells + 1) + i;
        mesh.triangles.push_back({a, a + 1, a + cells + 2});
        mesh.triangles.push_back({a, a + cells + 2, a + cells + 1});
      }
    std::shuffle(mesh.triangles.begin(), mesh.triangles.end(), random);
  }

  /// Adds a vertex, rounded to single precision as in mesh files. Returns its index.
  std::uint32_t add(const Vec3& p) {
    mesh.vertices.push_back(p.cast<float>().cast<double>());
    return static_cast<std::uint32_t>(mesh.vertices.size() - 1);
  }
  Vec3 middle(const Corners& t) const {
    return (mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3.0;
  }
  /// Returns the index of a random triangle whose centroid is at least two cells away from the border of the sheet.
  std::size_t inner(std::mt19937& random) const {
    for (;;) {
      const std::size_t k = random() % mesh.triangles.size();
      const Vec3 p = middle(mesh.triangles[k]);
      if (p.head<2>().minCoeff() > 2.0 && p.head<2>().maxCoeff() < cells_ - 2.0) return k;
    }
  }
  TriangleMesh mesh;

 private:
  std::uint32_t cells_;
};

constexpr std::uint32_t kCells = 8;
const Polygon kOutline = to_polygon({Vec2(0.9, 0.8), Vec2(7.1, 7.2)});

/// Determines how a mesh covers an outline. Also expects that entrance_of_mesh() accepts the mesh if and only if it
/// covers every point of the outline one time.
MeshCover cover(const TriangleMesh& mesh, const Polygon& outline = kOutline, MeshSide side = MeshSide::top,
                const Vec3& move_mm = Vec3::Zero()) {
  MeshCover found = cover_of_mesh(mesh, side, move_mm, outline);
  EXPECT_EQ(unrecorded_refusal_of([&] { entrance_of_mesh(mesh, side, move_mm, outline); }),
            found.is_exact() ? "" : "refused");
  if (found.gap) record_message(text_of(found.gap->fault));
  return found;
}

/// Expects that the cover has a gap with one of the given faults.
/// \param near expected position of the gap in the frame of the mesh, in mm
/// \param within_mm maximum distance of the gap from `near`
void expect_gap(const MeshCover& found, const std::set<TilingFault>& faults, const Vec2& near, double within_mm = 2.0) {
  ASSERT_TRUE(found.gap);
  EXPECT_TRUE(faults.contains(found.gap->fault)) << text_of(found.gap->fault);
  EXPECT_LT((found.gap->at_mm - near).norm(), within_mm) << found.gap->at_mm.transpose() << ", " << near.transpose();
}

/// Expects that entrance_of_mesh() refuses a mesh, and records the message.
void expect_refused(const TriangleMesh& mesh, const Polygon& outline, MeshSide side = MeshSide::top,
                    const Vec3& move_mm = Vec3::Zero()) {
  EXPECT_EQ(refusal_of([&] { entrance_of_mesh(mesh, side, move_mm, outline); }), "refused");
}

TEST(EntranceMesh, SheetsAtRandomPass) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  for (int k = 0; k < 200; ++k) {
    const Sheet sheet(kCells, random);
    const Vec3 move(20.0 * uniform(random) - 10.0, uniform(random), 3.0);
    Polygon outline;
    const int corners = 3 + static_cast<int>(random() % 6);
    const double radius = 0.3 + 3.0 * uniform(random);
    const double turn = uniform(random);
    for (int c = 0; c < corners; ++c) {
      const double angle = turn + 2.0 * 3.14159265358979 * c / corners;
      outline.push_back(move.head<2>() + Vec2(4.0, 4.0) + radius * Vec2(std::cos(angle), std::sin(angle)));
    }
    EXPECT_TRUE(cover(sheet.mesh, outline, MeshSide::top, move).is_exact()) << k;
    EXPECT_TRUE(cover(with_reversed_orientation(sheet.mesh), outline, MeshSide::bottom, move).is_exact()) << k;
  }
}

TEST(EntranceMesh, ClosedBodiesPassThoughTheirSidesStandUpright) {
  const Polygon outline = to_polygon({Vec2(0.0, 0.0), Vec2(1.1, 0.7)});
  for (const MeshSide side : {MeshSide::top, MeshSide::bottom})
    EXPECT_TRUE(cover(box_mesh({1.1, 0.7}, 0.5), outline, side).is_exact());
}

TEST(EntranceMesh, HolesAreRefused) {
  std::mt19937 random(2);
  for (int k = 0; k < 50; ++k) {
    Sheet sheet(kCells, random);
    const std::size_t hole = sheet.inner(random);
    const Vec2 place = sheet.middle(sheet.mesh.triangles[hole]).head<2>();
    sheet.mesh.triangles.erase(sheet.mesh.triangles.begin() + static_cast<std::ptrdiff_t>(hole));
    expect_gap(cover(sheet.mesh), {TilingFault::hole}, place);
  }
}

// A hole and an overlap of equal area cancel in the total area. Both must nevertheless be found.
TEST(EntranceMesh, HolesBesideOverlapsOfTheSameAreaAreRefused) {
  std::mt19937 random(3);
  for (int k = 0; k < 50; ++k) {
    Sheet sheet(kCells, random);
    Corners& t = sheet.mesh.triangles[sheet.inner(random)];
    const Vec2 place = sheet.middle(t).head<2>();
    const Vec3 along = sheet.mesh.vertices[t[1]] - sheet.mesh.vertices[t[0]];
    // One corner is moved parallel to the opposite side, which keeps the area of the triangle in plan.
    t[2] = sheet.add(sheet.mesh.vertices[t[2]] + 0.3 * along);
    expect_gap(cover(sheet.mesh), {TilingFault::hole, TilingFault::overlap}, place);
  }
}

TEST(EntranceMesh, TwiceTheSameTriangleBesideAHoleIsRefused) {
  const Polygon square = to_polygon({Vec2(0.0, 0.0), Vec2(2.0, 2.0)});
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  EXPECT_TRUE(cover(mesh, square).is_exact());
  mesh.triangles[1] = mesh.triangles[0];
  const MeshCover twice = cover(mesh, square);
  EXPECT_NEAR(twice.fraction, 1.0, 1e-12);
  expect_gap(twice, {TilingFault::overlap}, {1.0, 1.0}, 1e-3);
  expect_refused(mesh, square);
}

TEST(EntranceMesh, WholeSheetsTwiceAreRefused) {
  const Polygon square = to_polygon({Vec2(0.0, 0.0), Vec2(2.0, 2.0)});
  TriangleMesh mesh;
  mesh.vertices = {{-1, -1, 0}, {3, -1, 0}, {3, 3, 0}, {-1, 3, 0}, {-1, -1, 1}, {3, -1, 1}, {3, 3, 1}, {-1, 3, 1}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}};
  const MeshCover twice = cover(mesh, square);
  EXPECT_FALSE(twice.gap);
  EXPECT_NEAR(twice.fraction, 2.0, 1e-12);
  EXPECT_FALSE(twice.is_exact());
  expect_refused(mesh, square);
}

TEST(EntranceMesh, CornersOnSidesAreRefused) {
  std::mt19937 random(4);
  for (int k = 0; k < 50; ++k) {
    Sheet sheet(kCells, random);
    const std::size_t at = sheet.inner(random);
    const Corners t = sheet.mesh.triangles[at];
    const Vec3 place = 0.5 * (sheet.mesh.vertices[t[0]] + sheet.mesh.vertices[t[1]]);
    const std::uint32_t m = sheet.add(place);
    sheet.mesh.triangles[at] = {t[0], m, t[2]};
    sheet.mesh.triangles.push_back({m, t[1], t[2]});
    expect_gap(cover(sheet.mesh), {TilingFault::corner_on_side}, place.head<2>());
  }
}

TEST(EntranceMesh, TrianglesTurnedOverAreRefused) {
  std::mt19937 random(5);
  for (int k = 0; k < 50; ++k) {
    Sheet sheet(kCells, random);
    Corners& t = sheet.mesh.triangles[sheet.inner(random)];
    std::swap(t[0], t[1]);
    expect_gap(cover(sheet.mesh), {TilingFault::reversed_triangle}, sheet.middle(t).head<2>());
  }
}

/// Returns two horizontal rectangles at the heights 0 and 0.5 mm, which meet at x = 1 mm.
/// \param overhang_mm distance by which the upper rectangle extends over the lower one
/// \param with_wall true if a wall connects the two rectangles
TriangleMesh stepped(double overhang_mm, bool with_wall) {
  TriangleMesh mesh;
  const double upper = 1.0 - overhang_mm;
  mesh.vertices = {{0, 0, 0},       {1, 0, 0},   {1, 2, 0},   {0, 2, 0},
                   {upper, 0, 0.5}, {2, 0, 0.5}, {2, 2, 0.5}, {upper, 2, 0.5}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}};
  if (with_wall) {
    mesh.triangles.push_back({1, 4, 7});
    mesh.triangles.push_back({1, 7, 2});
  }
  return mesh;
}

TEST(EntranceMesh, StepsAreRefused) {
  const Polygon outline = to_polygon({Vec2(0.0, 0.0), Vec2(2.0, 2.0)});
  expect_gap(cover(stepped(0.0, true), outline), {TilingFault::vertical_triangle}, {1.0, 1.0}, 1e-3);
  expect_gap(cover(stepped(0.0, false), outline), {TilingFault::height_jump}, {1.0, 1.0}, 1e-3);
  expect_gap(cover(stepped(0.2, true), outline), {TilingFault::overhang}, {0.9, 1.0}, 0.2);
  EXPECT_TRUE(cover(stepped(-0.2, true), outline).is_exact()) << "a slope";
  // Only the entrance surface is checked. Here the side with the steps is not the entrance surface, because a
  // horizontal lid covers the steps.
  TriangleMesh body = with_reversed_orientation(stepped(0.0, true));
  for (const Vec2& p : outline) body.vertices.emplace_back(p.x(), p.y(), 2.0);
  body.triangles.insert(body.triangles.end(), {{8, 9, 10}, {8, 10, 11}});
  EXPECT_TRUE(cover(body, outline).is_exact());
}

// The position of a gap is given in the frame of the mesh, even if the mesh is moved to the part.
TEST(EntranceMesh, PositionsAreInTheFrameOfTheMesh) {
  const Vec3 move(5.0, -3.0, 1.0);
  const Polygon outline = to_polygon({Vec2(5.0, -3.0), Vec2(7.0, -1.0)});
  expect_gap(cover(stepped(0.0, true), outline, MeshSide::top, move), {TilingFault::vertical_triangle}, {1.0, 1.0},
             1e-3);
  const TriangleMesh body = with_reversed_orientation(stepped(0.0, true));
  const MeshCover below = cover(body, outline, MeshSide::bottom, move);
  expect_gap(below, {TilingFault::vertical_triangle}, {1.0, 1.0}, 1e-3);
  EXPECT_NEAR(below.fraction, 1.0, 1e-12);
  expect_refused(body, outline, MeshSide::bottom, move);
}

TEST(EntranceMesh, TrianglesWithoutAreaAreRefused) {
  const Polygon outline = to_polygon({Vec2(0.0, 0.0), Vec2(2.0, 2.0)});
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}, {1, 1, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 4, 3}, {4, 2, 3}, {0, 2, 4}};
  expect_gap(cover(mesh, outline), {TilingFault::no_area}, {1.0, 1.0}, 1.0);
}

// Triangles outside the outline are not part of the entrance surface, so their faults are ignored.
TEST(EntranceMesh, FaultsOutsideTheOutlineDoNotMatter) {
  std::mt19937 random(6);
  const Polygon outline = to_polygon({Vec2(3.0, 3.0), Vec2(5.0, 5.0)});
  for (int k = 0; k < 50; ++k) {
    Sheet sheet(kCells, random);
    std::erase_if(sheet.mesh.triangles, [&](const Corners& t) {
      const Vec3 p = sheet.middle(t);
      return (p.head<2>() - Vec2(4.0, 4.0)).cwiseAbs().maxCoeff() > 2.5;
    });
    EXPECT_TRUE(cover(sheet.mesh, outline).is_exact()) << k;
  }
}

}  // namespace
}  // namespace retrace::geometry::front_mesh_test
