#include "fabrication/chisel/check/prediction.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace retrace::fabrication {

using geometry::Vec3;

namespace {

Prediction predict_cube(const Machine& machine, const Groove& cavity) {
  Prediction prediction;
  for (const DesignFacet& facet : cavity.facets) {
    // Nominal pose: C turns what the facet faces to -x, B leans the tool against it.
    const double facing = std::atan2(facet.normal.y(), facet.normal.x());
    RotaryPose near;
    near.c_deg = machine.c.sign.value * Angle::from_rad(std::numbers::pi - facing).deg();
    near.a_deg = machine.a.sign.value * Angle::from_rad(std::asin(facet.normal.z())).deg();
    const Vec3 level = facet.normal.cross(cavity.axis).normalized();
    prediction.poses.push_back(solve_plunge_pose(machine, facet.normal, level, near));
  }
  return prediction;
}

}  // namespace

Prediction predict(const Machine& machine, const Groove& groove, double tool_width_mm) {
  if (groove.is_cube()) return predict_cube(machine, groove);
  Prediction prediction;
  prediction.poses.resize(2);
  const Vec3 edge = edge_direction(machine);
  // Up a facet, from the rim to where the blank ends.
  const double stock_mm = groove.stock_mm / groove.axis.dot(groove.facets[0].up_slope);
  for (std::size_t f = 0; f < 2; ++f) {
    const Vec3& normal = groove.facets[f].normal;
    // Nominal pose: C turns what the facet faces to -y_w, A stands it up.
    const double facing = std::atan2(normal.y(), normal.x());
    RotaryPose near;
    near.c_deg = machine.c.sign.value * Angle::from_rad(-0.5 * std::numbers::pi - facing).deg();
    near.a_deg = machine.a.sign.value * Angle::from_rad(std::asin(normal.z())).deg();
    prediction.poses[f] = solve_plunge_pose(machine, normal, groove.axis.cross(normal).normalized(), near);
    const double tilt = std::abs(std::tan(prediction.poses[f].root_tilt.rad()));
    prediction.root_of_mm[f] = tool_width_mm * tilt;
    prediction.root_mm = std::max(prediction.root_mm, prediction.root_of_mm[f]);
    prediction.wall_mm = std::max(prediction.wall_mm, (groove.facet_length_mm + stock_mm) * tilt);
    const RigidMotion motion = machine_from_workpiece(machine, prediction.poses[f].pose);
    // The edge stays level while it ploughs the other facet, whose normal has a part along it.
    const std::size_t other = 1 - f;
    const Vec3 other_normal = motion.direction(groove.facets[other].normal);
    const double along_edge = edge.dot(other_normal);
    const double slope = along_edge / std::sqrt(1.0 - along_edge * along_edge);
    const double edge_along_root = edge.dot(motion.direction(groove.root_direction));
    prediction.plough_slope[other] = edge_along_root < 0.0 ? -slope : slope;
  }
  return prediction;
}

}  // namespace retrace::fabrication
