#include "geometry/outline/convex_decomposition.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>
#include <utility>

#include "geometry/plane_math.h"

namespace retrace::geometry {
namespace {

using VertexRing = std::vector<std::uint32_t>;
using Triangle = std::array<std::uint32_t, 3>;

/// Sine of the maximum angle by which the border may turn right at a corner that is still regarded as convex. Rounding
/// errors can cause such small angles.
constexpr double kConvex = 1e-13;

/// Returns twice the area of a triangle. It is positive if the corners run counter-clockwise.
double doubled_area(const Vec2& a, const Vec2& b, const Vec2& c) {
  return plane::cross(b - a, c - a);
}

/// Triangulates a region. Vertices are referred to by their numbers.
class Triangulation {
 public:
  explicit Triangulation(const std::vector<std::vector<Vec2>>& loops) {
    for (const std::vector<Vec2>& loop : loops) {
      VertexRing& ring = rings_.emplace_back(loop.size());
      std::iota(ring.begin(), ring.end(), static_cast<std::uint32_t>(vertices_.size()));
      vertices_.insert(vertices_.end(), loop.begin(), loop.end());
    }
    join_holes();
    clip_ears();
  }

  const std::vector<Vec2>& vertices() const { return vertices_; }
  const std::vector<Triangle>& triangles() const { return triangles_; }

 private:
  double turn(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
    return doubled_area(vertices_[a], vertices_[b], vertices_[c]);
  }

  std::uint32_t rightmost(const VertexRing& ring) const {
    return *std::ranges::max_element(ring, {}, [&](std::uint32_t v) { return vertices_[v].x(); });
  }

  /// Connects each hole to the outer border by a bridge (a pair of opposite edges), beginning with the hole that
  /// extends furthest towards +x (Eberly, "Triangulation by ear clipping", 2002).
  void join_holes() {
    std::sort(rings_.begin() + 1, rings_.end(), [&](const VertexRing& a, const VertexRing& b) {
      return vertices_[rightmost(a)].x() > vertices_[rightmost(b)].x();
    });
    ring_ = rings_.front();
    for (std::size_t h = 1; h < rings_.size(); ++h) {
      VertexRing hole = rings_[h];
      std::rotate(hole.begin(), std::ranges::find(hole, rightmost(hole)), hole.end());
      const auto at = ring_.begin() + static_cast<std::ptrdiff_t>(position_visible_from(hole.front()));
      hole.push_back(hole.front());
      hole.push_back(*at);
      ring_.insert(at + 1, hole.begin(), hole.end());
    }
  }

  /// Returns the index, in the ring, of a corner that is visible from the rightmost corner of a hole. To find it, a ray
  /// is cast from the rightmost corner towards +x.
  std::size_t position_visible_from(std::uint32_t hole) const {
    const Vec2& m = vertices_[hole];
    double nearest = INFINITY;
    std::size_t best = 0;
    for (std::size_t k = 0; k < ring_.size(); ++k) {
      const std::size_t next = (k + 1) % ring_.size();
      const Vec2& a = vertices_[ring_[k]];
      const Vec2& b = vertices_[ring_[next]];
      // The ray meets only sides that run upwards, because it comes from inside the region and the region is to the
      // left of each side.
      if (!(a.y() <= m.y() && b.y() >= m.y() && a.y() < b.y())) continue;
      const double x = a.x() + (b.x() - a.x()) * ((m.y() - a.y()) / (b.y() - a.y()));
      if (x < m.x() || x >= nearest) continue;
      nearest = x;
      best = a.x() > b.x() ? k : next;
    }
    const Vec2 hit(nearest, m.y());
    const Vec2 seen = vertices_[ring_[best]];
    // A reflex corner inside the triangle of m, the hit point and the candidate may hide the candidate. The corner with
    // the smallest angle to the horizontal is then visible.
    double steepness = INFINITY;
    double closest = INFINITY;
    const bool is_below = seen.y() < m.y();
    for (std::size_t k = 0; k < ring_.size(); ++k) {
      const Vec2& p = vertices_[ring_[k]];
      if (!is_visible_side(k, m)) continue;
      const bool is_in = is_below ? in_triangle(p, m, seen, hit) : in_triangle(p, m, hit, seen);
      if (!is_in && ring_[k] != ring_[best]) continue;
      const Vec2 to = p - m;
      const double slope = std::abs(to.y()) / std::max(to.x(), 1e-300);
      if (slope > steepness || (slope == steepness && to.norm() >= closest)) continue;
      steepness = slope;
      closest = to.norm();
      best = k;
    }
    return best;
  }

  /// Returns true if a segment from a point to a corner of the ring starts inside the region at this corner.
  bool is_visible_side(std::size_t k, const Vec2& m) const {
    const Vec2& p = vertices_[ring_[k]];
    const Vec2& before = vertices_[ring_[(k + ring_.size() - 1) % ring_.size()]];
    const Vec2& after = vertices_[ring_[(k + 1) % ring_.size()]];
    const bool is_convex = doubled_area(before, p, after) >= 0.0;
    const bool left_of_in = doubled_area(before, p, m) > 0.0;
    const bool left_of_out = doubled_area(p, after, m) > 0.0;
    return is_convex ? left_of_in && left_of_out : left_of_in || left_of_out;
  }

  static bool in_triangle(const Vec2& p, const Vec2& a, const Vec2& b, const Vec2& c) {
    return doubled_area(a, b, p) >= 0.0 && doubled_area(b, c, p) >= 0.0 && doubled_area(c, a, p) >= 0.0;
  }

  void clip_ears() {
    while (ring_.size() > 2) {
      const std::size_t k = next_ear();
      const std::size_t n = ring_.size();
      triangles_.push_back({ring_[(k + n - 1) % n], ring_[k], ring_[(k + 1) % n]});
      ring_.erase(ring_.begin() + static_cast<std::ptrdiff_t>(k));
      first_ = k;
    }
  }

  /// Returns the position of a corner that can be cut off. The search begins at the last ear.
  std::size_t next_ear() const {
    const std::size_t n = ring_.size();
    std::vector<std::uint32_t> reflex;
    std::vector<double> turns(n);
    for (std::size_t k = 0; k < n; ++k) {
      turns[k] = turn(ring_[(k + n - 1) % n], ring_[k], ring_[(k + 1) % n]);
      if (turns[k] <= 0.0) reflex.push_back(ring_[k]);
    }
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t k = (first_ + i) % n;
      if (turns[k] > 0.0 && is_free(k, reflex)) return k;
    }
    return static_cast<std::size_t>(std::ranges::max_element(turns) - turns.begin());
  }

  bool is_free(std::size_t k, const std::vector<std::uint32_t>& reflex) const {
    const std::size_t n = ring_.size();
    const Vec2& a = vertices_[ring_[(k + n - 1) % n]];
    const Vec2& b = vertices_[ring_[k]];
    const Vec2& c = vertices_[ring_[(k + 1) % n]];
    return std::ranges::none_of(reflex, [&](std::uint32_t v) {
      const Vec2& p = vertices_[v];
      // The end points of a bridge occur twice in the ring and may be reflex corners.
      return p != a && p != b && p != c && in_triangle(p, a, b, c);
    });
  }

  std::vector<Vec2> vertices_;
  std::vector<VertexRing> rings_;
  VertexRing ring_;
  std::size_t first_ = 0;
  std::vector<Triangle> triangles_;
};

/// Joins triangles to convex polygons by removing edges between them.
class TriangleJoiner {
 public:
  explicit TriangleJoiner(const Triangulation& from) : vertices_(from.vertices()), joined_to_(from.triangles().size()) {
    std::iota(joined_to_.begin(), joined_to_.end(), 0U);
    for (std::uint32_t t = 0; t < from.triangles().size(); ++t) {
      const Triangle& corners = from.triangles()[t];
      rings_.emplace_back(corners.begin(), corners.end());
      for (std::size_t k = 0; k < 3; ++k) left_of_.emplace(std::pair(corners[k], corners[(k + 1) % 3]), t);
    }
  }

  std::vector<Polygon> join_all() {
    std::vector<std::pair<double, Edge>> edges;
    for (const auto& [edge, triangle] : left_of_)
      if (edge.first < edge.second && left_of_.contains({edge.second, edge.first}))
        edges.emplace_back(-(vertices_[edge.second] - vertices_[edge.first]).squaredNorm(), edge);
    std::ranges::sort(edges);
    for (const auto& [length, edge] : edges) join_across(edge.first, edge.second);
    std::vector<Polygon> pieces;
    for (std::uint32_t t = 0; t < rings_.size(); ++t) {
      if (joined_to_[t] != t) continue;
      Polygon piece;
      for (const std::uint32_t v : rings_[t]) piece.push_back(vertices_[v]);
      if (area(piece) > 0.0) pieces.push_back(std::move(piece));
    }
    return pieces;
  }

 private:
  using Edge = std::pair<std::uint32_t, std::uint32_t>;

  std::uint32_t ring_left_of(std::uint32_t a, std::uint32_t b) {
    std::uint32_t t = left_of_.at({a, b});
    while (joined_to_[t] != t) t = joined_to_[t];
    return t;
  }

  static VertexRing starting_at(VertexRing ring, std::uint32_t first) {
    std::rotate(ring.begin(), std::ranges::find(ring, first), ring.end());
    return ring;
  }

  bool is_convex_at(const VertexRing& ring, std::size_t k) const {
    const Vec2& a = vertices_[ring[(k + ring.size() - 1) % ring.size()]];
    const Vec2& b = vertices_[ring[k]];
    const Vec2& c = vertices_[ring[(k + 1) % ring.size()]];
    return doubled_area(a, b, c) >= -kConvex * (b - a).norm() * (c - b).norm();
  }

  void join_across(std::uint32_t a, std::uint32_t b) {
    const std::uint32_t own = ring_left_of(a, b);
    const std::uint32_t other = ring_left_of(b, a);
    if (own == other) return;
    VertexRing ring = starting_at(rings_[own], b);
    const VertexRing rest = starting_at(rings_[other], a);
    if (ring.back() != a || rest.back() != b) return;
    const std::size_t at_a = ring.size() - 1;
    ring.insert(ring.end(), rest.begin() + 1, rest.end() - 1);
    VertexRing sorted = ring;
    std::ranges::sort(sorted);
    if (std::ranges::adjacent_find(sorted) != sorted.end()) return;
    if (!is_convex_at(ring, 0) || !is_convex_at(ring, at_a)) return;
    joined_to_[other] = own;
    rings_[own] = std::move(ring);
  }

  const std::vector<Vec2>& vertices_;
  std::vector<std::uint32_t> joined_to_;
  std::vector<VertexRing> rings_;
  std::map<Edge, std::uint32_t> left_of_;  ///< triangle on the left of each directed edge
};

}  // namespace

std::vector<Polygon> convex_decomposition(const std::vector<std::vector<Vec2>>& loops) {
  if (loops.size() == 1 && is_convex(loops.front(), 0.0)) return loops;
  const Triangulation triangulation(loops);
  return TriangleJoiner(triangulation).join_all();
}

Polygon convex_hull(std::vector<Vec2> points) {
  std::ranges::sort(points,
                    [](const Vec2& a, const Vec2& b) { return std::pair(a.x(), a.y()) < std::pair(b.x(), b.y()); });
  // Andrew's monotone chain, Inf. Process. Lett. 9, 216 (1979)
  Polygon hull;
  const auto add_chain = [&](const auto& chain) {
    const std::size_t start = hull.size();
    for (const Vec2& p : chain) {
      while (hull.size() >= start + 2 && doubled_area(hull[hull.size() - 2], hull.back(), p) <= 0.0) hull.pop_back();
      hull.push_back(p);
    }
    hull.pop_back();
  };
  add_chain(points);
  std::reverse(points.begin(), points.end());
  add_chain(points);
  return hull;
}

}  // namespace retrace::geometry
