#include "geometry/part/solid_mesh.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <utility>

namespace retrace::geometry {
namespace {

// Number of least-squares steps. Each step reduces the distance from the planes by the factor kStepDamping.
constexpr int kSettlingSteps = 4;
constexpr double kStepDamping = 1e-4;

/// Turns the normals of the planes to the outside, which the triangles determine.
void orient_planes(SolidMesh& solid) {
  std::vector<Vec3> outward(solid.planes.size(), Vec3::Zero());
  const std::vector<Vec3>& p = solid.mesh.vertices;
  for (std::size_t t = 0; t < solid.mesh.triangles.size(); ++t) {
    const auto& [a, b, c] = solid.mesh.triangles[t];
    outward[solid.face_of[t]] += (p[b] - p[a]).cross(p[c] - p[a]);
  }
  for (std::size_t face = 0; face < outward.size(); ++face) {
    std::optional<FacetPlane>& plane = solid.planes[face];
    if (plane && plane->normal.dot(outward[face]) < 0.0) *plane = {-plane->normal, -plane->offset_mm};
  }
}

}  // namespace

std::size_t SolidMesh::curved_faces() const {
  return static_cast<std::size_t>(
      std::count_if(planes.begin(), planes.end(), [](const auto& plane) { return !plane.has_value(); }));
}

double snap_to_face_planes(SolidMesh& solid, double max_move_mm) {
  orient_planes(solid);
  std::vector<std::pair<std::uint32_t, std::uint32_t>> faces_of_vertices;
  for (std::size_t t = 0; t < solid.mesh.triangles.size(); ++t)
    if (solid.planes[solid.face_of[t]])
      for (const std::uint32_t v : solid.mesh.triangles[t]) faces_of_vertices.emplace_back(v, solid.face_of[t]);
  std::sort(faces_of_vertices.begin(), faces_of_vertices.end());
  faces_of_vertices.erase(std::unique(faces_of_vertices.begin(), faces_of_vertices.end()), faces_of_vertices.end());
  double apart_mm = 0.0;
  for (std::size_t first = 0; first < faces_of_vertices.size();) {
    const std::uint32_t vertex = faces_of_vertices[first].first;
    std::size_t last = first;
    while (last < faces_of_vertices.size() && faces_of_vertices[last].first == vertex) ++last;
    const auto height = [&](std::size_t k, const Vec3& p) {
      return solid.planes[faces_of_vertices[k].second]->height(p);
    };
    Vec3 p = solid.mesh.vertices[vertex];
    for (int step = 0; step < kSettlingSteps; ++step) {
      Eigen::Matrix3d matrix = kStepDamping * Eigen::Matrix3d::Identity();
      Vec3 right_side = Vec3::Zero();
      for (std::size_t k = first; k < last; ++k) {
        const Vec3& normal = solid.planes[faces_of_vertices[k].second]->normal;
        matrix += normal * normal.transpose();
        right_side -= height(k, p) * normal;
      }
      p += matrix.ldlt().solve(right_side);
    }
    if ((p - solid.mesh.vertices[vertex]).norm() <= max_move_mm) solid.mesh.vertices[vertex] = p;
    for (std::size_t k = first; k < last; ++k)
      apart_mm = std::max(apart_mm, std::abs(height(k, solid.mesh.vertices[vertex])));
    first = last;
  }
  return apart_mm;
}

}  // namespace retrace::geometry
