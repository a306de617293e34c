#include "geometry/part/mould_boundary.h"
#include "geometry/centroid.h"
#include "geometry/part/cover_polygons.h"

#include <algorithm>
#include <map>
#include <stdexcept>
#include <utility>

namespace retrace::geometry {
namespace {

using Ring = std::vector<std::uint32_t>;
using Edge = std::pair<std::uint32_t, std::uint32_t>;

/// Border vertices of the surface with the same x and y, sorted by height, and the vertex at the bottom of the block
/// below them.
struct Column {
  std::vector<std::pair<double, std::uint32_t>> vertices;
  std::uint32_t bottom = 0;
};

class MouldBuilder {
 public:
  MouldBuilder(const Part& part, double block_mm)
      : bottom_z_(-part.element_depth_mm - block_mm),
        middle_(centroid(part.outline)),
        pieces_(part.entrance_pieces),
        size_mm_(part.size_mm) {
    const SurfacePatch& patch = part.patches[part.placements.front().patch];
    const Vec2 offset = part.placements.front().offset_mm;
    for (const Vec3& p : patch.vertices) mesh_.vertices.emplace_back(p.x() + offset.x(), p.y() + offset.y(), p.z());
    for (const auto& t : patch.triangles) mesh_.triangles.push_back({t[0], t[2], t[1]});
    for (const std::uint32_t facet : patch.triangle_facet) mesh_.roles.push_back(patch.facets[facet].role);
  }

  BoundaryMesh build() {
    const std::vector<Edge> border = open_edges(mesh_);
    collect_columns(border);
    if (!pieces_.empty()) return with_pieces(border);
    const std::uint32_t hub = add_vertex({middle_.x(), middle_.y(), bottom_z_});
    for (const auto& [a, b] : border) {
      // The edge is a vertical end of a wall. Both vertices are in one Column and are inserted by add_side().
      if (place(a) == place(b)) continue;
      add_side(a, b);
      add_triangle(hub, columns_.at(place(b)).bottom, columns_.at(place(a)).bottom, FacetRole::flat_back);
    }
    return std::move(mesh_);
  }

 private:
  using Place = std::pair<double, double>;

  /// Completes the mould of a part with notches or holes.
  BoundaryMesh with_pieces(const std::vector<Edge>& border) {
    for (const auto& [a, b] : border)
      if (place(a) != place(b)) add_side(a, b);
    std::vector<PlacedVertex> bottom;
    for (const auto& [at, column] : columns_) bottom.emplace_back(Vec2(at.first, at.second), column.bottom);
    add_cover(mesh_, pieces_, bottom, size_mm_, FacetRole::flat_back, false);
    return std::move(mesh_);
  }

  /// Returns x and y of a vertex. Vertices above one another have exactly equal x and y.
  Place place(std::uint32_t vertex) const { return {mesh_.vertices[vertex].x(), mesh_.vertices[vertex].y()}; }

  std::uint32_t add_vertex(const Vec3& p) {
    mesh_.vertices.push_back(p);
    return static_cast<std::uint32_t>(mesh_.vertices.size() - 1);
  }

  void add_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c, FacetRole role) {
    mesh_.triangles.push_back({a, b, c});
    mesh_.roles.push_back(role);
  }

  void collect_columns(const std::vector<Edge>& border) {
    for (const auto& [a, b] : border)
      for (const std::uint32_t v : {a, b}) columns_[place(v)].vertices.emplace_back(mesh_.vertices[v].z(), v);
    for (auto& [at, column] : columns_) {
      std::sort(column.vertices.begin(), column.vertices.end());
      column.vertices.erase(std::unique(column.vertices.begin(), column.vertices.end()), column.vertices.end());
      column.bottom = add_vertex({at.first, at.second, bottom_z_});
    }
  }

  /// Adds the side of the block below the surface's edge from a to b. The side includes all border vertices on its
  /// outline.
  void add_side(std::uint32_t a, std::uint32_t b) {
    const Column& under_a = columns_.at(place(a));
    const Column& under_b = columns_.at(place(b));
    Ring ring = {b, a};
    for (auto it = under_a.vertices.rbegin(); it != under_a.vertices.rend(); ++it)
      if (it->first < mesh_.vertices[a].z()) ring.push_back(it->second);
    ring.insert(ring.end(), {under_a.bottom, under_b.bottom});
    for (const auto& [z, v] : under_b.vertices)
      if (z < mesh_.vertices[b].z()) ring.push_back(v);
    const std::uint32_t hub = add_vertex(ring_centroid(mesh_.vertices, ring));
    for (std::size_t i = 0; i < ring.size(); ++i)
      add_triangle(hub, ring[i], ring[(i + 1) % ring.size()], FacetRole::side);
  }

  BoundaryMesh mesh_;
  double bottom_z_;
  Vec2 middle_;
  std::vector<Polygon> pieces_;
  double size_mm_;
  std::map<Place, Column> columns_;
};

}  // namespace

BoundaryMesh mould_boundary(const Part& part, double block_mm) {
  if (part.period_mm || part.placements.size() != 1 || !(block_mm > 0.0))
    throw std::logic_error("mould_boundary: the part must be finite and one patch, the block thicker than 0");
  return MouldBuilder(part, block_mm).build();
}

}  // namespace retrace::geometry
