#include "raytrace/observers/photometric_geometry.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "geometry/direction.h"

namespace retrace::raytrace {
namespace {

using geometry::Vec3, geometry::rotation_about, std::numbers::pi;

// Directions are treated as parallel if the sine of their angle is less than this value.
constexpr double kParallel = 1e-14;

/// Returns the rotation from the part frame to the laboratory frame. In the laboratory, x is the first axis of the
/// goniometer, y points from the source towards the observer, and z points to the source.
Eigen::Matrix3d lab_from_part(const PhotometricGeometry& g) {
  return rotation_about(Vec3::UnitX(), Angle::from_rad(-g.beta1.rad())) * rotation_about(Vec3::UnitY(), g.beta2) *
         rotation_about(Vec3::UnitZ(), g.epsilon);
}

/// Returns the angle in the range (-pi, pi]. A value within 1e-12 of -pi becomes pi, so that rounding errors do not
/// decide between -pi and pi.
Angle wrapped(double angle_rad) {
  double turned = std::remainder(angle_rad, 2.0 * pi);
  if (turned < 1e-12 - pi) turned += 2.0 * pi;
  return Angle::from_rad(turned);
}

double angle_between(const Vec3& a, const Vec3& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

}  // namespace

PhotometricGeometry geometry_from(const EntranceAngles& entrance, Angle alpha, Angle epsilon) {
  return {alpha, Angle::from_rad(-entrance.v.rad()), Angle::from_rad(-entrance.h.rad()), epsilon};
}

EntranceAngles entrance_angles(const PhotometricGeometry& geometry) {
  return {Angle::from_rad(-geometry.beta1.rad()), Angle::from_rad(-geometry.beta2.rad())};
}

PhotometricDirections directions_of(const PhotometricGeometry& angles) {
  const Eigen::Matrix3d part_from_lab = lab_from_part(angles).transpose();
  const Vec3 to_observer = geometry::direction_at(angles.alpha, Angle::from_deg(90.0));
  return {(part_from_lab * Vec3::UnitZ()).normalized(), (part_from_lab * to_observer).normalized()};
}

PhotometricGeometry geometry_of(const PhotometricDirections& directions) {
  const Vec3& s = directions.to_source;
  Vec3 up = directions.to_observer - directions.to_observer.dot(s) * s;
  if (up.norm() < kParallel) up = Vec3::UnitY() - s.y() * s;
  if (up.norm() < kParallel) up = Vec3::UnitX() - s.x() * s;
  up.normalize();
  const Vec3 first = up.cross(s);
  const Vec3 normal(first.z(), up.z(), s.z());  // normal of the part in the laboratory frame
  PhotometricGeometry geometry;
  geometry.alpha = Angle::from_rad(angle_between(s, directions.to_observer));
  geometry.beta2 = Angle::from_rad(std::atan2(normal.x(), std::hypot(normal.y(), normal.z())));
  geometry.beta1 = wrapped(std::atan2(normal.y(), normal.z()));
  // The second axis is perpendicular to the normal and the first axis. epsilon is the angle from the second axis to the
  // datum mark.
  const Vec3 second = Vec3::UnitZ().cross(first);
  geometry.epsilon = wrapped(std::atan2(second.x(), second.y()));
  return geometry;
}

SourceAngles source_angles(const Vec3& to_source) {
  const double across = to_source.head<2>().norm();
  return {Angle::from_rad(std::atan2(across, to_source.z())),
          Angle::from_rad(across > kParallel ? std::atan2(to_source.y(), to_source.x()) : 0.0)};
}

ReturnFrame return_frame(const PhotometricGeometry& geometry) {
  const Eigen::Matrix3d part_from_lab = lab_from_part(geometry).transpose();
  return {part_from_lab * Vec3::UnitZ(), part_from_lab * Vec3::UnitX(), part_from_lab * Vec3::UnitY()};
}

namespace {

bool is_z(const Vec3& axis) {
  return axis.x() == 0.0 && axis.y() == 0.0;
}

/// Returns the rotation about a horizontal axis that takes z to the reference axis.
Eigen::Matrix3d part_from_reference(const Vec3& reference_axis) {
  const double sine = reference_axis.head<2>().norm();
  const Vec3 about(-reference_axis.y() / sine, reference_axis.x() / sine, 0.0);
  return rotation_about(about, Angle::from_rad(std::atan2(sine, reference_axis.z())));
}

}  // namespace

PhotometricDirections in_part_frame(const PhotometricDirections& directions, const Vec3& reference_axis) {
  if (is_z(reference_axis)) return directions;
  const Eigen::Matrix3d rotation = part_from_reference(reference_axis);
  return {rotation * directions.to_source, rotation * directions.to_observer};
}

ReturnFrame in_part_frame(const ReturnFrame& frame, const Vec3& reference_axis) {
  if (is_z(reference_axis)) return frame;
  const Eigen::Matrix3d rotation = part_from_reference(reference_axis);
  return {rotation * frame.to_source, rotation * frame.right, rotation * frame.up};
}

PhotometricDirections in_reference_frame(const PhotometricDirections& directions, const Vec3& reference_axis) {
  if (is_z(reference_axis)) return directions;
  const Eigen::Matrix3d rotation = part_from_reference(reference_axis).transpose();
  return {rotation * directions.to_source, rotation * directions.to_observer};
}

Angle viewing_angle(const PhotometricGeometry& geometry, const Vec3& reference_axis) {
  return Angle::from_rad(
      angle_between(Vec3::UnitZ(), in_part_frame(directions_of(geometry), reference_axis).to_observer));
}

}  // namespace retrace::raytrace
