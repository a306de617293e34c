#include "geometry/part/surface_patch.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <unordered_map>

#include "geometry/centroid.h"
#include "geometry/part/vertex_index.h"
#include "geometry/plane_math.h"

namespace retrace::geometry {
namespace {

using Ring = std::vector<std::uint32_t>;

/// Two neighbouring vertices (from < to) and the tiles (facets that are joined to the patch) on both sides of the edge
/// between them.
struct SharedEdge {
  std::uint32_t from = 0;
  std::uint32_t to = 0;
  std::optional<std::uint32_t> left;
  std::optional<std::uint32_t> right;
};

/// Returns the cell size of a search grid such that each cell contains about one corner. The number of corners is used,
/// because strips at rounded edges are much narrower than elements.
double grid_of(const std::vector<Tile>& tiles) {
  double area_mm2 = 0.0;
  double corners = 1.0;
  for (const Tile& tile : tiles) {
    area_mm2 += area(tile.outline);
    corners += static_cast<double>(tile.outline.size());
  }
  return std::sqrt(area_mm2 / corners);
}

class PatchBuilder {
 public:
  PatchBuilder(const std::vector<Tile>& tiles, const Rectangle& block, double size_mm, const PatchRim& rim)
      : tiles_(tiles),
        block_(block),
        rim_(rim),
        tolerance_mm_(1e-9 * size_mm),
        index_(tolerance_mm_, std::max(grid_of(tiles), 4.0 * tolerance_mm_)) {}

  SurfacePatch build() {
    weld_outlines();
    find_edges();
    if (add_crossings()) find_edges();
    collect_heights();
    sort_walls();
    emit_facets();
    emit_border();
    if (!rim_.hull.empty()) emit_open_sides();
    shrink();
    return std::move(patch_);
  }

 private:
  struct Wall {
    std::uint32_t from = 0;  ///< the solid is on the left of the edge from -> to
    std::uint32_t to = 0;
    std::uint32_t deep = 0;
    std::uint32_t shallow = 0;
  };

  void weld_outlines() {
    outlines_.reserve(tiles_.size());
    for (const Tile& tile : tiles_) {
      Ring ring;
      for (const Vec2& p : tile.outline) {
        const std::uint32_t vertex = index_.add(p);
        if (ring.empty() || (ring.back() != vertex && ring.front() != vertex)) ring.push_back(vertex);
      }
      outlines_.push_back(without_straight_corners(ring));
    }
  }

  /// Removes corners on straight sides, because they would cause triangles without area. subdivided() inserts them
  /// again as vertices of the side.
  Ring without_straight_corners(const Ring& ring) const {
    constexpr double rounding = 1e-3;  // in multiples of the tolerance within which vertices count as being on a side
    Ring kept;
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Vec2& before = index_[ring[(i + ring.size() - 1) % ring.size()]];
      const Vec2 along = index_[ring[(i + 1) % ring.size()]] - before;
      const Vec2 to = index_[ring[i]] - before;
      if (std::abs(plane::cross(along, to)) > rounding * tolerance_mm_ * along.norm()) kept.push_back(ring[i]);
    }
    return kept.size() < 3 ? ring : kept;
  }

  /// Returns the outline with additional corners: all vertices of other tiles that are on the outline.
  Ring subdivided(const Ring& outline) const {
    Ring ring;
    for (std::size_t i = 0; i < outline.size(); ++i) {
      const std::uint32_t a = outline[i];
      const std::uint32_t b = outline[(i + 1) % outline.size()];
      ring.push_back(a);
      const Ring between = index_.on_segment(a, b);
      ring.insert(ring.end(), between.begin(), between.end());
    }
    return ring;
  }

  void find_edges() {
    rings_.clear();
    edges_.clear();
    std::size_t corners = 0;
    for (const Ring& outline : outlines_) {
      rings_.push_back(subdivided(outline));
      corners += rings_.back().size();
    }
    // Edges are shared by two tiles, except on the border. The number of edges is therefore about half the number of
    // corners.
    std::unordered_map<std::uint64_t, std::uint32_t> edge_of;
    edge_of.reserve(corners / 2);
    edges_.reserve(corners / 2);
    for (std::uint32_t t = 0; t < tiles_.size(); ++t) {
      const Ring& ring = rings_[t];
      for (std::size_t i = 0; i < ring.size(); ++i) {
        const std::uint32_t a = ring[i];
        const std::uint32_t b = ring[(i + 1) % ring.size()];
        const std::uint64_t key = (static_cast<std::uint64_t>(std::min(a, b)) << 32) | std::max(a, b);
        const auto [it, is_new] = edge_of.try_emplace(key, static_cast<std::uint32_t>(edges_.size()));
        if (is_new) edges_.push_back({std::min(a, b), std::max(a, b), {}, {}});
        (a < b ? edges_[it->second].left : edges_[it->second].right) = t;
      }
    }
  }

  double height(std::uint32_t tile, std::uint32_t vertex) const { return tiles_[tile].plane.at(index_[vertex]); }
  /// Returns the height of a tile at a vertex. Outside the border there is no tile, and the walls on the border end at
  /// z = 0.
  double height(const std::optional<std::uint32_t>& tile, std::uint32_t vertex) const {
    return tile ? height(*tile, vertex) : 0.0;
  }

  /// Adds a vertex at each crossing of the heights of two neighbouring tiles. The deeper tile is not the same on both
  /// sides of a crossing, so a wall ends there.
  bool add_crossings() {
    bool added = false;
    for (const SharedEdge& e : edges_) {
      const double da = height(e.left, e.from) - height(e.right, e.from);
      const double db = height(e.left, e.to) - height(e.right, e.to);
      if (std::min(da, db) > -tolerance_mm_ || std::max(da, db) < tolerance_mm_) continue;
      index_.add(index_[e.from] + (index_[e.to] - index_[e.from]) * (da / (da - db)));
      added = true;
    }
    return added;
  }

  std::uint32_t vertex_at(std::uint32_t flat_vertex, double z) {
    auto& column = columns_[flat_vertex];
    for (const auto& [known_z, id] : column)
      if (std::abs(known_z - z) <= tolerance_mm_) return id;
    const auto id = static_cast<std::uint32_t>(patch_.vertices.size());
    patch_.vertices.emplace_back(index_[flat_vertex].x(), index_[flat_vertex].y(), z);
    column.emplace_back(z, id);
    return id;
  }

  /// Returns the height of the lower end of the plate's side at a vertex of a tile on the border. If the tile is below
  /// z = 0 there, a border wall extends from the tile up to z = 0, and the side begins at z = 0. Otherwise the side
  /// begins at the tile.
  double rim_height(std::uint32_t tile, std::uint32_t vertex) const { return std::max(0.0, height(tile, vertex)); }

  void collect_heights() {
    columns_.resize(index_.size());
    for (std::uint32_t t = 0; t < tiles_.size(); ++t)
      for (const std::uint32_t v : rings_[t]) vertex_at(v, height(t, v));
    for (const SharedEdge& e : edges_) {
      if (e.left && e.right) continue;
      for (const std::uint32_t v : {e.from, e.to}) vertex_at(v, rim_height(e.left ? *e.left : *e.right, v));
    }
    for (auto& column : columns_) std::sort(column.begin(), column.end());
  }

  void sort_walls() {
    walls_of_.resize(tiles_.size());
    for (const SharedEdge& e : edges_) {
      if (!e.left || !e.right) continue;
      const double da = height(*e.left, e.from) - height(*e.right, e.from);
      const double db = height(*e.left, e.to) - height(*e.right, e.to);
      if (std::abs(da) <= tolerance_mm_ && std::abs(db) <= tolerance_mm_) continue;
      const bool left_is_deep = da + db < 0.0;
      const Wall wall = left_is_deep ? Wall{e.from, e.to, *e.left, *e.right} : Wall{e.to, e.from, *e.right, *e.left};
      if (tiles_[wall.deep].is_output) walls_of_[wall.deep].push_back(wall);
    }
  }

  /// Vertical face over the edge from -> to, between a bottom and a top. The solid is on the left. `ring` contains all
  /// vertices on the outline, and `corners` only the corners.
  struct Strip {
    Ring ring;
    Ring corners;
  };
  Strip strip(std::uint32_t from, std::uint32_t to, double bottom_from, double bottom_to, double top_from,
              double top_to) {
    Strip s;
    const auto add = [&](std::uint32_t id, bool corner) {
      if (!s.ring.empty() && (s.ring.back() == id || s.ring.front() == id)) return;
      s.ring.push_back(id);
      if (corner) s.corners.push_back(id);
    };
    add(vertex_at(from, bottom_from), true);
    add(vertex_at(to, bottom_to), true);
    for (const auto& [z, id] : columns_[to])
      if (z > bottom_to + tolerance_mm_ && z < top_to - tolerance_mm_) add(id, false);
    add(vertex_at(to, top_to), true);
    add(vertex_at(from, top_from), true);
    const auto& column = columns_[from];
    for (auto it = column.rbegin(); it != column.rend(); ++it)
      if (it->first > bottom_from + tolerance_mm_ && it->first < top_from - tolerance_mm_) add(it->second, false);
    return s;
  }

  FacetRole wall_role(const Wall& wall) const {
    const Vec2& a = index_[wall.from];
    const Vec2& b = index_[wall.to];
    for (const Eigen::Index axis : {0, 1})
      for (const double border : {block_.lower[axis], block_.upper[axis]})
        if (std::abs(a[axis] - border) <= tolerance_mm_ && std::abs(b[axis] - border) <= tolerance_mm_)
          return FacetRole::border_wall;
    for (const std::vector<Vec2>& loop : rim_.borders)
      if (is_on(loop, a, b)) return FacetRole::border_wall;
    return FacetRole::inner_wall;
  }

  /// Returns true if a segment is on a side of a closed polygon.
  bool is_on(const std::vector<Vec2>& loop, const Vec2& a, const Vec2& b) const {
    for (std::size_t k = 0; k < loop.size(); ++k) {
      const Vec2& from = loop[k];
      const Vec2 side = loop[(k + 1) % loop.size()] - from;
      const Vec2 along = side.normalized();
      const auto is_near = [&](const Vec2& p) {
        const Vec2 to = p - from;
        return std::abs(plane::cross(along, to)) <= tolerance_mm_ && along.dot(to) >= -tolerance_mm_ &&
               along.dot(to) <= side.norm() + tolerance_mm_;
      };
      if (is_near(a) && is_near(b)) return true;
    }
    return false;
  }

  void emit_facets() {
    cell_of_tile_.resize(tiles_.size());
    for (std::uint32_t t = 0; t < tiles_.size(); ++t) {
      if (!tiles_[t].is_output) continue;
      const bool same_cell = t > 0 && tiles_[t - 1].is_output && tiles_[t - 1].cell == tiles_[t].cell;
      if (!same_cell || patch_.cells.empty())
        patch_.cells.push_back({static_cast<std::uint32_t>(patch_.facets.size()), 0, Vec3::Zero(), Vec3::Zero()});
      cell_of_tile_[t] = static_cast<std::uint32_t>(patch_.cells.size() - 1);
      emit_tile(t);
      for (const Wall& wall : walls_of_[t]) emit_wall(wall);
      PatchCell& cell = patch_.cells.back();
      cell.facet_count = static_cast<std::uint32_t>(patch_.facets.size()) - cell.first_facet;
    }
    for (PatchCell& cell : patch_.cells) bound(cell);
  }

  void emit_tile(std::uint32_t t) {
    const Tile& tile = tiles_[t];
    PatchFacet facet;
    facet.role = tile.role;
    facet.centroid_mm = tile.centroid_mm;
    const Vec3 downward(tile.plane.slope.x(), tile.plane.slope.y(), -1.0);
    facet.normal = downward.normalized();
    facet.offset_mm = -tile.plane.height_mm / downward.norm();
    // The outline is counter-clockwise as seen from above. Outside is below, so the order is reversed.
    Ring ring;
    Ring corners;
    for (auto it = rings_[t].rbegin(); it != rings_[t].rend(); ++it) ring.push_back(vertex_at(*it, height(t, *it)));
    for (auto it = outlines_[t].rbegin(); it != outlines_[t].rend(); ++it)
      corners.push_back(vertex_at(*it, height(t, *it)));
    emit(facet, ring, corners);
  }

  void emit_wall(const Wall& wall) {
    const Strip s = strip(wall.from, wall.to, height(wall.deep, wall.from), height(wall.deep, wall.to),
                          height(wall.shallow, wall.from), height(wall.shallow, wall.to));
    if (s.corners.size() < 3) return;
    const Vec2 along = index_[wall.to] - index_[wall.from];
    PatchFacet facet;
    facet.role = wall_role(wall);
    facet.normal = Vec3(along.y(), -along.x(), 0.0).normalized();
    facet.offset_mm = facet.normal.head<2>().dot(index_[wall.from]);
    emit(facet, s.ring, s.corners);
  }

  void emit(PatchFacet facet, const Ring& ring, const Ring& corners) {
    const auto number = static_cast<std::uint32_t>(patch_.facets.size());
    facet.first_corner = static_cast<std::uint32_t>(patch_.corners.size());
    facet.corner_count = static_cast<std::uint32_t>(corners.size());
    patch_.corners.insert(patch_.corners.end(), corners.begin(), corners.end());
    patch_.facets.push_back(facet);
    const auto triangle = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
      patch_.triangles.push_back({a, b, c});
      patch_.triangle_facet.push_back(number);
    };
    if (ring.size() == corners.size()) {
      for (std::size_t i = 1; i + 1 < ring.size(); ++i) triangle(ring[0], ring[i], ring[i + 1]);
      return;
    }
    // The ring has vertices inside its straight edges. A fan of triangles from a corner could therefore contain
    // triangles without area. A fan from the centroid contains only triangles with area.
    const auto hub = static_cast<std::uint32_t>(patch_.vertices.size());
    patch_.vertices.push_back(ring_centroid(patch_.vertices, corners));
    for (std::size_t i = 0; i < ring.size(); ++i) triangle(hub, ring[i], ring[(i + 1) % ring.size()]);
  }

  void bound(PatchCell& cell) const {
    cell.lower.setConstant(INFINITY);
    cell.upper.setConstant(-INFINITY);
    for (std::uint32_t f = cell.first_facet; f < cell.first_facet + cell.facet_count; ++f) {
      const PatchFacet& facet = patch_.facets[f];
      for (std::uint32_t c = facet.first_corner; c < facet.first_corner + facet.corner_count; ++c) {
        const Vec3& p = patch_.vertices[patch_.corners[c]];
        cell.lower = cell.lower.cwiseMin(p);
        cell.upper = cell.upper.cwiseMax(p);
      }
    }
  }

  /// Edge of a tile that belongs to the output, on the border of the part. The tile is to the left of the edge.
  struct BorderEdge {
    std::uint32_t tile = 0;
    std::uint32_t from = 0;
    std::uint32_t to = 0;
  };

  std::vector<BorderEdge> border_edges() const {
    std::vector<BorderEdge> edges;
    for (const SharedEdge& e : edges_) {
      if (e.left.has_value() == e.right.has_value()) continue;
      const std::uint32_t tile = e.left ? *e.left : *e.right;
      if (tiles_[tile].is_output) edges.push_back({tile, e.left ? e.from : e.to, e.left ? e.to : e.from});
    }
    return edges;
  }

  void emit_border() {
    for (const auto& [tile, from, to] : border_edges()) {
      const double rim_from = rim_height(tile, from);
      const double rim_to = rim_height(tile, to);
      Ring rim;
      const auto& before = columns_[from];
      for (auto it = before.rbegin(); it != before.rend() && it->first > rim_from + tolerance_mm_; ++it)
        rim.push_back(it->second);
      rim.insert(rim.end(), {vertex_at(from, rim_from), vertex_at(to, rim_to)});
      for (const auto& [z, id] : columns_[to])
        if (z > rim_to + tolerance_mm_) rim.push_back(id);
      patch_.border_rim.push_back(std::move(rim));
      Strip s = strip(from, to, height(tile, from), height(tile, to), rim_from, rim_to);
      if (s.corners.size() >= 3) patch_.border_walls.push_back(std::move(s.ring));
    }
  }

  /// Adds the sides that are not on the hull of the part as facets: the border wall below z = 0 and the side of the
  /// plate above it. They get no triangles, because the triangles of the borders are made from border_walls and
  /// border_rim.
  void emit_open_sides() {
    for (const auto& [tile, from, to] : border_edges()) {
      if (is_on(rim_.hull, index_[from], index_[to])) continue;
      PatchCell cell;
      cell.first_facet = static_cast<std::uint32_t>(patch_.facets.size());
      cell.first_of_element = cell_of_tile_[tile];
      const double rim_from = rim_height(tile, from);
      const double rim_to = rim_height(tile, to);
      emit_side(from, to, {height(tile, from), height(tile, to), rim_to, rim_from}, FacetRole::border_wall);
      emit_side(from, to, {rim_from, rim_to, rim_.top_mm, rim_.top_mm}, FacetRole::side);
      cell.facet_count = static_cast<std::uint32_t>(patch_.facets.size()) - cell.first_facet;
      bound(cell);
      patch_.cells.push_back(cell);
    }
  }

  /// Adds a vertical facet between two vertices in plan, unless the height of the facet is 0 at both vertices.
  /// \param z heights of the corners: bottom at `from`, bottom at `to`, top at `to`, top at `from`
  void emit_side(std::uint32_t from, std::uint32_t to, const std::array<double, 4>& z, FacetRole role) {
    const bool has_from = z[3] - z[0] > tolerance_mm_;
    const bool has_to = z[2] - z[1] > tolerance_mm_;
    if (!has_from && !has_to) return;
    const Vec2& a = index_[from];
    const Vec2& b = index_[to];
    const Vec2 along = b - a;
    PatchFacet facet;
    facet.role = role;
    facet.normal = Vec3(along.y(), -along.x(), 0.0).normalized();
    facet.offset_mm = facet.normal.head<2>().dot(a);
    facet.first_corner = static_cast<std::uint32_t>(patch_.corners.size());
    const auto add = [&](const Vec2& p, double height_mm) {
      patch_.corners.push_back(static_cast<std::uint32_t>(patch_.vertices.size()));
      patch_.vertices.emplace_back(p.x(), p.y(), height_mm);
      ++facet.corner_count;
    };
    add(a, z[0]);
    add(b, z[1]);
    if (has_to) add(b, z[2]);
    if (has_from) add(a, z[3]);
    patch_.facets.push_back(facet);
  }

  /// Frees unused capacity, because parts may have millions of facets.
  void shrink() {
    patch_.vertices.shrink_to_fit();
    patch_.facets.shrink_to_fit();
    patch_.corners.shrink_to_fit();
    patch_.cells.shrink_to_fit();
    patch_.triangles.shrink_to_fit();
    patch_.triangle_facet.shrink_to_fit();
  }

  const std::vector<Tile>& tiles_;
  const Rectangle block_;
  const PatchRim& rim_;
  const double tolerance_mm_;
  VertexIndex index_;
  std::vector<Ring> outlines_;
  std::vector<Ring> rings_;
  std::vector<SharedEdge> edges_;
  /// heights above each vertex in plan, ascending
  std::vector<std::vector<std::pair<double, std::uint32_t>>> columns_;
  std::vector<std::vector<Wall>> walls_of_;
  std::vector<std::uint32_t> cell_of_tile_;
  SurfacePatch patch_;
};

}  // namespace

SurfacePatch build_patch(const std::vector<Tile>& tiles, const Rectangle& block, double size_mm, const PatchRim& rim) {
  return PatchBuilder(tiles, block, size_mm, rim).build();
}

}  // namespace retrace::geometry
