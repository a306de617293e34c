#include "fabrication/machine/edge_cut.h"

#include <Eigen/Geometry>
#include <cmath>

namespace retrace::fabrication {

using geometry::Vec3;

Eigen::Matrix3d edge_frame(const Machine& machine) {
  if (machine.tilt == Tilt::head) return tool_rotation(machine);
  const Vec3 edge = edge_direction(machine);
  const Vec3 up = plunged_normal(machine).cross(edge);
  Eigen::Matrix3d frame;
  frame << edge, up.cross(edge), up;
  return frame;
}

Angle clearance_change(const Machine& machine) {
  const Eigen::Matrix3d frame = edge_frame(machine);
  const Vec3 up = tool_rotation(machine) * machine.z.direction.value;
  return Angle::from_rad(std::atan2(-frame.col(1).dot(up), frame.col(2).dot(up)));
}

Vec3 cutting_edge(const Machine& machine, Angle edge_rise) {
  const Vec3 level = horizontal_direction(machine);
  return std::cos(edge_rise.rad()) * level + std::sin(edge_rise.rad()) * level.cross(plunged_normal(machine));
}

CutPlane cut_plane(const Machine& machine, const EdgeCut& cut, const Vec3& outward) {
  const RigidMotion back = machine_from_workpiece(machine, rotary_pose(machine, cut.at)).inverse();
  AxisPositions before = cut.at;
  before.x_mm -= cut.travel_mm.x();
  before.y_mm -= cut.travel_mm.y();
  before.z_mm -= cut.travel_mm.z();
  const Vec3 end = machine_point(machine, cut.at);
  CutPlane plane;
  plane.point_mm = back.point(end + edge_frame(machine) * cut.tip_mm);
  plane.normal =
      back.direction(cutting_edge(machine, cut.edge_rise).cross(end - machine_point(machine, before))).normalized();
  if (plane.normal.dot(outward) < 0.0) plane.normal = -plane.normal;
  return plane;
}

}  // namespace retrace::fabrication
