#include "geometry/check/mesh_union.h"

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/corefinement.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <utility>
#include <vector>

namespace retrace::geometry {

namespace pmp = CGAL::Polygon_mesh_processing;

namespace {

using ExactKernel = CGAL::Exact_predicates_exact_constructions_kernel;
using ExactMesh = CGAL::Surface_mesh<ExactKernel::Point_3>;
using Triangles = std::vector<std::array<std::uint32_t, 3>>;

/// Splits a mesh into its bodies: sets of triangles that are connected through shared edges.
std::vector<Triangles> bodies_of(const TriangleMesh& mesh) {
  std::vector<std::size_t> parent(mesh.triangles.size());
  std::iota(parent.begin(), parent.end(), std::size_t{0});
  const auto root = [&](std::size_t t) {
    while (parent[t] != t) t = parent[t] = parent[parent[t]];
    return t;
  };
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> first;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto edge = std::minmax(mesh.triangles[t][k], mesh.triangles[t][(k + 1) % 3]);
      const auto [it, is_new] = first.try_emplace({edge.first, edge.second}, t);
      if (!is_new) parent[root(t)] = root(it->second);
    }
  std::map<std::size_t, Triangles> by_root;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) by_root[root(t)].push_back(mesh.triangles[t]);
  std::vector<Triangles> bodies;
  for (auto& [first_triangle, triangles] : by_root) bodies.push_back(std::move(triangles));
  return bodies;
}

ExactMesh surface_of(const TriangleMesh& mesh, const Triangles& body) {
  std::map<std::uint32_t, std::size_t> number;
  std::vector<ExactKernel::Point_3> points;
  std::vector<std::vector<std::size_t>> polygons;
  for (const auto& t : body) {
    polygons.emplace_back();
    for (const std::uint32_t v : t) {
      const auto [it, is_new] = number.try_emplace(v, points.size());
      if (is_new) points.emplace_back(mesh.vertices[v].x(), mesh.vertices[v].y(), mesh.vertices[v].z());
      polygons.back().push_back(it->second);
    }
  }
  ExactMesh surface;
  pmp::polygon_soup_to_polygon_mesh(points, polygons, surface);
  return surface;
}

TriangleMesh mesh_of(const ExactMesh& surface) {
  TriangleMesh mesh;
  std::map<ExactMesh::Vertex_index, std::uint32_t> number;
  for (const auto face : surface.faces()) {
    std::array<std::uint32_t, 3> triangle{};
    std::size_t k = 0;
    for (const auto v : CGAL::vertices_around_face(surface.halfedge(face), surface)) {
      const auto [it, is_new] = number.try_emplace(v, static_cast<std::uint32_t>(mesh.vertices.size()));
      const auto& p = surface.point(v);
      if (is_new) mesh.vertices.emplace_back(CGAL::to_double(p.x()), CGAL::to_double(p.y()), CGAL::to_double(p.z()));
      triangle.at(k++) = it->second;
    }
    mesh.triangles.push_back(triangle);
  }
  return mesh;
}

}  // namespace

std::optional<MeshUnion> union_of_bodies(const TriangleMesh& mesh) {
  const std::vector<Triangles> bodies = bodies_of(mesh);
  if (bodies.size() < 2) return std::nullopt;
  std::optional<ExactMesh> all;
  for (const Triangles& body : bodies) {
    ExactMesh next = surface_of(mesh, body);
    if (pmp::does_self_intersect(next) || !pmp::is_outward_oriented(next)) return std::nullopt;
    if (!all) {
      all = std::move(next);
      continue;
    }
    ExactMesh united;
    if (!pmp::corefine_and_compute_union(*all, next, united)) return std::nullopt;
    all = std::move(united);
  }
  return MeshUnion{mesh_of(*all), bodies.size()};
}

}  // namespace retrace::geometry
