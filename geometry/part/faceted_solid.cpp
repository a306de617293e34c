#include "geometry/part/faceted_solid.h"
#include "geometry/part/triangle_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <unordered_map>

namespace retrace::geometry {
namespace {

// Maximum deviation of points from planes and straight lines because of rounding errors, relative to the solid's size.
constexpr double kFlatTolerance = 1e-10;

using Loop = std::vector<std::uint32_t>;

/// Index of a half-edge. Half-edge 3 t + k is from corner k of triangle t to the next corner.
using HalfEdge = std::uint32_t;
using EdgeMap = std::unordered_map<std::uint64_t, HalfEdge>;

/// Returns all directed edges, or nothing if an edge occurs twice.
std::optional<EdgeMap> edges_of(const BoundaryMesh& mesh) {
  EdgeMap edges;
  edges.reserve(3 * mesh.triangles.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::uint32_t k = 0; k < 3; ++k)
      if (!edges.emplace(directed_edge(mesh.triangles[t][k], mesh.triangles[t][(k + 1) % 3]), 3 * t + k).second)
        return std::nullopt;
  return edges;
}

bool each_has_a_twin(const EdgeMap& edges) {
  return std::all_of(edges.begin(), edges.end(),
                     [&](const auto& entry) { return edges.contains((entry.first << 32) | (entry.first >> 32)); });
}

Vec3 twice_area(const BoundaryMesh& mesh, std::uint32_t triangle) {
  const auto& t = mesh.triangles[triangle];
  const Vec3& a = mesh.vertices[t[0]];
  return (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a);
}

class FaceBuilder {
 public:
  FaceBuilder(const BoundaryMesh& mesh, const EdgeMap& edges) : mesh_(mesh), region_(mesh.triangles.size(), kNone) {
    twin_.resize(3 * mesh.triangles.size());
    for (const auto& [passed, half_edge] : edges) twin_[half_edge] = edges.at((passed << 32) | (passed >> 32));
    Vec3 lower = Vec3::Constant(INFINITY);
    Vec3 upper = Vec3::Constant(-INFINITY);
    for (const Vec3& p : mesh.vertices) {
      lower = lower.cwiseMin(p);
      upper = upper.cwiseMax(p);
    }
    tolerance_mm_ = kFlatTolerance * (upper - lower).norm();
  }

  FacetedSolid build() {
    grow_regions();
    for (std::uint32_t r = 0; r < members_.size(); ++r) {
      std::vector<Loop> loops = loops_of(r);
      // The list is copied. A reference would become invalid, because splitting a region adds regions to members_
      // below.
      const std::vector<std::uint32_t> members = members_[r];
      if (is_simple(loops) || members.size() == 1) {
        add_face(r, std::move(loops));
        continue;
      }
      for (const std::uint32_t t : members) {
        region_[t] = static_cast<std::uint32_t>(members_.size());
        members_.push_back({t});
      }
    }
    drop_straight_vertices();
    drop_unused_vertices();
    return std::move(solid_);
  }

 private:
  static constexpr std::uint32_t kNone = UINT32_MAX;

  /// Grows regions from the largest triangles first, because their planes are the most accurate.
  void grow_regions() {
    std::vector<std::uint32_t> order(mesh_.triangles.size());
    std::iota(order.begin(), order.end(), 0U);
    std::vector<double> size(order.size());
    for (const std::uint32_t t : order) size[t] = twice_area(mesh_, t).norm();
    std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return size[a] > size[b]; });
    for (const std::uint32_t seed : order)
      if (region_[seed] == kNone) grow(seed);
  }

  void grow(std::uint32_t seed) {
    const Vec3 normal = twice_area(mesh_, seed).normalized();
    const double offset = normal.dot(mesh_.vertices[mesh_.triangles[seed][0]]);
    const auto r = static_cast<std::uint32_t>(members_.size());
    region_[seed] = r;
    std::vector<std::uint32_t> members = {seed};
    for (std::size_t next = 0; next < members.size(); ++next)
      for (std::uint32_t k = 0; k < 3; ++k) {
        const std::uint32_t t = twin_[3 * members[next] + k] / 3;
        if (region_[t] != kNone || !lies_in(t, normal, offset)) continue;
        region_[t] = r;
        members.push_back(t);
      }
    members_.push_back(std::move(members));
  }

  bool lies_in(std::uint32_t triangle, const Vec3& normal, double offset) const {
    for (const std::uint32_t v : mesh_.triangles[triangle])
      if (std::abs(normal.dot(mesh_.vertices[v]) - offset) > tolerance_mm_) return false;
    return twice_area(mesh_, triangle).dot(normal) > 0.0;
  }

  std::uint32_t from(HalfEdge h) const { return mesh_.triangles[h / 3][h % 3]; }
  static HalfEdge after(HalfEdge h) { return h % 3 == 2 ? h - 2 : h + 1; }
  bool is_border(HalfEdge h) const { return region_[twin_[h] / 3] != region_[h / 3]; }

  /// Returns the borders of a region, each with the region on its left.
  std::vector<Loop> loops_of(std::uint32_t r) const {
    std::vector<Loop> loops;
    std::unordered_map<HalfEdge, bool> done;
    for (const std::uint32_t t : members_[r])
      for (std::uint32_t k = 0; k < 3; ++k) {
        const HalfEdge first = 3 * t + k;
        if (!is_border(first) || done[first]) continue;
        Loop loop;
        HalfEdge h = first;
        do {
          done[h] = true;
          loop.push_back(from(h));
          // Rotate around the end vertex, through the region, until the next border edge.
          for (h = after(h); !is_border(h); h = after(twin_[h])) {
          }
        } while (h != first);
        loops.push_back(std::move(loop));
      }
    return loops;
  }

  static bool is_simple(const std::vector<Loop>& loops) {
    Loop all;
    for (const Loop& loop : loops) all.insert(all.end(), loop.begin(), loop.end());
    std::sort(all.begin(), all.end());
    return std::adjacent_find(all.begin(), all.end()) == all.end();
  }

  void add_face(std::uint32_t r, std::vector<Loop> loops) {
    SolidFace face;
    face.normal = twice_area(mesh_, members_[r].front()).normalized();
    face.role = mesh_.roles[members_[r].front()];
    const auto is_outline = [&](const Loop& loop) {
      Vec3 twice = Vec3::Zero();
      for (std::size_t k = 1; k + 1 < loop.size(); ++k)
        twice += (mesh_.vertices[loop[k]] - mesh_.vertices[loop[0]])
                     .cross(mesh_.vertices[loop[k + 1]] - mesh_.vertices[loop[0]]);
      return twice.dot(face.normal) > 0.0;
    };
    std::stable_partition(loops.begin(), loops.end(), is_outline);
    face.loops = std::move(loops);
    solid_.faces.push_back(std::move(face));
  }

  /// Removes vertices that only two faces share and that are within a straight edge of both faces.
  void drop_straight_vertices() {
    std::vector<std::uint8_t> faces_at(mesh_.vertices.size(), 0);
    std::vector<std::uint8_t> straight_at(mesh_.vertices.size(), 0);
    for (const SolidFace& face : solid_.faces)
      for (const Loop& loop : face.loops)
        for (std::size_t i = 0; i < loop.size(); ++i) {
          const std::uint32_t v = loop[i];
          if (faces_at[v] < 3) ++faces_at[v];
          if (straight_at[v] < 3 && is_straight(loop, i)) ++straight_at[v];
        }
    for (SolidFace& face : solid_.faces)
      for (Loop& loop : face.loops)
        std::erase_if(loop, [&](std::uint32_t v) { return faces_at[v] == 2 && straight_at[v] == 2; });
  }

  bool is_straight(const Loop& loop, std::size_t i) const {
    const Vec3& before = mesh_.vertices[loop[(i + loop.size() - 1) % loop.size()]];
    const Vec3 along = mesh_.vertices[loop[(i + 1) % loop.size()]] - before;
    const Vec3 to = mesh_.vertices[loop[i]] - before;
    return along.dot(to) > 0.0 && along.cross(to).norm() <= tolerance_mm_ * along.norm();
  }

  void drop_unused_vertices() {
    std::vector<std::uint32_t> number(mesh_.vertices.size(), kNone);
    for (SolidFace& face : solid_.faces)
      for (Loop& loop : face.loops)
        for (std::uint32_t& v : loop) {
          if (number[v] == kNone) {
            number[v] = static_cast<std::uint32_t>(solid_.vertices.size());
            solid_.vertices.push_back(mesh_.vertices[v]);
          }
          v = number[v];
        }
  }

  const BoundaryMesh& mesh_;
  std::vector<HalfEdge> twin_;
  std::vector<std::uint32_t> region_;  ///< region of each triangle
  std::vector<std::vector<std::uint32_t>> members_;
  double tolerance_mm_ = 0.0;
  FacetedSolid solid_;
};

}  // namespace

double volume_mm3(const BoundaryMesh& mesh) {
  if (mesh.vertices.empty()) return 0.0;
  const Vec3& origin = mesh.vertices.front();  // an origin near the mesh avoids cancellation
  double six = 0.0;
  for (const auto& t : mesh.triangles)
    six += (mesh.vertices[t[0]] - origin).dot((mesh.vertices[t[1]] - origin).cross(mesh.vertices[t[2]] - origin));
  return six / 6.0;
}

double area_mm2(const BoundaryMesh& mesh) {
  double area = 0.0;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) area += 0.5 * twice_area(mesh, t).norm();
  return area;
}

bool is_closed_manifold(const BoundaryMesh& mesh) {
  const auto edges = edges_of(mesh);
  return edges && each_has_a_twin(*edges);
}

FacetedSolid faceted_solid(const BoundaryMesh& mesh) {
  const auto edges = edges_of(mesh);
  if (!edges || !each_has_a_twin(*edges))
    throw std::logic_error("faceted_solid: the mesh must be closed and touch itself along no edge");
  return FaceBuilder(mesh, *edges).build();
}

}  // namespace retrace::geometry
