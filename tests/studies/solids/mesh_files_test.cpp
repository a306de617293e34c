#include <gtest/gtest.h>

#include <cstring>
#include <limits>

#include "core/error.h"
#include "geometry/io/obj_file.h"
#include "geometry/io/stl_file.h"
#include "geometry/part/faceted_solid.h"
#include "geometry/part/part.h"
#include "tests/studies/solids/solid_specs.h"
#include "tests/support/refusals.h"

namespace retrace::geometry::mesh_files_test {
namespace {

BoundaryMesh prism() {
  return closed_boundary(build_part(test::single_part(RtpElement{0.5, 0.25, 90.0})));
}

BoundaryMesh as_boundary(const TriangleMesh& mesh) {
  return {mesh.vertices, mesh.triangles, std::vector<FacetRole>(mesh.triangles.size(), FacetRole::retro_facet)};
}

std::string complaint(const std::string& text) {
  return refusal_of([&] { parse_stl(text, "a.stl"); });
}

const std::string kTriangle =
    "solid a b\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   vertex 1 0 0\n   vertex +0 1e0 0\n"
    "  endloop\n endfacet\nendsolid a b\n";

TEST(Stl, WhatIsWrittenIsReadBackClosedWithItsVolume) {
  const BoundaryMesh mesh = prism();
  const std::string text = stl_text(mesh, "prism");
  EXPECT_EQ(text.size(), 84 + 50 * mesh.triangles.size());
  const BoundaryMesh back = as_boundary(parse_stl(text, "a.stl"));
  EXPECT_EQ(back.triangles.size(), mesh.triangles.size());
  EXPECT_TRUE(is_closed_manifold(back));
  // Single precision.
  EXPECT_NEAR(volume_mm3(back), volume_mm3(mesh), 1e-6 * volume_mm3(mesh));
}

TEST(Stl, HeadersNeverPassForAscii) {
  EXPECT_FALSE(stl_text(prism(), "retrace").starts_with("solid"));
  const std::string long_title(200, 'x');
  EXPECT_EQ(stl_text(prism(), long_title).size(), stl_text(prism(), "").size());
}

TEST(Stl, AsciiIsRead) {
  const TriangleMesh mesh = parse_stl(kTriangle, "a.stl");
  ASSERT_EQ(mesh.triangles.size(), 1U);
  EXPECT_EQ(mesh.vertices.size(), 3U);
  EXPECT_EQ(mesh.vertices[2], Vec3(0.0, 1.0, 0.0));
  EXPECT_EQ(parse_stl(kTriangle + kTriangle, "a.stl").vertices.size(), 3U) << "vertices are welded over solids";
}

TEST(Stl, TrianglesWithoutAreaInTheirVerticesAreDropped) {
  std::string text = kTriangle;
  text.insert(text.find("endsolid"),
              "facet normal nan nan nan outer loop vertex 0 0 0 vertex 1 0 0 vertex 1 0 0 endloop endfacet\n");
  EXPECT_EQ(parse_stl(text, "a.stl").triangles.size(), 1U);
}

TEST(Stl, WrongFilesAreRefusedWithTheirLine) {
  EXPECT_EQ(complaint(""), "a.stl:1: not an STL file: must go on with \"solid\", got the end of the file");
  EXPECT_EQ(complaint("hello"), "a.stl:1: not an STL file: must go on with \"solid\", got \"hello\"");
  EXPECT_EQ(complaint("solid\nendsolid\n"), "a.stl: must have at least one triangle, got none");
  std::string wrong = kTriangle;
  wrong.replace(wrong.find("vertex 1"), 8, "vertex x");
  EXPECT_EQ(complaint(wrong), "a.stl:5: not an STL file: must go on with a number, got \"x\"");
  wrong.replace(wrong.find("vertex x"), 8, "vertex 1e9");
  EXPECT_TRUE(complaint(wrong).starts_with("a.stl:6: coordinates must be finite and below 1e6 mm, got 1"))
      << complaint(wrong);
  EXPECT_TRUE(complaint(kTriangle.substr(0, 60)).starts_with("a.stl:5: not an STL file"))
      << complaint(kTriangle.substr(0, 60));
  // A binary file that was cut off is none, and says nothing of use as ASCII.
  const std::string binary = stl_text(prism(), "x");
  EXPECT_NE(complaint(binary.substr(0, binary.size() - 1)), "");
}

TEST(Stl, CoordinatesThatAreNoNumbersAreRefused) {
  std::string binary = stl_text(prism(), "x");
  const float nan = std::numeric_limits<float>::quiet_NaN();
  std::memcpy(binary.data() + 84 + 50 + 12, &nan, sizeof nan);
  EXPECT_EQ(complaint(binary), "a.stl: triangle 2: coordinates must be finite and below 1e6 mm, got nan");
}

TEST(Obj, HoldsEveryVertexAndTriangleByRole) {
  const BoundaryMesh mesh = prism();
  const std::string text = obj_text(mesh, "prism");
  std::size_t vertices = 0;
  std::size_t faces = 0;
  std::size_t groups = 0;
  for (std::size_t at = 0; at < text.size(); at = text.find('\n', at) + 1) {
    vertices += text.compare(at, 2, "v ") == 0;
    faces += text.compare(at, 2, "f ") == 0;
    groups += text.compare(at, 2, "g ") == 0;
  }
  EXPECT_EQ(vertices, mesh.vertices.size());
  EXPECT_EQ(faces, mesh.triangles.size());
  EXPECT_EQ(groups, 4U);  // entrance, facets, gables on the border, sides
  EXPECT_NE(text.find("g facets\n"), std::string::npos);
}

}  // namespace
}  // namespace retrace::geometry::mesh_files_test
