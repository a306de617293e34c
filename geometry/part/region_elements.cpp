#include "geometry/part/region_elements.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "geometry/part/triangle_mesh.h"

namespace retrace::geometry {
namespace {

// Two regions that meet at a concave edge are treated as parts of one curved facet if the angle between their normals
// is at most this value. Form errors cause angles of a few minutes of arc.
constexpr double kSmoothBend_rad = std::numbers::pi / 180.0;
// The common edges of two regions are ignored if their total length is at most this value. The value is in multiples of
// the maximum error of a vertex. Rounding makes the directions of such short edges uncertain.
constexpr double kRoundingsOfEdge = 16.0;

/// Two adjacent regions and the length of the edges that join them. An edge joins its two regions into one element if
/// the solid is convex at the edge, or if the edge is within a curved facet.
struct Joint {
  double length_mm = 0.0;  ///< total length of the joining edges
  std::uint32_t a = 0;
  std::uint32_t b = 0;
};

/// Returns the angle in radians between the outward normals on both sides of an edge. The angle is positive if the
/// solid is convex at the edge.
/// \param along direction of the edge; region `left` is on the left of the edge as seen from outside
double bend_rad(const FacetPlane& left, const FacetPlane& right, const Vec3& along) {
  return std::atan2(left.normal.cross(right.normal).dot(along.normalized()), left.normal.dot(right.normal));
}

std::vector<Joint> joints_of(const std::vector<Vec3>& vertices, const RegionTriangles& mesh,
                             const std::vector<FacetPlane>& planes, double rounding_mm) {
  std::unordered_map<std::uint64_t, std::uint32_t> region_left_of;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k)
      region_left_of.emplace(directed_edge(mesh.triangles[t][k], mesh.triangles[t][(k + 1) % 3]), mesh.region_of[t]);
  std::map<std::pair<std::uint32_t, std::uint32_t>, double> lengths;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t from = mesh.triangles[t][k];
      const std::uint32_t to = mesh.triangles[t][(k + 1) % 3];
      const std::uint32_t own = mesh.region_of[t];
      const auto other = region_left_of.find(directed_edge(to, from));
      if (other == region_left_of.end() || own >= other->second) continue;
      const Vec3 along = vertices[to] - vertices[from];
      if (bend_rad(planes[own], planes[other->second], along) > -kSmoothBend_rad)
        lengths[{own, other->second}] += along.norm();
    }
  std::vector<Joint> joints;
  for (const auto& [regions, length] : lengths)
    if (length > kRoundingsOfEdge * rounding_mm) joints.push_back({length, regions.first, regions.second});
  std::sort(joints.begin(), joints.end(), [](const Joint& one, const Joint& two) {
    return std::tuple(-one.length_mm, one.a, one.b) < std::tuple(-two.length_mm, two.a, two.b);
  });
  return joints;
}

/// Disjoint sets of regions (union-find).
class Sets {
 public:
  explicit Sets(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0U); }

  std::uint32_t of(std::uint32_t k) {
    while (parent_[k] != k) k = parent_[k] = parent_[parent_[k]];
    return k;
  }
  void join(std::uint32_t a, std::uint32_t b) { parent_[std::max(of(a), of(b))] = std::min(of(a), of(b)); }

 private:
  std::vector<std::uint32_t> parent_;
};

}  // namespace

std::vector<std::uint32_t> elements_of_regions(const std::vector<Vec3>& vertices, const RegionTriangles& mesh,
                                               const std::vector<FacetPlane>& planes,
                                               const std::vector<FacetRole>& roles, double rounding_mm) {
  const std::vector<Joint> joints = joints_of(vertices, mesh, planes, rounding_mm);
  Sets sets(planes.size());
  std::vector<bool> is_settled(planes.size());
  for (std::size_t r = 0; r < planes.size(); ++r) is_settled[r] = roles[r] != FacetRole::inner_wall;
  for (const Joint& joint : joints)
    if (is_settled[joint.a] && is_settled[joint.b]) sets.join(joint.a, joint.b);
  // Each wall joins the element with which it shares its longest edge. A wall that shares edges only with other walls
  // joins an element after one of these walls has joined.
  for (bool has_changed = true; has_changed;) {
    has_changed = false;
    for (const Joint& joint : joints) {
      if (is_settled[joint.a] == is_settled[joint.b]) continue;
      sets.join(joint.a, joint.b);
      is_settled[joint.a] = is_settled[joint.b] = true;
      has_changed = true;
    }
  }
  std::map<std::uint32_t, std::uint32_t> number;
  std::vector<std::uint32_t> elements;
  for (std::uint32_t r = 0; r < planes.size(); ++r)
    elements.push_back(number.try_emplace(sets.of(r), static_cast<std::uint32_t>(number.size())).first->second);
  return elements;
}

}  // namespace retrace::geometry
