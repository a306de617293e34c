#include "raytrace/observers/camera_face.h"

#include <Eigen/Geometry>
#include <cmath>
#include <optional>

#include "raytrace/observers/camera_rays.h"
#include "raytrace/sampling/entrance_sampler.h"

namespace retrace::raytrace {

FacePoint face_point(const geometry::Part& part, const CameraScene& scene, const Vec2& local_mm) {
  FacePoint point{local_mm, {local_mm.x(), local_mm.y(), part.thickness_mm}, Eigen::Matrix3d::Identity()};
  if (!scene.film || !scene.film->radius_mm) return point;
  const double radius = *scene.film->radius_mm;
  const double angle = local_mm.x() / radius;
  const Vec3 normal(std::sin(angle), 0.0, std::cos(angle));
  point.world_mm = Vec3(0.0, local_mm.y(), part.thickness_mm - radius) + radius * normal;
  point.world_from_local = axes_of_film(normal);
  return point;
}

geometry::Rectangle visible_face(const geometry::Part& part, const CameraScene& scene) {
  // Number of points of the picture along each side at which the visible area is searched. The result is enlarged by
  // one step between these points, and then limited to the face.
  constexpr int kPoints = 33;
  geometry::Rectangle face;
  if (scene.film) {
    const Vec2 half = 0.5 * Vec2(scene.film->width_mm, scene.film->height_mm);
    face = {-half, half};
  } else {
    face = geometry::moved(geometry::bounding_box(part.outline), -EntranceSampler(part).centre_mm());
  }
  const Vec2 size = 2.0 * face.upper.cwiseAbs().cwiseMax(face.lower.cwiseAbs());
  const Film film = scene.film.value_or(Film{size.x(), size.y(), {}});
  const Lens lens(scene.view);
  std::optional<geometry::Rectangle> seen;
  const double columns = static_cast<double>(scene.view.columns);
  const double rows = static_cast<double>(scene.view.rows);
  for (int k = 0; k < kPoints * kPoints; ++k) {
    const Vec2 at(columns * (k % kPoints) / (kPoints - 1), rows * (k / kPoints) / (kPoints - 1));
    const Contact contact = contact_with(film, part.thickness_mm, lens.ray(at, Vec2::Zero()));
    if (contact.kind != Contact::Kind::face) continue;
    const Vec2 local = contact.local.head<2>();
    if (!seen) seen = geometry::Rectangle{local, local};
    seen->lower = seen->lower.cwiseMin(local);
    seen->upper = seen->upper.cwiseMax(local);
  }
  if (!seen) return face;
  const Vec2 step = scene.view.width_mm * Vec2(1.0, rows / columns) / (kPoints - 1);
  seen->lower = (seen->lower - step).cwiseMax(face.lower);
  seen->upper = (seen->upper + step).cwiseMin(face.upper);
  return *seen;
}

}  // namespace retrace::raytrace
