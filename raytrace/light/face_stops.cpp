#include "raytrace/light/face_stops.h"

#include <algorithm>
#include <utility>

namespace retrace::raytrace {

FaceStops::Opening::Opening(geometry::Polygon polygon)
    : outline(std::move(polygon)), centre_mm(geometry::bounding_box(outline).centre()) {
  inner_radius_mm = (outline.front() - centre_mm).norm();
  for (std::size_t k = 0; k < outline.size(); ++k) {
    const Vec2 from = outline[k] - centre_mm;
    const Vec2 along = (outline[(k + 1) % outline.size()] - outline[k]).normalized();
    inner_radius_mm = std::min(inner_radius_mm, from.x() * along.y() - from.y() * along.x());
    outer_radius_mm = std::max(outer_radius_mm, from.norm());
  }
}

bool FaceStops::Opening::contains(const Vec2& at_mm) const {
  const double radius_mm = (at_mm - centre_mm).norm();
  if (radius_mm < inner_radius_mm) return true;
  return radius_mm <= outer_radius_mm && geometry::contains(outline, at_mm);
}

FaceStops::FaceStops(const geometry::Part& part, const Vec2& centre_mm) : thickness_mm_(part.thickness_mm) {
  if (!part.clear_face.empty()) clear_face_.emplace(geometry::moved(part.clear_face, -centre_mm));
  if (!part.mount) return;
  mount_.emplace(geometry::moved(part.mount->outline, -centre_mm));
  edge_height_mm_ = part.thickness_mm + part.mount->height_mm;
}

bool FaceStops::passes_mount(const Vec3& position, const Vec3& direction) const {
  if (!mount_) return true;
  if (direction.z() == 0.0) return false;
  const double t = (edge_height_mm_ - position.z()) / direction.z();
  return mount_->contains((position + t * direction).head<2>());
}

geometry::Polygon FaceStops::face_through_mount(const Vec3& direction) const {
  const Vec2 across = direction.head<2>() / direction.z();
  return geometry::moved(mount_->outline, -(edge_height_mm_ - thickness_mm_) * across);
}

}  // namespace retrace::raytrace
