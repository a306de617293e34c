#include "geometry/part/cover_polygons.h"

#include <algorithm>

#include "geometry/centroid.h"
#include "geometry/plane_math.h"

namespace retrace::geometry {
namespace {

/// Maximum distance between a side of a polygon and a vertex that is regarded as on this side, as a fraction of an
/// element's size.
constexpr double kOnSideFraction = 1e-8;

/// Returns the vertices along the border of a convex polygon, counter-clockwise: its corners and all vertices on its
/// sides.
/// \param tolerance_mm maximum distance between a side and a vertex that is regarded as on this side
std::vector<std::uint32_t> border_vertices(const Polygon& polygon, const std::vector<PlacedVertex>& vertices,
                                           double tolerance_mm) {
  std::vector<std::uint32_t> ring;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vec2 side = polygon[(k + 1) % polygon.size()] - polygon[k];
    const double length = side.norm();
    const Vec2 along = side / length;
    std::vector<std::pair<double, std::uint32_t>> on_side;
    for (const auto& [position, vertex] : vertices) {
      const Vec2 to = position - polygon[k];
      const double at = along.dot(to);
      const double away = plane::cross(along, to);
      // The end of a side is the start of the next one.
      if (std::abs(away) <= tolerance_mm && at >= -tolerance_mm && at < length - tolerance_mm)
        on_side.emplace_back(at, vertex);
    }
    std::ranges::sort(on_side);
    for (const auto& [at, vertex] : on_side)
      if (ring.empty() || ring.back() != vertex) ring.push_back(vertex);
  }
  if (ring.size() > 1 && ring.front() == ring.back()) ring.pop_back();
  return ring;
}

}  // namespace

void add_cover(BoundaryMesh& mesh, const std::vector<Polygon>& polygons, const std::vector<PlacedVertex>& vertices,
               double size_mm, FacetRole role, bool faces_up) {
  for (const Polygon& polygon : polygons) {
    std::vector<std::uint32_t> ring = border_vertices(polygon, vertices, kOnSideFraction * size_mm);
    if (ring.size() < 3) continue;
    if (!faces_up) std::reverse(ring.begin(), ring.end());
    const auto hub = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.push_back(ring_centroid(mesh.vertices, ring));
    for (std::size_t i = 0; i < ring.size(); ++i) {
      mesh.triangles.push_back({hub, ring[i], ring[(i + 1) % ring.size()]});
      mesh.roles.push_back(role);
    }
  }
}

}  // namespace retrace::geometry
