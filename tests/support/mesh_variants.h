#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <utility>
#include <vector>

#include "geometry/io/stl_file.h"
#include "geometry/part/closed_boundary.h"
#include "geometry/part/triangle_mesh.h"

// Meshes that represent the same solid by different triangles.

namespace retrace::testing {

/// Returns the mesh of a part, in single precision as its STL file stores it.
inline geometry::TriangleMesh stl_mesh_of(const geometry::PartSpec& spec) {
  return geometry::parse_stl(geometry::stl_text(geometry::closed_boundary(geometry::build_part(spec)), "x"), "x.stl");
}

inline geometry::Vec3 in_single_precision(const geometry::Vec3& p) {
  return p.cast<float>().cast<double>();
}

/// Divides each triangle into four at the midpoints of its sides.
inline geometry::TriangleMesh divided_in_four(const geometry::TriangleMesh& mesh) {
  geometry::TriangleMesh finer;
  finer.vertices = mesh.vertices;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
  const auto middle = [&](std::uint32_t a, std::uint32_t b) {
    const auto [it, is_new] = middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(finer.vertices.size()));
    if (is_new) finer.vertices.push_back(in_single_precision(0.5 * (mesh.vertices[a] + mesh.vertices[b])));
    return it->second;
  };
  for (const auto& [a, b, c] : mesh.triangles) {
    const std::uint32_t ab = middle(a, b);
    const std::uint32_t bc = middle(b, c);
    const std::uint32_t ca = middle(c, a);
    for (const std::array<std::uint32_t, 3>& t :
         {std::array{a, ab, ca}, std::array{ab, b, bc}, std::array{ca, bc, c}, std::array{ab, bc, ca}})
      finer.triangles.push_back(t);
  }
  return finer;
}

/// Swaps the diagonal of each pair of triangles that form a convex quadrilateral in one plane.
inline geometry::TriangleMesh with_other_diagonals(geometry::TriangleMesh mesh) {
  const auto twice_area = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    return geometry::Vec3((mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]));
  };
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::pair<std::size_t, std::uint32_t>> left_of;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto& triangle = mesh.triangles[t];
      left_of[{triangle[k], triangle[(k + 1) % 3]}] = {t, triangle[(k + 2) % 3]};
    }
  std::vector<bool> is_done(mesh.triangles.size());
  for (const auto& [edge, own] : left_of) {
    const auto [a, b] = edge;
    const auto [t, c] = own;
    const auto [other, d] = left_of.at({b, a});
    if (is_done[t] || is_done[other]) continue;
    const geometry::Vec3 before = twice_area(a, b, c);
    const geometry::Vec3 beside = twice_area(b, a, d);
    if (before.cross(beside).norm() > 1e-6 * before.norm() * beside.norm() || before.dot(beside) < 0.0) continue;
    const geometry::Vec3 first = twice_area(a, d, c);
    const geometry::Vec3 second = twice_area(d, b, c);
    if (std::min(first.dot(before), second.dot(before)) < 0.01 * before.squaredNorm()) continue;
    mesh.triangles[t] = {a, d, c};
    mesh.triangles[other] = {d, b, c};
    is_done[t] = is_done[other] = true;
  }
  return mesh;
}

/// Returns the mesh with the triangles in random order. Each triangle begins with a random corner.
inline geometry::TriangleMesh in_other_order(geometry::TriangleMesh mesh, unsigned seed) {
  std::mt19937 random(seed);
  std::shuffle(mesh.triangles.begin(), mesh.triangles.end(), random);
  for (auto& t : mesh.triangles) std::rotate(t.begin(), t.begin() + static_cast<std::ptrdiff_t>(random() % 3), t.end());
  return mesh;
}

/// Changes the rounding of the vertices below the entrance face at random. Each coordinate is increased or decreased by
/// one step of single precision, or remains unchanged. Coordinates of a magnitude below 0.01 mm remain unchanged.
inline geometry::TriangleMesh moved_by_rounding(geometry::TriangleMesh mesh, unsigned seed) {
  std::mt19937 random(seed);
  double top = -INFINITY;
  for (const geometry::Vec3& p : mesh.vertices) top = std::max(top, p.z());
  for (geometry::Vec3& p : mesh.vertices)
    for (double& c : p) {
      const auto way = random() % 3;
      if (p.z() == top || std::abs(c) < 0.01 || way == 0) continue;
      c = std::nextafter(static_cast<float>(c), way == 1 ? INFINITY : -INFINITY);
    }
  return mesh;
}

struct MeshVariant {
  const char* name;
  geometry::TriangleMesh mesh;
};

/// Returns meshes of the same solid whose triangles divide its facets in different ways.
inline std::vector<MeshVariant> variants_of(const geometry::TriangleMesh& mesh) {
  const geometry::TriangleMesh finer = divided_in_four(mesh);
  return {{"as it is", mesh},
          {"each triangle in 4", finer},
          {"each triangle in 16", divided_in_four(finer)},
          {"other diagonals", with_other_diagonals(mesh)},
          {"other diagonals of 4", with_other_diagonals(finer)},
          {"other order", in_other_order(mesh, 1)},
          {"other rounding", moved_by_rounding(mesh, 2)},
          {"other rounding of 4", in_other_order(moved_by_rounding(finer, 3), 4)}};
}

}  // namespace retrace::testing
