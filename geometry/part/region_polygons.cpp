#include "geometry/part/region_polygons.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <numeric>
#include <optional>
#include <unordered_map>
#include <utility>

#include "geometry/part/triangle_mesh.h"

namespace retrace::geometry {
namespace {

using Ring = std::vector<std::uint32_t>;

constexpr std::uint32_t kNoRegion = UINT32_MAX;
// Maximum sine of the angle by which the border may turn inward at a corner that is treated as convex. Rounding errors
// cause smaller angles.
constexpr double kStraight = 1e-13;
// Maximum relative area of a polygon that is treated as having no area. The relative area is twice the area, divided by
// the squared maximum distance between a corner and the first corner.
constexpr double kNeedle = 1e-12;

/// Returns twice the area of a triangle. The result is positive if the corners run counter-clockwise about the normal.
double twice_area(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& normal) {
  return (b - a).cross(c - a).dot(normal);
}

/// Triangulates a plane polygon by ear clipping.
class EarClipper {
 public:
  EarClipper(const std::vector<Vec3>& vertices, const Vec3& normal) : vertices_(vertices), normal_(normal) {}

  std::vector<MeshTriangle> triangles_of(Ring ring) const {
    std::vector<MeshTriangle> triangles;
    while (ring.size() > 2) {
      const std::size_t k = next_ear(ring);
      triangles.push_back({before(ring, k), ring[k], after(ring, k)});
      ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(k));
    }
    return triangles;
  }

 private:
  static std::uint32_t before(const Ring& ring, std::size_t k) { return ring[(k + ring.size() - 1) % ring.size()]; }
  static std::uint32_t after(const Ring& ring, std::size_t k) { return ring[(k + 1) % ring.size()]; }

  double turn(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
    return twice_area(vertices_[a], vertices_[b], vertices_[c], normal_);
  }

  /// Returns the index of the first corner that is an ear. If rounding errors leave no ear, returns the corner whose
  /// triangle has the largest signed area.
  std::size_t next_ear(const Ring& ring) const {
    Ring reflex;
    std::vector<double> turns;
    for (std::size_t k = 0; k < ring.size(); ++k) {
      turns.push_back(turn(before(ring, k), ring[k], after(ring, k)));
      if (turns.back() <= 0.0) reflex.push_back(ring[k]);
    }
    for (std::size_t k = 0; k < ring.size(); ++k)
      if (turns[k] > 0.0 && is_free(ring, k, reflex)) return k;
    return static_cast<std::size_t>(std::max_element(turns.begin(), turns.end()) - turns.begin());
  }

  /// Returns true if no reflex corner of the ring is within the triangle of corner k and its two neighbours.
  bool is_free(const Ring& ring, std::size_t k, const Ring& reflex) const {
    const std::uint32_t a = before(ring, k);
    const std::uint32_t b = ring[k];
    const std::uint32_t c = after(ring, k);
    return std::none_of(reflex.begin(), reflex.end(), [&](std::uint32_t p) {
      return p != a && p != c && turn(a, b, p) >= 0.0 && turn(b, c, p) >= 0.0 && turn(c, a, p) >= 0.0;
    });
  }

  const std::vector<Vec3>& vertices_;
  const Vec3& normal_;
};

/// Removes vertices from a mesh one by one.
class VertexRemover {
 public:
  VertexRemover(const std::vector<Vec3>& vertices, RegionTriangles mesh, const std::vector<FacetPlane>& planes,
                double rounding_mm)
      : vertices_(vertices), mesh_(std::move(mesh)), planes_(planes), rounding_mm_(rounding_mm) {
    triangles_at_.resize(vertices.size());
    for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t)
      for (const std::uint32_t v : mesh_.triangles[t]) triangles_at_[v].push_back(t);
  }

  RegionTriangles remove_all() {
    for (std::uint32_t v = 0; v < vertices_.size(); ++v) remove_if_needless(v);
    RegionTriangles left;
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
      if (mesh_.region_of[t] == kNoRegion) continue;
      left.triangles.push_back(mesh_.triangles[t]);
      left.region_of.push_back(mesh_.region_of[t]);
    }
    return left;
  }

 private:
  /// Regions on the two sides of an edge from a vertex v to another vertex. Looking along the edge away from v,
  /// `outgoing` is on the left and `incoming` is on the right.
  struct EdgeRegions {
    std::uint32_t outgoing = kNoRegion;
    std::uint32_t incoming = kNoRegion;
  };
  using Removed = std::vector<std::uint32_t>;

  /// Returns the two ends of the edge that is opposite to corner v of a triangle.
  static std::pair<std::uint32_t, std::uint32_t> opposite(const MeshTriangle& t, std::uint32_t v) {
    const std::size_t k = t[0] == v ? 0 : t[1] == v ? 1 : 2;
    return {t[(k + 1) % 3], t[(k + 2) % 3]};
  }

  static std::pair<std::uint32_t, std::uint32_t> edge(std::uint32_t a, std::uint32_t b) { return std::minmax(a, b); }

  /// Returns the other ends of the border edges at v. An edge is on a border if the regions on its two sides differ or
  /// if only one side has a region.
  std::vector<std::uint32_t> border_at(std::uint32_t v) const {
    std::map<std::uint32_t, EdgeRegions> edges;
    for (const std::uint32_t t : triangles_at_[v]) {
      const auto [a, b] = opposite(mesh_.triangles[t], v);
      edges[a].outgoing = mesh_.region_of[t];
      edges[b].incoming = mesh_.region_of[t];
    }
    std::vector<std::uint32_t> ends;
    for (const auto& [end, regions] : edges)
      if (regions.outgoing != regions.incoming) ends.push_back(end);
    return ends;
  }

  void remove_if_needless(std::uint32_t v) {
    if (triangles_at_[v].empty()) return;
    const std::vector<std::uint32_t> ends = border_at(v);
    if (!ends.empty() && (ends.size() != 2 || !is_straight(v, ends[0], ends[1]))) return;
    std::map<std::uint32_t, Ring> rings;
    for (const std::uint32_t t : triangles_at_[v]) rings.try_emplace(mesh_.region_of[t]);
    for (auto& [region, ring] : rings) {
      std::optional<Ring> found = ring_round(v, region, !ends.empty());
      if (!found) return;
      ring = std::move(*found);
    }
    if (!ends.empty()) keep_removed(v, ends[0], ends[1]);
    const std::vector<std::uint32_t> old = triangles_at_[v];
    for (const std::uint32_t t : old) erase(t);
    for (const auto& [region, ring] : rings)
      for (const MeshTriangle& t : EarClipper(vertices_, planes_[region].normal).triangles_of(ring)) insert(t, region);
  }

  /// Returns true if v is on the straight line from `from` to `to`. All vertices that were removed earlier between
  /// `from` and `to` must be on this line, too.
  bool is_straight(std::uint32_t v, std::uint32_t from, std::uint32_t to) const {
    const Vec3& a = vertices_[from];
    const Vec3 along = vertices_[to] - a;
    if ((a - vertices_[v]).dot(vertices_[to] - vertices_[v]) >= 0.0) return false;
    const auto is_near = [&](std::uint32_t other) {
      return along.cross(vertices_[other] - a).norm() <= rounding_mm_ * along.norm();
    };
    const auto all_near = [&](std::uint32_t end) {
      const auto it = removed_.find(edge(v, end));
      return it == removed_.end() || std::all_of(it->second.begin(), it->second.end(), is_near);
    };
    return is_near(v) && all_near(from) && all_near(to);
  }

  void keep_removed(std::uint32_t v, std::uint32_t from, std::uint32_t to) {
    Removed all = {v};
    for (const std::uint32_t end : {from, to}) {
      const auto it = removed_.find(edge(v, end));
      if (it == removed_.end()) continue;
      all.insert(all.end(), it->second.begin(), it->second.end());
      removed_.erase(it);
    }
    Removed& kept = removed_[edge(from, to)];
    kept.insert(kept.end(), all.begin(), all.end());
  }

  /// Returns the vertices around v in the triangles of a region, counter-clockwise. Returns nothing if these triangles
  /// do not form a single fan.
  /// \param is_open true if v is on the region's border
  std::optional<Ring> ring_round(std::uint32_t v, std::uint32_t region, bool is_open) const {
    std::map<std::uint32_t, std::uint32_t> next;
    std::map<std::uint32_t, std::uint32_t> previous;
    for (const std::uint32_t t : triangles_at_[v]) {
      if (mesh_.region_of[t] != region) continue;
      const auto [a, b] = opposite(mesh_.triangles[t], v);
      if (!next.emplace(a, b).second || !previous.emplace(b, a).second) return std::nullopt;
    }
    const auto start = std::find_if(next.begin(), next.end(),
                                    [&](const auto& step) { return !is_open || !previous.contains(step.first); });
    if (start == next.end()) return std::nullopt;
    std::uint32_t at = start->first;
    Ring ring;
    const std::uint32_t first = at;
    for (auto it = next.find(at); it != next.end(); it = next.find(at)) {
      ring.push_back(at);
      at = it->second;
      if (at == first) break;
    }
    if (is_open) ring.push_back(at);
    return ring.size() == next.size() + (is_open ? 1 : 0) ? std::optional(ring) : std::nullopt;
  }

  void erase(std::uint32_t triangle) {
    for (const std::uint32_t v : mesh_.triangles[triangle]) std::erase(triangles_at_[v], triangle);
    mesh_.region_of[triangle] = kNoRegion;
  }

  void insert(const MeshTriangle& triangle, std::uint32_t region) {
    for (const std::uint32_t v : triangle)
      triangles_at_[v].push_back(static_cast<std::uint32_t>(mesh_.triangles.size()));
    mesh_.triangles.push_back(triangle);
    mesh_.region_of.push_back(region);
  }

  const std::vector<Vec3>& vertices_;
  RegionTriangles mesh_;
  const std::vector<FacetPlane>& planes_;
  double rounding_mm_;
  std::vector<std::vector<std::uint32_t>> triangles_at_;
  /// removed vertices of each edge; the key is the two ends of the edge
  std::map<std::pair<std::uint32_t, std::uint32_t>, Removed> removed_;
};

/// Joins triangles into convex polygons by removing edges between them (Hertel and Mehlhorn 1983).
class PieceJoiner {
 public:
  PieceJoiner(const std::vector<Vec3>& vertices, const RegionTriangles& mesh, const std::vector<FacetPlane>& planes)
      : vertices_(vertices), mesh_(mesh), planes_(planes), joined_to_(mesh.triangles.size()) {
    std::iota(joined_to_.begin(), joined_to_.end(), 0U);
    for (const MeshTriangle& t : mesh.triangles) rings_.emplace_back(t.begin(), t.end());
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
      for (std::size_t k = 0; k < 3; ++k)
        left_of_.emplace(directed_edge(mesh.triangles[t][k], mesh.triangles[t][(k + 1) % 3]), t);
  }

  std::vector<RegionPolygon> join_all() {
    for (const auto& [a, b] : inner_edges()) join_across(a, b);
    std::vector<RegionPolygon> pieces;
    for (std::uint32_t t = 0; t < rings_.size(); ++t)
      if (joined_to_[t] == t && has_area(rings_[t], plane_of(t).normal))
        pieces.push_back({mesh_.region_of[t], std::move(rings_[t])});
    return pieces;
  }

 private:
  using Edge = std::pair<std::uint32_t, std::uint32_t>;

  const FacetPlane& plane_of(std::uint32_t t) const { return planes_[mesh_.region_of[t]]; }

  /// Returns the edges between two triangles of the same region, longest first. Edges of inverted triangles are
  /// excluded.
  std::vector<Edge> inner_edges() const {
    std::vector<std::pair<double, Edge>> edges;
    for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t)
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t a = mesh_.triangles[t][k];
        const std::uint32_t b = mesh_.triangles[t][(k + 1) % 3];
        const auto other = left_of_.find(directed_edge(b, a));
        if (a < b && other != left_of_.end() && mesh_.region_of[other->second] == mesh_.region_of[t] && is_convex(t) &&
            is_convex(other->second))
          edges.emplace_back(-(vertices_[b] - vertices_[a]).squaredNorm(), Edge(a, b));
      }
    std::sort(edges.begin(), edges.end());
    std::vector<Edge> sorted;
    for (const auto& [length, edge] : edges) sorted.push_back(edge);
    return sorted;
  }

  /// Returns false if rounding errors have inverted the triangle.
  bool is_convex(std::uint32_t t) const {
    const Ring& ring = rings_[t];
    for (std::size_t k = 0; k < ring.size(); ++k)
      if (!is_convex_at(ring, k, plane_of(t).normal)) return false;
    return true;
  }

  std::uint32_t ring_left_of(std::uint32_t a, std::uint32_t b) {
    std::uint32_t t = left_of_.at(directed_edge(a, b));
    while (joined_to_[t] != t) t = joined_to_[t] = joined_to_[joined_to_[t]];
    return t;
  }

  void join_across(std::uint32_t a, std::uint32_t b) {
    const std::uint32_t own = ring_left_of(a, b);
    const std::uint32_t other = ring_left_of(b, a);
    if (own == other) return;
    Ring ring = starting_at(rings_[own], b, a);
    const Ring rest = starting_at(rings_[other], a, b);
    if (ring.empty() || rest.empty()) return;
    const std::size_t at_a = ring.size() - 1;
    ring.insert(ring.end(), rest.begin() + 1, rest.end() - 1);
    Ring numbers = ring;
    std::sort(numbers.begin(), numbers.end());
    if (std::adjacent_find(numbers.begin(), numbers.end()) != numbers.end()) return;
    const Vec3& normal = plane_of(own).normal;
    if (!is_convex_at(ring, 0, normal) || !is_convex_at(ring, at_a, normal)) return;
    joined_to_[other] = own;
    rings_[own] = std::move(ring);
    rings_[other].clear();
  }

  /// Returns `ring` rotated such that it begins with `first` and ends with `last`. Returns an empty ring if the ring
  /// has no edge from `last` to `first`.
  static Ring starting_at(Ring ring, std::uint32_t first, std::uint32_t last) {
    std::rotate(ring.begin(), std::find(ring.begin(), ring.end(), first), ring.end());
    return ring.front() == first && ring.back() == last ? ring : Ring{};
  }

  bool is_convex_at(const Ring& ring, std::size_t k, const Vec3& normal) const {
    const Vec3& a = vertices_[ring[(k + ring.size() - 1) % ring.size()]];
    const Vec3& b = vertices_[ring[k]];
    const Vec3& c = vertices_[ring[(k + 1) % ring.size()]];
    return twice_area(a, b, c, normal) >= -kStraight * (b - a).norm() * (c - b).norm();
  }

  bool has_area(const Ring& ring, const Vec3& normal) const {
    double twice = 0.0;
    double longest = 0.0;
    for (std::size_t k = 1; k < ring.size(); ++k) {
      longest = std::max(longest, (vertices_[ring[k]] - vertices_[ring[0]]).squaredNorm());
      if (k > 1) twice += twice_area(vertices_[ring[0]], vertices_[ring[k - 1]], vertices_[ring[k]], normal);
    }
    return twice > kNeedle * longest;
  }

  const std::vector<Vec3>& vertices_;
  const RegionTriangles& mesh_;
  const std::vector<FacetPlane>& planes_;
  std::vector<std::uint32_t> joined_to_;
  std::vector<Ring> rings_;
  std::unordered_map<std::uint64_t, std::uint32_t> left_of_;  ///< triangle on the left of each directed edge
};

}  // namespace

RegionTriangles without_redundant_vertices(const std::vector<Vec3>& vertices, RegionTriangles mesh,
                                           const std::vector<FacetPlane>& planes, double rounding_mm) {
  return VertexRemover(vertices, std::move(mesh), planes, rounding_mm).remove_all();
}

std::vector<RegionPolygon> convex_polygons(const std::vector<Vec3>& vertices, const RegionTriangles& mesh,
                                           const std::vector<FacetPlane>& planes) {
  return PieceJoiner(vertices, mesh, planes).join_all();
}

}  // namespace retrace::geometry
