#include "geometry/part/closed_boundary.h"

#include <map>
#include <stdexcept>
#include <unordered_map>

#include "geometry/centroid.h"
#include "geometry/part/cover_polygons.h"
#include "geometry/part/triangle_mesh.h"

namespace retrace::geometry {
namespace {

/// Provides a vertex on the entrance face above each vertex of the rim. The vertex is added to the mesh on the first
/// request, and later requests return the same vertex.
class EntranceVertices {
 public:
  EntranceVertices(BoundaryMesh& mesh, double thickness_mm) : mesh_(mesh), thickness_mm_(thickness_mm) {}

  std::uint32_t above(std::uint32_t rim_vertex) {
    const auto [it, is_new] = raised_.try_emplace(rim_vertex, static_cast<std::uint32_t>(mesh_.vertices.size()));
    if (is_new) {
      const Vec3 p = mesh_.vertices[rim_vertex];
      mesh_.vertices.emplace_back(p.x(), p.y(), thickness_mm_);
    }
    return it->second;
  }

  /// Returns all vertices on the entrance face.
  std::vector<PlacedVertex> all() const {
    std::vector<PlacedVertex> vertices;
    for (const auto& [rim, above] : raised_) vertices.emplace_back(mesh_.vertices[above].head<2>(), above);
    return vertices;
  }

 private:
  BoundaryMesh& mesh_;
  double thickness_mm_;
  std::map<std::uint32_t, std::uint32_t> raised_;
};

}  // namespace

void add_fan(BoundaryMesh& mesh, const std::vector<std::uint32_t>& ring, FacetRole role) {
  const auto hub = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.push_back(ring_centroid(mesh.vertices, ring));
  for (std::size_t i = 0; i < ring.size(); ++i) {
    mesh.triangles.push_back({hub, ring[i], ring[(i + 1) % ring.size()]});
    mesh.roles.push_back(role);
  }
}

std::vector<std::pair<std::uint32_t, std::uint32_t>> open_edges(const BoundaryMesh& mesh) {
  std::unordered_map<std::uint64_t, int> passed;
  passed.reserve(3 * mesh.triangles.size());
  for (const auto& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) ++passed[directed_edge(t[k], t[(k + 1) % 3])];
  std::vector<std::pair<std::uint32_t, std::uint32_t>> open;
  for (const auto& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k)
      if (!passed.contains(directed_edge(t[(k + 1) % 3], t[k]))) open.emplace_back(t[k], t[(k + 1) % 3]);
  return open;
}

BoundaryMesh back_boundary(const Part& part) {
  if (part.period_mm || part.placements.size() != 1)
    throw std::logic_error("back_boundary: the part must be finite and one patch");
  const SurfacePatch& patch = part.patches[part.placements.front().patch];
  const Vec2 offset = part.placements.front().offset_mm;

  BoundaryMesh mesh;
  mesh.triangles = patch.triangles;
  mesh.vertices.reserve(patch.vertices.size());
  for (const Vec3& p : patch.vertices) mesh.vertices.emplace_back(p.x() + offset.x(), p.y() + offset.y(), p.z());
  for (const std::uint32_t facet : patch.triangle_facet) mesh.roles.push_back(patch.facets[facet].role);
  for (const auto& ring : patch.border_walls) add_fan(mesh, ring, FacetRole::border_wall);
  return mesh;
}

BoundaryMesh closed_boundary(const Part& part) {
  BoundaryMesh mesh = back_boundary(part);
  const SurfacePatch& patch = part.patches[part.placements.front().patch];
  EntranceVertices entrance(mesh, part.thickness_mm);
  const bool is_one_fan = part.entrance_pieces.empty();
  const Vec2 middle = centroid(part.outline);
  const auto hub = static_cast<std::uint32_t>(mesh.vertices.size());
  if (is_one_fan) mesh.vertices.emplace_back(middle.x(), middle.y(), part.thickness_mm);
  for (const auto& rim : patch.border_rim) {
    const std::uint32_t above_from = entrance.above(rim.front());
    const std::uint32_t above_to = entrance.above(rim.back());
    std::vector<std::uint32_t> side = rim;
    side.insert(side.end(), {above_to, above_from});
    add_fan(mesh, side, FacetRole::side);
    if (!is_one_fan) continue;
    mesh.triangles.push_back({hub, above_from, above_to});
    mesh.roles.push_back(FacetRole::entrance);
  }
  if (!is_one_fan) add_cover(mesh, part.entrance_pieces, entrance.all(), part.size_mm, FacetRole::entrance, true);
  return mesh;
}

}  // namespace retrace::geometry
