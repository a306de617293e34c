#include "fabrication/chisel/plan/section.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "core/error.h"
#include "core/number_format.h"
#include "fabrication/chisel/on_machine.h"
#include "fabrication/machine/edge_cut.h"

namespace retrace::fabrication {
namespace {

using geometry::Vec2;
using geometry::Vec3;

double half_apex_rad(const geometry::RtpElement& element) {
  return 0.5 * Angle::from_deg(element.apex_angle_deg).rad();
}

/// Rotates a direction by -90 degrees about Z. This converts a direction in an element that is not rotated to the
/// corresponding direction in a rotated element.
Vec3 turned_back(const Vec3& v) {
  return {v.y(), -v.x(), v.z()};
}

/// Transforms the normal of a plane to the coordinates of the linear axes, whose directions need not be orthogonal.
Vec3 in_words(const Machine& machine, const Vec3& normal) {
  return {normal.dot(machine.x.direction.value), normal.dot(machine.y.direction.value),
          normal.dot(machine.z.direction.value)};
}

/// Returns the maximum width, in mm, of the strip that a tilted edge may leave at the root after a plunge. A plunge
/// only separates its chip if it passes the surface that the previous cut left on the other facet. The limit is
/// therefore the depth of cut, minus the tolerance of the verification and the rounding errors of two positions. On a
/// substrate, it is also at most the depth of a finishing cut. There is no limit for `unidirectional` jobs on flat
/// blanks, because a ploughing cut always separates its chip.
double max_strip_mm(const Job& job, const Machine& machine, bool is_on_substrate) {
  constexpr double kToleranceNm = 10.0;
  const Process& process = job.process;
  const double diagonal_nm = std::numbers::sqrt3 * static_cast<double>(machine.increments.linear_nm);
  const double finishing_mm = 1e-3 * process.finishing_depth_um;
  double strip_mm = is_on_substrate ? finishing_mm : std::numeric_limits<double>::infinity();
  if (job.strategy != Strategy::unidirectional) {
    const double depth_mm = job.strategy == Strategy::two_step ? finishing_mm : 1e-3 * process.roughing_depth_um;
    strip_mm = std::min(strip_mm, depth_mm - 1e-6 * (std::max(kToleranceNm, diagonal_nm) + diagonal_nm));
  }
  return strip_mm;
}

/// Refuses a pose in which the angle between the root and the tool's edge is too large. The axes A and C only align the
/// normal of the facet with the tool. No other axis can align the root with the edge.
void check_root(const Job& job, const Machine& machine, const CuttingPose& pose, const InputLocation& where,
                const ElementPose& stance) {
  const double strip_mm = max_strip_mm(job, machine, stance.element >= 0);
  const double tangent = std::abs(std::tan(pose.root_tilt.rad()));
  if (job.tool.width_mm * tangent <= strip_mm) return;
  throw InputError(where,
                   fmt::format("{}the angle between the root and the tool's edge is {} degrees, and A and C cannot "
                               "correct it; at most {} degrees are allowed for this tool, so that the uncut strip at "
                               "the root is at most {} um wide. Reduce tool.width_mm to at most {}",
                               stance.who(), fixed(std::abs(pose.root_tilt.deg()), 4),
                               fixed(Angle::from_rad(std::atan(strip_mm / job.tool.width_mm)).deg(), 4),
                               fixed(1e3 * strip_mm, 3), fixed(strip_mm / tangent, 4)));
}

/// Refuses a pose in which the angle between the ploughed facet and the plane that the edge sweeps is too large.
void check_ploughed_facet(const Job& job, const Machine& machine, const CuttingPose& pose, const Vec3& design_floor,
                          const InputLocation& where, const ElementPose& stance) {
  if (job.strategy == Strategy::bidirectional) return;
  const Vec3 edge = edge_direction(machine);
  const geometry::Vec2& along = pose.section.floor_direction;
  const Vec3 travel = along.x() * machine.y.direction.value + along.y() * machine.z.direction.value;
  const Vec3 swept = edge.cross(travel).normalized();
  const double cosine = std::abs(swept.dot(design_floor));
  if (cosine > kMinCosAlongFacet) return;
  const double at_deg = Angle::from_rad(std::acos(cosine)).deg();
  const double max_deg = Angle::from_rad(std::acos(kMinCosAlongFacet)).deg();
  throw InputError(
      where, fmt::format("{}the angle between the root and the tool's edge is {} degrees, and A and C cannot correct "
                         "it. The ploughed facet would have an error of {} degrees, but at most {} degrees are allowed",
                         stance.who(), fixed(std::abs(pose.root_tilt.deg()), 4), fixed_apart(at_deg, max_deg, 4),
                         fixed(max_deg, 4)));
}

}  // namespace

Vec3 facet_normal(const geometry::RtpElement& element, const FacetChoice& facet) {
  const double half = half_apex_rad(element);
  const double side = facet.facet == 1 ? -1.0 : 1.0;
  const Vec3 normal(0.0, side * std::cos(half), std::sin(half));
  return facet.rotated ? turned_back(normal) : normal;
}

Vec3 root_direction(const FacetChoice& facet) {
  const Vec3 root(facet.facet == 1 ? 1.0 : -1.0, 0.0, 0.0);
  return facet.rotated ? turned_back(root) : root;
}

double root_depth_mm(const geometry::RtpElement& element) {
  return 0.5 * element.base_mm / std::tan(half_apex_rad(element));
}

std::string ElementPose::who() const {
  if (element < 0) return "";
  const double tilt_deg =
      Angle::from_rad(std::atan2(workpiece_from_element.col(2).head<2>().norm(), workpiece_from_element(2, 2))).deg();
  return fmt::format("element {}, tilted by {} degrees: ", element, fixed(tilt_deg, 4));
}

namespace {

/// Returns the angle of C, plus or minus full turns, that is within the limits and closest to the previous angle. Full
/// turns are only added if C is then closer to the previous angle by more than 1 degree.
/// \throw InputError at `where` if no angle is within the limits
double nearest_c_deg(const Machine& machine, double c_deg, double previous_c_deg, const InputLocation& where,
                     const std::string& who) {
  const Interval& limits = machine.c.limits_deg.value;
  std::optional<double> best;
  for (const int turns : {0, 1, -1, 2, -2}) {
    const double candidate = c_deg + 360.0 * turns;
    if (!limits.contains(candidate)) continue;
    constexpr double kAsFarDeg = 1.0;  // maximum difference between computed and nominal angles
    if (!best || std::abs(candidate - previous_c_deg) < std::abs(*best - previous_c_deg) - kAsFarDeg) best = candidate;
  }
  if (!best)
    throw InputError(
        where,
        fmt::format("{}axis C of machine {} would have to move to {} degrees, but its limits are {} to {} degrees", who,
                    machine.name, fixed(c_deg, 4), shortest(limits.low), shortest(limits.high)));
  return *best;
}

/// Checks that an angle of the tilting axis is within its limits.
/// \param who beginning of the error message
/// \throw InputError at `where` if the angle is outside of the limits
void check_tilt(const Machine& machine, double tilt_deg, const InputLocation& where, const std::string& who) {
  const Interval& limits = machine.a.limits_deg.value;
  if (limits.contains(tilt_deg)) return;
  throw InputError(
      where,
      fmt::format("{0}axis {2} of machine {1} would have to move to {3} degrees, but its limits are {4} to {5} degrees",
                  who, machine.name, machine.tilt_letter(), fixed(tilt_deg, 4), shortest(limits.low),
                  shortest(limits.high)));
}

}  // namespace

void set_rotary_pose(CuttingPose& pose, const Machine& machine, const Vec3& normal, const RotaryPose& near,
                     double previous_c_deg, const InputLocation& where, const std::string& who) {
  const PlungePose solved = solve_plunge_pose(machine, normal, pose.root, near);
  pose.root_tilt = solved.root_tilt;
  pose.a = to_step(solved.pose.a_deg * kRotaryUnitsPerDeg, machine.increments.rotary_units);
  pose.c = to_step(nearest_c_deg(machine, solved.pose.c_deg, previous_c_deg, where, who) * kRotaryUnitsPerDeg,
                   machine.increments.rotary_units);
  pose.rounded = {static_cast<double>(pose.a) / kRotaryUnitsPerDeg, static_cast<double>(pose.c) / kRotaryUnitsPerDeg};
  check_tilt(machine, pose.rounded.a_deg, where, who);
}

CuttingPose cutting_pose(const Job& job, const Machine& machine, const FacetChoice& facet, double previous_c_deg,
                         const ElementPose& stance) {
  const InputLocation where = job.where("machine");
  const geometry::RtpElement element = blank_prism(job);
  const double apex_rad = Angle::from_deg(element.apex_angle_deg).rad();
  const double nominal_c_deg = (facet.facet == 1 ? 0.0 : 180.0) + (facet.rotated ? 90.0 : 0.0);
  CuttingPose pose;
  pose.facet = facet;
  pose.orientation = stance.orientation;
  pose.workpiece_from_element = stance.workpiece_from_element;
  pose.root = pose.workpiece_from_element * root_direction(facet);
  const Vec3 normal = pose.workpiece_from_element * facet_normal(element, facet);
  const RotaryPose near{machine.a.sign.value * 0.5 * element.apex_angle_deg, machine.c.sign.value * nominal_c_deg};
  set_rotary_pose(pose, machine, normal, near, previous_c_deg, where, stance.who());
  check_root(job, machine, pose, where, stance);

  const RigidMotion motion = machine_from_workpiece(machine, pose.rounded);
  Section& section = pose.section;
  const Vec3 wall = in_words(machine, motion.direction(normal));
  section.wall_y = 1.0 / wall.y();
  // The axes Y and Z move the tool parallel to the designed floor. If the root is tilted relative to the edge, only the
  // deeper end of the edge touches the floor.
  const FacetChoice other{facet.rotated, 3 - facet.facet};
  const Vec3 design_floor = motion.direction(pose.workpiece_from_element * facet_normal(element, other));
  const Vec3 floor = in_words(machine, design_floor);
  section.floor_normal = Vec2(floor.y(), floor.z()).normalized();
  section.floor_direction = {-section.floor_normal.y(), section.floor_normal.x()};
  check_ploughed_facet(job, machine, pose, design_floor, where, stance);
  section.bisector = (Vec2::UnitY() + section.floor_direction).normalized();
  section.lift_mm = std::abs(design_floor.dot(edge_direction(machine)) / floor.z()) * 0.5 * job.tool.width_mm;
  const Vec3 face = in_words(machine, motion.direction(pose.workpiece_from_element.col(2)));
  section.face_normal = {face.y(), face.z()};
  section.depth_mm = root_depth_mm(element);
  section.stock_mm = stance.stock_mm;
  section.start_mm = stance.start_mm;
  section.edge_mm = 1e-3 * job.tool.edge_radius_um * (1.0 - std::sin(apex_rad) + std::cos(apex_rad));
  section.apex = Angle::from_rad(apex_rad);
  section.rake = Angle::from_rad(Angle::from_deg(job.tool.clearance_deg + job.tool.wedge_deg).rad() +
                                 clearance_change(machine).rad());
  section.step_nm = machine.increments.linear_nm;
  return pose;
}

}  // namespace retrace::fabrication
