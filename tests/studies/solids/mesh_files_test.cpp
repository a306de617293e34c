#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <cctype>
#include <cmath>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/error.h"
#include "geometry/io/face_groups.h"
#include "geometry/io/gltf_file.h"
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
  // The file stores coordinates in single precision.
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
  // The message shows no content of a file that does not begin like an STL file.
  for (const std::string text : {"", "hello", "root:x:0:0:root:/root:/bin/bash\n"}) EXPECT_EQ(complaint(text), "a.stl");
  EXPECT_EQ(complaint("solid\nendsolid\n"), "a.stl");
  std::string wrong = kTriangle;
  wrong.replace(wrong.find("vertex 1"), 8, "vertex x");
  EXPECT_EQ(complaint(wrong), "a.stl:5");
  wrong.replace(wrong.find("vertex x"), 8, "vertex 1e9");
  EXPECT_EQ(complaint(wrong), "a.stl:6");
  EXPECT_EQ(complaint(kTriangle.substr(0, 60)), "a.stl:5");
}

/// A file is recognized as binary whatever its header contains. Messages give the actual and the required length.
TEST(Stl, BinaryFilesOfAWrongLengthAreRefusedAsBinary) {
  for (const std::string title : {"x", "solid", "solid facet normal", "SOLID x"}) {
    const std::string binary = stl_text(prism(), title);
    const std::size_t triangles = prism().triangles.size();
    EXPECT_EQ(parse_stl(binary, "a.stl").triangles.size(), triangles) << title;
    for (const std::size_t more : {1U, 2U, 50U, 1000U})
      for (const char byte : {'\0', '\n', 'x'}) EXPECT_EQ(complaint(binary + std::string(more, byte)), "a.stl");
    for (const std::size_t length : {binary.size() - 1, binary.size() - 50, std::size_t{84}})
      EXPECT_EQ(complaint(binary.substr(0, length)), "a.stl");
  }
  EXPECT_EQ(complaint(std::string("\x89PNG\0", 5)), "a.stl");
}

TEST(Stl, WordsMayHaveCapitals) {
  std::string upper = kTriangle;
  for (char& c : upper) c = static_cast<char>(std::toupper(c));
  EXPECT_EQ(parse_stl(upper, "a.stl").vertices, parse_stl(kTriangle, "a.stl").vertices);
  EXPECT_EQ(parse_stl("\xef\xbb\xbf" + kTriangle, "a.stl").vertices, parse_stl(kTriangle, "a.stl").vertices);
}

/// A scale multiplies every coordinate: a file in metres with a scale of 1000 is the file in mm.
TEST(Stl, ScaleConvertsTheUnit) {
  const BoundaryMesh mesh = prism();
  const TriangleMesh in_mm = parse_stl(stl_text(mesh, "x"), "a.stl");
  for (const double scale : {1024.0, 1.0 / 1024.0}) {
    BoundaryMesh other = mesh;
    for (Vec3& p : other.vertices) p /= scale;
    const TriangleMesh scaled = parse_stl(stl_text(other, "x"), "a.stl", scale);
    EXPECT_EQ(scaled.vertices, in_mm.vertices) << "powers of two are exact";
    EXPECT_EQ(scaled.triangles, in_mm.triangles);
  }
}

TEST(Stl, CoordinatesThatAreNoNumbersAreRefused) {
  std::string binary = stl_text(prism(), "x");
  const float nan = std::numeric_limits<float>::quiet_NaN();
  std::memcpy(binary.data() + 84 + 50 + 12, &nan, sizeof nan);
  EXPECT_EQ(complaint(binary), "a.stl");
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
  EXPECT_EQ(groups, 4U);  // entrance face, facets, end walls on the border, sides
  EXPECT_NE(text.find("g facets\n"), std::string::npos);
}

/// A glTF file, divided into its two chunks. This code is independent of the writer.
struct Glb {
  nlohmann::json head;
  std::string binary;

  std::uint32_t word(std::size_t at) const {
    std::uint32_t value = 0;
    std::memcpy(&value, binary.data() + at, sizeof value);
    return value;
  }
  float number(std::size_t at) const { return std::bit_cast<float>(word(at)); }
};

Glb read_glb(const std::string& text) {
  Glb glb;
  glb.binary = text;
  EXPECT_EQ(text.substr(0, 4), "glTF");
  EXPECT_EQ(glb.word(4), 2U);
  EXPECT_EQ(glb.word(8), text.size());
  const std::uint32_t head = glb.word(12);
  EXPECT_EQ(text.substr(16, 4), "JSON");
  EXPECT_EQ(head % 4, 0U);
  EXPECT_EQ(glb.word(20 + head), text.size() - 28 - head);
  EXPECT_EQ(text.substr(24 + head, 4), std::string("BIN\0", 4));
  glb.head = nlohmann::json::parse(text.substr(20, head));
  glb.binary = text.substr(28 + head);
  return glb;
}

TEST(Gltf, HoldsEveryVertexAndTriangleByRole) {
  const BoundaryMesh mesh = prism();
  const Glb glb = read_glb(gltf_text(mesh, "prism", 1.49, 0.0));
  const auto& accessors = glb.head["accessors"];
  const auto begin_of = [&](const nlohmann::json& accessor) {
    return glb.head["bufferViews"][accessor["bufferView"].get<std::size_t>()]["byteOffset"].get<std::size_t>();
  };
  ASSERT_EQ(accessors[0]["count"], mesh.vertices.size());
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const float value = glb.number(begin_of(accessors[0]) + 12 * v + 4 * axis);
      EXPECT_EQ(value, static_cast<float>(mesh.vertices[v][static_cast<Eigen::Index>(axis)]));
      EXPECT_GE(value, accessors[0]["min"][axis].get<float>());
      EXPECT_LE(value, accessors[0]["max"][axis].get<float>());
    }
  // Every triangle is in the mesh with the name of its role, in the original order.
  std::size_t triangles = 0;
  for (const auto& [role, name] : kFaceGroups) {
    std::vector<std::uint32_t> expected;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      if (mesh.roles[t] == role) expected.insert(expected.end(), mesh.triangles[t].begin(), mesh.triangles[t].end());
    triangles += expected.size() / 3;
    const auto node = std::find_if(glb.head["nodes"].begin(), glb.head["nodes"].end(),
                                   [&name = name](const auto& one) { return one["name"] == name; });
    ASSERT_EQ(node != glb.head["nodes"].end(), !expected.empty()) << name;
    if (expected.empty()) continue;
    const auto& primitive = glb.head["meshes"][(*node)["mesh"].get<std::size_t>()]["primitives"][0];
    const auto& indices = accessors[primitive["indices"].get<std::size_t>()];
    ASSERT_EQ(indices["count"], expected.size()) << name;
    for (std::size_t k = 0; k < expected.size(); ++k) EXPECT_EQ(glb.word(begin_of(indices) + 4 * k), expected[k]);
  }
  EXPECT_EQ(triangles, mesh.triangles.size());
  EXPECT_EQ(glb.head["buffers"][0]["byteLength"], glb.binary.size());
}

TEST(Gltf, TurnsZUpAndMillimetresToMetres) {
  const auto part = read_glb(gltf_text(prism(), "prism", 1.49, 0.0)).head["nodes"][0];
  const Eigen::Quaterniond turn(part["rotation"][3].get<double>(), part["rotation"][0].get<double>(),
                                part["rotation"][1].get<double>(), part["rotation"][2].get<double>());
  EXPECT_LT((turn * Vec3::UnitZ() - Vec3::UnitY()).norm(), 1e-12);
  EXPECT_LT((turn * Vec3::UnitX() - Vec3::UnitX()).norm(), 1e-12);
  EXPECT_EQ(part["scale"], (std::vector<double>{1e-3, 1e-3, 1e-3}));
}

TEST(Gltf, TellsWhatTheSolidIsOf) {
  const auto clear = read_glb(gltf_text(prism(), "prism", 1.49, 0.02)).head["materials"][0]["extensions"];
  EXPECT_EQ(clear["KHR_materials_ior"]["ior"], 1.49);
  // Beer's law over 7 mm, computed with the numbers of the file.
  const auto& volume = clear["KHR_materials_volume"];
  EXPECT_NEAR(std::pow(volume["attenuationColor"][0].get<double>(), 7e-3 / volume["attenuationDistance"].get<double>()),
              std::exp(-7 * 0.02), 1e-12);
  const auto metal = read_glb(gltf_text(prism(), "prism", std::nullopt, 0.0)).head;
  EXPECT_FALSE(metal.contains("extensionsUsed"));
  EXPECT_EQ(metal["materials"][0]["pbrMetallicRoughness"]["metallicFactor"], 1.0);
}

}  // namespace
}  // namespace retrace::geometry::mesh_files_test
