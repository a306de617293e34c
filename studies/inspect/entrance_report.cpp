#include "studies/inspect/entrance_report.h"

#include <cmath>
#include <limits>
#include <memory>

#include "core/angle.h"
#include "raytrace/faces/entrance_face.h"

namespace retrace::studies {
namespace {

using geometry::Vec2, geometry::Vec3;

constexpr int kPoints = 400;

/// Returns the profile of the face along an axis.
EntranceReport::Profile profile_along(Eigen::Index axis, const geometry::EntranceHeights& height,
                                      const geometry::Part& part, const Vec2& centre) {
  const geometry::Rectangle box = geometry::bounding_box(part.outline);
  EntranceReport::Profile profile;
  for (int k = 0; k <= kPoints; ++k) {
    Vec2 place = centre;
    place[axis] = box.lower[axis] + (1e-9 + (1.0 - 2e-9) * k / kPoints) * box.size()[axis];
    profile.position_mm.push_back(place[axis]);
    profile.height_mm.push_back(height(place));
  }
  return profile;
}

}  // namespace

geometry::EntranceHeights heights_of(const geometry::Entrance& entrance, const geometry::Part& part) {
  const geometry::Rectangle box = geometry::bounding_box(part.outline);
  const Vec2 centre = 0.5 * (box.lower + box.upper);
  // Heights are measured by rays from above, for surfaces as well as meshes.
  const std::shared_ptr<const raytrace::EntranceFace> face = raytrace::make_entrance_face(entrance, part, centre);
  return [face, centre](const Vec2& point_mm) {
    raytrace::SurfaceRay ray;
    ray.origin = Vec3(point_mm.x() - centre.x(), point_mm.y() - centre.y(), face->highest_mm() + 1.0);
    ray.direction = -Vec3::UnitZ();
    ray.inside = false;
    const auto hit = face->first_hit(ray);
    return hit ? ray.origin.z() - hit->hit.t : std::numeric_limits<double>::quiet_NaN();
  };
}

EntranceReport report_entrance(const geometry::Entrance& entrance, const geometry::Part& part) {
  const geometry::Rectangle box = geometry::bounding_box(part.outline);
  const Vec2 centre = 0.5 * (box.lower + box.upper);
  const geometry::EntranceHeights height = heights_of(entrance, part);
  EntranceReport report;
  report.range = geometry::entrance_range(entrance, part.outline);
  report.steepest_deg = Angle::from_rad(std::atan(report.range.steepest_slope)).deg();
  report.along_x = profile_along(0, height, part, centre);
  report.along_y = profile_along(1, height, part, centre);
  return report;
}

}  // namespace retrace::studies
