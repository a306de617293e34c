#include "fabrication/chisel/check/prediction.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "fabrication/job/fins.h"

namespace retrace::fabrication {

using geometry::Vec3;

namespace {

Prediction predict(const Machine& machine, const CubeCavity& cavity, const ToolWedge& wedge) {
  Prediction prediction;
  prediction.step_mm = 1e-6 * static_cast<double>(machine.increments.linear_nm);
  for (const DesignFacet& facet : cavity.facets) {
    // Nominal pose: C rotates the horizontal direction of the facet's normal to -x, and B inclines the tool to the
    // facet.
    const double facing = std::atan2(facet.normal.y(), facet.normal.x());
    RotaryPose near;
    near.c_deg = machine.c.sign.value * Angle::from_rad(std::numbers::pi - facing).deg();
    near.a_deg = machine.a.sign.value * Angle::from_rad(std::asin(facet.normal.z())).deg();
    const Vec3 level = facet.normal.cross(cavity.axis).normalized();
    prediction.poses.push_back(solve_plunge_pose(machine, facet.normal, level, near));
  }
  std::array<Vec3, 3> normals;
  std::array<Vec3, 3> spines;
  for (std::size_t k = 0; k < 3; ++k) {
    normals[k] = cavity.facets[k].normal;
    spines[k] = machine_from_workpiece(machine, prediction.poses[k].pose).inverse().direction(wedge.rake_direction);
  }
  prediction.fin_mm =
      std::min(highest_fin_mm(edge_covers(normals, spines), prediction.step_mm), max_fin_mm(prediction.step_mm));
  return prediction;
}

/// Returns the maximum distance by which an end of the edge, or the tool above it, cuts into the wall at an end of the
/// element (docs/theory/verification.md).
/// \param motion rigid motion of the workpiece while the facet is plunged
/// \param length_mm length of the facet from the root to the face of the blank
double wall_overcut_mm(const PrismGroove& groove, const ToolWedge& wedge, const Vec3& pass_normal,
                       const RigidMotion& motion, double length_mm) {
  const Vec3 root = motion.direction(groove.root_direction);
  double drift = 0.0;
  for (const DesignFacet& facet : groove.facets) {
    const Vec3 up = motion.direction(facet.up_slope);
    for (const Vec3& normal : {pass_normal, wedge.edge})
      drift = std::max(drift, std::abs(normal.dot(up) / normal.dot(root)));
  }
  const double reach_mm =
      wedge.half_width_mm * std::abs(pass_normal.dot(wedge.edge)) + std::abs(pass_normal.dot(wedge.tip_mm));
  return drift * length_mm + std::max(0.0, reach_mm / std::abs(pass_normal.dot(root)) - wedge.half_width_mm);
}

Prediction predict(const Machine& machine, const PrismGroove& groove, const ToolWedge& wedge) {
  Prediction prediction;
  prediction.poses.resize(2);
  prediction.pass_normal = machine.y.direction.value.cross(machine.z.direction.value).normalized();
  // Length of a facet from the root to the face of the blank.
  const double length_mm = groove.facet_length_mm + groove.stock_mm / groove.axis.dot(groove.facets[0].up_slope);
  for (std::size_t f = 0; f < 2; ++f) {
    const Vec3& normal = groove.facets[f].normal;
    // Nominal pose: C rotates the horizontal direction of the facet's normal to -y_w, and A makes the facet vertical.
    const double facing = std::atan2(normal.y(), normal.x());
    RotaryPose near;
    near.c_deg = machine.c.sign.value * Angle::from_rad(-0.5 * std::numbers::pi - facing).deg();
    near.a_deg = machine.a.sign.value * Angle::from_rad(std::asin(normal.z())).deg();
    prediction.poses[f] = solve_plunge_pose(machine, normal, groove.axis.cross(normal).normalized(), near);
    prediction.root_of_mm[f] = 2.0 * wedge.half_width_mm * std::abs(std::tan(prediction.poses[f].root_tilt.rad()));
    prediction.root_mm = std::max(prediction.root_mm, prediction.root_of_mm[f]);
    const RigidMotion motion = machine_from_workpiece(machine, prediction.poses[f].pose);
    prediction.wall_mm =
        std::max(prediction.wall_mm, wall_overcut_mm(groove, wedge, prediction.pass_normal, motion, length_mm));
    // The edge remains horizontal while it ploughs the other facet. It is tilted relative to the other facet, because
    // the normal of this facet has a component along the edge.
    const std::size_t other = 1 - f;
    const DesignFacet& ploughed = groove.facets[other];
    const Vec3 root = motion.direction(groove.root_direction);
    const Vec3 up = motion.direction(ploughed.up_slope);
    const double drift = -prediction.pass_normal.dot(up) / prediction.pass_normal.dot(root);
    const Vec3 design = motion.direction(ploughed.normal);
    const double along = wedge.edge.dot(root) - drift * wedge.edge.dot(up);
    const double rise_mm = wedge.half_width_mm * std::abs(wedge.edge.dot(design));
    PloughedFloor& floor = prediction.ploughed[other];
    floor.drift = drift;
    floor.slope = wedge.edge.dot(design) / along;
    floor.half_width_mm = wedge.half_width_mm * std::abs(along);
    floor.shift_mm = -rise_mm * prediction.pass_normal.dot(design) / prediction.pass_normal.dot(root);
  }
  return prediction;
}

}  // namespace

Prediction predict(const Machine& machine, const Cavity& groove, const ToolWedge& wedge) {
  return std::visit([&](const auto& element) { return predict(machine, element, wedge); }, groove);
}

}  // namespace retrace::fabrication
