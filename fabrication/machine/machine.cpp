#include "fabrication/machine/machine.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <optional>

#include "core/error.h"

namespace retrace::fabrication {
namespace {

using geometry::Vec3;

/// Returns the matrix whose columns are the directions of the linear axes.
Eigen::Matrix3d linear_directions(const Machine& machine) {
  Eigen::Matrix3d directions;
  directions << machine.x.direction.value, machine.y.direction.value, machine.z.direction.value;
  return directions;
}

Eigen::Matrix3d turn(const RotaryAxis& axis, double word_deg) {
  return rotation_about(axis.direction.value, Angle::from_deg(axis.sign.value * word_deg));
}

/// Returns the rotation about the line of a rotary axis, for a position of this axis.
RigidMotion turn_about_line(const RotaryAxis& axis, double word_deg) {
  const Eigen::Matrix3d rotation = turn(axis, word_deg);
  return {rotation, axis.point_mm.value - rotation * axis.point_mm.value};
}

double wrapped_deg(double deg) {
  return deg - 360.0 * std::round(deg / 360.0);
}

/// Adds full turns to an angle so that it is as close as possible to `near_deg`.
double nearest_turn(double value_deg, double near_deg) {
  return near_deg + wrapped_deg(value_deg - near_deg);
}

/// Returns the angle between the projections of `from` and `to` onto the plane perpendicular to `axis`.
double angle_about(const Vec3& axis, const Vec3& from, const Vec3& to) {
  const Vec3 a = from - axis * axis.dot(from);
  const Vec3 b = to - axis * axis.dot(to);
  return std::atan2(axis.dot(a.cross(b)), a.dot(b));
}

double to_deg(double rad) {
  return Angle::from_rad(rad).deg();
}

}  // namespace

Eigen::Matrix3d rotation_about(const Vec3& axis, Angle angle) {
  const double c = std::cos(angle.rad());
  const double s = std::sin(angle.rad());
  Eigen::Matrix3d cross;
  cross << 0.0, -axis.z(), axis.y(), axis.z(), 0.0, -axis.x(), -axis.y(), axis.x(), 0.0;
  return c * Eigen::Matrix3d::Identity() + s * cross + (1.0 - c) * axis * axis.transpose();
}

RotaryPose rotary_pose(const Machine& machine, const AxisPositions& axes) {
  return {machine.tilt == Tilt::table ? axes.a_deg : axes.b_deg, axes.c_deg};
}

RigidMotion machine_from_workpiece(const Machine& machine, const RotaryPose& pose) {
  const RigidMotion c = turn_about_line(machine.c, pose.c_deg);
  const RigidMotion tilt = machine.tilt == Tilt::table ? turn_about_line(machine.a, pose.a_deg)
                                                       : turn_about_line(machine.a, pose.a_deg).inverse();
  return {tilt.rotation * c.rotation, tilt.rotation * c.translation_mm + tilt.translation_mm};
}

Vec3 machine_point(const Machine& machine, const AxisPositions& axes) {
  const Vec3 point = linear_directions(machine) * Vec3(axes.x_mm, axes.y_mm, axes.z_mm);
  const Vec3 turned = machine.tilt == Tilt::table ? point : Vec3(turn(machine.a, axes.b_deg).transpose() * point);
  return turned + machine.mount.offset_mm.value;
}

std::array<double, 3> linear_words(const Machine& machine, const Vec3& machine_point_mm, const RotaryPose& pose) {
  return axis_change_along(machine, machine_point_mm - machine.mount.offset_mm.value, pose);
}

std::array<double, 3> axis_change_along(const Machine& machine, const Vec3& direction, const RotaryPose& pose) {
  const Vec3 along = machine.tilt == Tilt::table ? direction : Vec3(turn(machine.a, pose.a_deg) * direction);
  const Vec3 words = linear_directions(machine).partialPivLu().solve(along);
  return {words.x(), words.y(), words.z()};
}

Eigen::Matrix3d tool_rotation(const Machine& machine) {
  const Vec3& turn_deg = machine.mount.rotation_deg.value;
  const double angle_deg = turn_deg.norm();
  if (angle_deg == 0.0) return Eigen::Matrix3d::Identity();
  return rotation_about(turn_deg / angle_deg, Angle::from_deg(angle_deg));
}

Vec3 edge_direction(const Machine& machine) {
  return tool_rotation(machine) * machine.x.direction.value;
}

ToolPose forward(const Machine& machine, const AxisPositions& axes) {
  const RigidMotion motion = machine_from_workpiece(machine, rotary_pose(machine, axes));
  return {motion.inverse().point(machine_point(machine, axes)), motion.rotation.transpose()};
}

AxisPositions inverse(const Machine& machine, const Vec3& reference_mm, const RotaryPose& pose) {
  const Vec3 point = machine_from_workpiece(machine, pose).point(reference_mm);
  const std::array<double, 3> words = linear_words(machine, point, pose);
  const bool is_table = machine.tilt == Tilt::table;
  return {words[0], words[1], words[2], is_table ? pose.a_deg : 0.0, pose.c_deg, is_table ? 0.0 : pose.a_deg};
}

Vec3 plunged_normal(const Machine& machine) {
  if (machine.tilt == Tilt::table) return edge_direction(machine).cross(machine.z.direction.value).normalized();
  return tool_rotation(machine) * machine.z.direction.value.cross(machine.y.direction.value).normalized();
}

Vec3 horizontal_direction(const Machine& machine) {
  return machine.tilt == Tilt::table ? edge_direction(machine)
                                     : Vec3(tool_rotation(machine) * machine.y.direction.value);
}

PlungePose solve_plunge_pose(const Machine& machine, const Vec3& facet_normal, const Vec3& root,
                             const RotaryPose& near) {
  const Vec3 target = plunged_normal(machine);
  const Vec3& a_axis = machine.a.direction.value;
  // For positions relative to the tool, a head at angle B is equivalent to a table at angle -B.
  const double a_sign = machine.tilt == Tilt::table ? machine.a.sign.value : -machine.a.sign.value;
  const Vec3& c_axis = machine.c.direction.value;
  // A rotation about A does not change the component of the normal along A. Therefore C must give this component its
  // target value. With the normal split along and across C, the condition is p cos C + q sin C = r.
  const double along = c_axis.dot(facet_normal);
  const double p = a_axis.dot(facet_normal - c_axis * along);
  const double q = a_axis.dot(c_axis.cross(facet_normal));
  const double r = a_axis.dot(target) - a_axis.dot(c_axis) * along;
  const double amplitude = std::hypot(p, q);
  if (!(amplitude > std::abs(r)))
    throw InputError("machine " + machine.name + ": there are no positions of " +
                     std::string(1, machine.tilt_letter()) + " and C at which the tool can plunge this facet");
  const double middle = std::atan2(q, p);
  const double half_width = std::acos(r / amplitude);

  std::optional<PlungePose> best;
  double best_distance = 0.0;
  for (const double c_rad : {middle + half_width, middle - half_width}) {
    const Vec3 turned = rotation_about(c_axis, Angle::from_rad(c_rad)) * facet_normal;
    const double a_rad = angle_about(a_axis, turned, target);
    const RotaryPose pose = {nearest_turn(to_deg(a_rad) * a_sign, near.a_deg),
                             nearest_turn(to_deg(c_rad) * machine.c.sign.value, near.c_deg)};
    const double distance = std::hypot(pose.a_deg - near.a_deg, pose.c_deg - near.c_deg);
    if (best && distance >= best_distance) continue;
    const Vec3 turned_root = machine_from_workpiece(machine, pose).direction(root);
    best = PlungePose{pose, Angle::from_rad(angle_about(target, horizontal_direction(machine), turned_root))};
    best_distance = distance;
  }
  return *best;
}

std::vector<LimitExcess> limit_excesses(const Machine& machine, const AxisPositions& axes) {
  std::vector<LimitExcess> excesses;
  const auto check = [&](char axis, double position, const Interval& limits) {
    if (!limits.contains(position)) excesses.push_back({axis, position, limits});
  };
  check('X', axes.x_mm, machine.x.limits_mm.value);
  check('Y', axes.y_mm, machine.y.limits_mm.value);
  check('Z', axes.z_mm, machine.z.limits_mm.value);
  check(machine.tilt_letter(), rotary_pose(machine, axes).a_deg, machine.a.limits_deg.value);
  check('C', axes.c_deg, machine.c.limits_deg.value);
  return excesses;
}

Increments increments_of(IncrementSystem system) {
  switch (system) {
    case IncrementSystem::b: return {1000, 10000};
    case IncrementSystem::c: return {100, 1000};
    case IncrementSystem::d: return {10, 100};
    case IncrementSystem::e: break;
  }
  return {1, 10};
}

}  // namespace retrace::fabrication
