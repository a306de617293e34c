#include <gtest/gtest.h>

#include <sstream>
#include <string>
#include <vector>

#include "core/error.h"
#include "geometry/io/mesh_file.h"
#include "geometry/io/obj_file.h"
#include "geometry/part/faceted_solid.h"
#include "geometry/part/mesh_part.h"
#include "tests/app/program.h"
#include "tests/support/refusals.h"

// Tests of meshes as CAD programs write them: OBJ files, rotated files, gaps between vertices and trailing bytes.

namespace retrace::test::mesh_keys_test {
namespace {

using geometry::TriangleMesh;

const std::string kPrisms =
    "[element]\nkind = \"rtp\"\nbase_mm = 0.5\nwidth_mm = 0.5\n[array]\narrangement = \"aligned\"\nx_length_mm = 1\n"
    "y_length_mm = 1\n[body]\nthickness_mm = 1\nrefractive_index = 1.4917\n";

std::string mesh_design(const std::string& file, const std::string& keys = {}) {
  return "[part]\nmesh = \"" + file + "\"\n" + keys + "[body]\nrefractive_index = 1.4917\n";
}

double rre_of(const TemporaryFolder& folder, const std::string& design, std::size_t warnings = 0) {
  const Outcome outcome =
      retrace(folder, {"rre", design, "--engine", "exact", "--cutoff", "1e-8", "--incidence=10", "--json", "r.json"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(warnings_of(outcome).size(), warnings) << outcome.err;
  return folder.json("r.json").at("points").at(0).at("rre");
}

/// Returns an OBJ text in which (x, y, z) of each vertex is replaced by (x, -z, y): the part then lies on its side.
std::string on_its_side(const std::string& obj) {
  std::stringstream lines(obj);
  std::string text;
  for (std::string line; std::getline(lines, line);) {
    double x = 0.0, y = 0.0, z = 0.0;
    if (line.starts_with("v ") && std::sscanf(line.c_str(), "v %lf %lf %lf", &x, &y, &z) == 3) {
      char moved[128];
      std::snprintf(moved, sizeof moved, "v %.17g %.17g %.17g", x, -z, y);
      line = moved;
    }
    text += line + "\n";
  }
  return text;
}

TEST(MeshKeys, ObjFilesAndRotationsGiveTheDesign) {
  const TemporaryFolder folder;
  folder.write("direct.toml", kPrisms);
  ASSERT_EQ(retrace(folder, {"export", "direct.toml", "part.obj", "--quiet"}).code, 0);
  const double expected = rre_of(folder, "direct.toml");
  folder.write("d.toml", mesh_design("part.obj"));
  EXPECT_NEAR(rre_of(folder, "d.toml"), expected, 1e-6);
  folder.write("side.obj", on_its_side(folder.read("part.obj")));
  folder.write("d.toml", mesh_design("side.obj", "rotate_deg = [-90, 0, 0]\n"));
  EXPECT_NEAR(rre_of(folder, "d.toml"), expected, 1e-6);
  // The entrance face points to -z after a rotation in the opposite direction.
  folder.write("d.toml", mesh_design("side.obj", "rotate_deg = [90, 0, 0]\nfacing = \"down\"\n"));
  EXPECT_NEAR(rre_of(folder, "d.toml"), expected, 1e-6);
}

TEST(MeshKeys, BytesBehindTheTrianglesGiveAWarning) {
  const TemporaryFolder folder;
  folder.write("direct.toml", kPrisms);
  folder.write("d.toml", mesh_design("part.stl"));
  ASSERT_EQ(retrace(folder, {"export", "direct.toml", "part.stl", "--quiet"}).code, 0);
  const double expected = rre_of(folder, "d.toml");
  folder.write("part.stl", folder.read("part.stl") + "colours of the CAD program");
  EXPECT_EQ(rre_of(folder, "d.toml", 1), expected);
}

/// Box with a gap: the vertices of one face are moved.
TEST(MeshKeys, VerticesAreWelded) {
  const TemporaryFolder folder;
  folder.write("part.obj",
               "v 0 0 0\nv 4 0 0\nv 4 3 0\nv 0 3 0\nv 0 0 2\nv 4 0 2\nv 4 3 2\nv 0 3 2\n"
               "v 0.00002 0 2\nv 4 0.00002 2\nv 4 3 2.00002\nv 0 3 1.99998\n"
               "f 4 3 2 1\nf 9 10 11 12\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n");
  folder.write("d.toml", mesh_design("part.obj"));
  EXPECT_EQ(refused_at(retrace(folder, {"rre", "d.toml", "-o", "out"})), "d.toml:2: part.mesh");
  folder.write("d.toml", mesh_design("part.obj", "weld_mm = 0.0001\n"));
  EXPECT_NEAR(retrace_json(folder, {"export", "d.toml"}).at("volume_mm3").get<double>(), 24.0, 1e-3);
}

TEST(MeshKeys, WrongKeysAreRefused) {
  const TemporaryFolder folder;
  folder.write("part.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const auto refused = [&](const std::string& keys, const std::string& place) {
    folder.write("d.toml", mesh_design("part.obj", keys));
    EXPECT_EQ(refused_at(retrace(folder, {"rre", "d.toml", "-o", "out"})), place) << keys;
  };
  refused("", "d.toml:2: part.mesh");
  refused("weld_mm = -1\n", "d.toml:3: part.weld_mm");
  refused("weld_mm = 2\n", "d.toml:3: part.weld_mm");
  refused("chord_mm = 0.1\n", "d.toml:3: part.chord_mm");
  refused("facing = \"top\"\n", "d.toml:3: part.facing");
  refused("rotate_deg = [0, 0, 400]\n", "d.toml:3: part.rotate_deg");
}

double volume_of(const std::string& obj) {
  return geometry::volume_mm3(geometry::boundary_of(geometry::welded(geometry::parse_obj(obj, "a.obj"), 0.0)));
}

/// A prism over an L-shaped polygon of area 3 and height 2, with negative numbers, texture coordinates, a continued
/// line and duplicate vertices.
TEST(ObjFile, ConcavePolygonsAreDivided) {
  const std::string base = "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\n";
  const std::string top = "v 0 0 2\nv 2 0 2\nv 2 1 2\nv 1 1 2\nv 1 2 2\nv 0 2 2\n";
  const std::string sides =
      "f 1/1/1 2/1/1 8/1/1 7/1/1\nf 2 3 9 8\nf 3 4 10 9\nf 4 5 11 10\nf 5 6 \\\n 12 11\nf -7 -12 -6 -1 # last side\n";
  const std::string text = "# L\nmtllib a.mtl\no L\n" + base + top + "vn 0 0 1\ng back\nusemtl b\nf 6 5 4 3 2 1\n" +
                           "s off\nf 7//1 8//1 9//1 10//1 11//1 12//1\n" + sides;
  EXPECT_NEAR(volume_of(text), 6.0, 1e-14);
  EXPECT_TRUE(
      geometry::is_closed_manifold(geometry::boundary_of(geometry::welded(geometry::parse_obj(text, "a.obj"), 0.0))));
}

TEST(ObjFile, FaultsAreNamedWithTheirLine) {
  const auto refused = [](const std::string& text) { return refusal_of([&] { geometry::parse_obj(text, "a.obj"); }); };
  const std::string three = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  expect_refusals(refused, {{"", "a.obj"},
                            {"hello\n", "a.obj:1"},
                            {"v 1 2\n", "a.obj:1"},
                            {"v 1 2 x\n", "a.obj:1"},
                            {"v 1 2 1e9\n", "a.obj:1"},
                            {"v 1 2 nan\n", "a.obj:1"},
                            {three, "a.obj"},
                            {three + "f 1 2\n", "a.obj:4"},
                            {three + "f 1 2 4\n", "a.obj:4"},
                            {three + "f 0 1 2\n", "a.obj:4"},
                            {three + "f 1 2 -4\n", "a.obj:4"},
                            {three + "f 1 2 b\n", "a.obj:4"},
                            {three + "curv 0 1 1 2 3\n", "a.obj:4"}});
}

TEST(Welding, MergesVerticesWithinTheTolerance) {
  // Two triangles whose common edge has a gap of 0.01.
  const TriangleMesh gap{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1.01, 0, 0}, {1, 1, 0}, {0, 1.01, 0}},
                         {{0, 1, 2}, {3, 4, 5}}};
  EXPECT_EQ(geometry::welded(gap, 0.0).vertices.size(), 6U);
  EXPECT_EQ(geometry::welded(gap, 0.009).vertices.size(), 6U);
  EXPECT_EQ(geometry::welded(gap, 0.011).vertices.size(), 4U);
  EXPECT_EQ(geometry::welded(gap, 0.011).triangles.size(), 2U);
  EXPECT_TRUE(geometry::welded(gap, 2.0).triangles.empty());
}

}  // namespace
}  // namespace retrace::test::mesh_keys_test
