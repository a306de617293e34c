#include "fabrication/job/cube_corner.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "core/angle.h"
#include "geometry/elements/element_cells.h"

namespace retrace::fabrication {

using geometry::Vec3;

Vec3 CubeCorner::apex_over(const Vec3& facets_mm) const {
  Eigen::Matrix3d planes;
  for (Eigen::Index k = 0; k < 3; ++k) planes.row(k) = normals[static_cast<std::size_t>(k)].transpose();
  return planes.inverse() * facets_mm;
}

double CubeCorner::largest_error_deg() const {
  double most = 0.0;
  for (std::size_t k = 0; k < 3; ++k)
    for (const auto& three : {normals, edges}) most = std::max(most, std::abs(three[k].dot(three[(k + 1) % 3])));
  return Angle::from_rad(std::asin(most)).deg();
}

CubeCorner cube_corner(const geometry::Element& element, const geometry::AngleErrors& errors, bool rotated) {
  CubeCorner corner;
  corner.depth_mm = geometry::element_depth_mm(element, errors);
  const geometry::Cell cell = geometry::element_cell(element, errors);
  for (std::size_t k = 0; k < 3; ++k) {
    // Convert from the part frame to the workpiece frame: x_w = y_part, y_w = -x_part.
    const geometry::Vec2 slope = (rotated ? -1.0 : 1.0) * cell.facets[k].plane.slope;
    corner.normals[k] = Vec3(-slope.y(), slope.x(), 1.0).normalized();
  }
  for (std::size_t k = 0; k < 3; ++k)
    corner.edges[k] = corner.normals[(k + 2) % 3].cross(corner.normals[k]).normalized();
  return corner;
}

CubeCorner blank_corner(const Job& job, std::size_t zone, bool rotated) {
  return cube_corner(blank_element(job, zone), angle_errors_of(job, zone), rotated);
}

}  // namespace retrace::fabrication
