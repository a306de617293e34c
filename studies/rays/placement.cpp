#include "studies/rays/placement.h"

#include <Eigen/Geometry>
#include <cmath>

#include "core/error.h"
#include "raytrace/light/light_setup.h"
#include "raytrace/light/optics.h"
#include "raytrace/sampling/entrance_sampler.h"

namespace retrace::studies {
namespace {

constexpr double kUsualDistanceMm = 10.0;

Vec3 to_vec(const std::array<double, 3>& numbers) {
  return {numbers[0], numbers[1], numbers[2]};
}

/// Returns the axes of a source whose z axis points along `forward`.
Eigen::Matrix3d aimed(const Vec3& forward) {
  Vec3 right = Vec3::UnitX() - forward.x() * forward;
  if (right.norm() < 1e-9) right = Vec3::UnitY() - forward.y() * forward;
  right.normalize();
  Eigen::Matrix3d turn;
  turn << right, forward.cross(right), forward;
  return turn;
}

}  // namespace

Vec3 centre_of_face(const geometry::Part& part) {
  const geometry::Vec2 middle = raytrace::EntranceSampler(part).centre_mm();
  return {middle.x(), middle.y(), part.thickness_mm};
}

RayPlacement placement_of(const RayPlacementRequest& request, const geometry::Part& part, double in_front_mm) {
  RayPlacement placement;
  std::optional<Vec3> aim;
  std::optional<Vec3> way;  ///< vector from the source to the point at which it is aimed
  if (request.is_by_angles()) {
    const double incidence = request.incidence_deg.value_or(0.0);
    const double azimuth = request.azimuth_deg.value_or(0.0);
    const double usual_mm = kUsualDistanceMm + in_front_mm / std::cos(Angle::from_deg(incidence).rad());
    const double distance = request.distance_mm.value_or(usual_mm);
    aim = centre_of_face(part);
    const raytrace::Illumination light{Angle::from_deg(incidence), Angle::from_deg(azimuth), raytrace::kUnpolarised};
    way = -distance * raytrace::direction_to_source(light);
    placement.at_mm = *aim - *way;
  }
  if (request.at_mm) placement.at_mm = to_vec(*request.at_mm);
  if (request.aim_mm) aim = to_vec(*request.aim_mm);
  if (!aim) return placement;
  if (!way || request.aim_mm) way = *aim - placement.at_mm;
  if (!(way->norm() > 0.0)) throw InputError(Field{"aim_mm"}, "must differ from the position of the source");
  placement.part_from_source = aimed(way->normalized());
  return placement;
}

}  // namespace retrace::studies
