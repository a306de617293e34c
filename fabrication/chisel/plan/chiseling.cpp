#include "fabrication/chisel/plan/chiseling.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/angle.h"
#include "core/error.h"
#include "core/number_format.h"
#include "fabrication/chisel/on_machine.h"
#include "fabrication/chisel/plan/process_facts.h"
#include "fabrication/chisel/plan/routines.h"
#include "fabrication/job/cube_corner.h"
#include "fabrication/job/v_tool.h"
#include "geometry/elements/element_cells.h"

namespace retrace::fabrication {
namespace {

using geometry::Vec3;

Vec3 words_of(const Machine& machine, const Vec3& point_mm, const RotaryPose& pose) {
  const AxisPositions axes = inverse(machine, point_mm, pose);
  return {axes.x_mm, axes.y_mm, axes.z_mm};
}

/// Transforms the unit normal of a plane from the workpiece frame to the coordinate space of the axis positions X, Y
/// and Z. If the head tilts, these positions are not points of the machine frame.
Vec3 in_words(const Machine& machine, const RotaryPose& pose, const Vec3& normal) {
  const Vec3 zero = words_of(machine, Vec3::Zero(), pose);
  Eigen::Matrix3d words_from_points;
  for (Eigen::Index k = 0; k < 3; ++k) words_from_points.col(k) = words_of(machine, Vec3::Unit(k), pose) - zero;
  return (words_from_points.inverse().transpose() * normal).normalized();
}

}  // namespace

double chiseling_allowance_mm(const Job& job) {
  return 1e-3 * job.process.finishing_cuts * job.process.finishing_depth_um;
}

double chiseling_across_mm(const Job& job, std::size_t zone, double stock_mm) {
  // Total thickness of all layers along the facet normals, computed from the depth of the apex.
  const CubeCorner corner = blank_corner(job, zone);
  const double across_mm = (corner.depth_mm + stock_mm) / corner.layer_rise() - chiseling_allowance_mm(job);
  check_allowance(job, across_mm);
  return across_mm;
}

int chiseling_layers(const Job& job, std::size_t zone, double stock_mm) {
  return whole_cuts(job, chiseling_across_mm(job, zone, stock_mm) / (1e-3 * job.process.roughing_depth_um));
}

CuttingPose chiseling_pose(const Job& job, const Machine& machine, const FacetChoice& facet, double previous_c_deg,
                           const ElementPose& stance) {
  CuttingPose pose;
  pose.corner = blank_corner(job, facet.zone, facet.rotated);
  const Vec3& upright = pose.corner.normals[static_cast<std::size_t>(facet.facet - 1)];
  const Vec3 normal = stance.workpiece_from_element * upright;
  // Azimuth of the facet, without errors of angle and without the slope of a substrate.
  const double azimuth_deg = 120.0 * facet.facet - 150.0 + (facet.rotated ? 180.0 : 0.0) +
                             (job.zones.empty() ? 0.0 : job.zones[facet.zone].rotation_deg);
  pose.facet = facet;
  pose.orientation = stance.orientation;
  pose.workpiece_from_element = stance.workpiece_from_element;
  pose.root = pose.workpiece_from_element * upright.cross(Vec3::UnitZ()).normalized();
  const double tilt_deg = Angle::from_rad(std::asin(upright.z())).deg();
  const RotaryPose near{machine.a.sign.value * tilt_deg, -machine.c.sign.value * azimuth_deg};
  set_rotary_pose(pose, machine, normal, near, previous_c_deg, job.where("machine"), stance.who());
  pose.section.depth_mm = pose.corner.depth_mm;
  pose.section.stock_mm = stance.stock_mm;
  pose.section.start_mm = stance.start_mm;
  pose.section.apex = Angle::from_deg(90.0);
  pose.section.step_nm = machine.increments.linear_nm;
  pose.rounded_along = in_words(machine, pose.rounded, normal);
  return pose;
}

Routine chiseling_routine(const Job& job, const Machine& machine, const CuttingPose& pose, double left_mm,
                          double feed_mm_per_min) {
  const CubeCorner& corner = pose.corner;
  const auto facet = static_cast<std::size_t>(pose.facet.facet - 1);
  const Vec3 tip = corner.apex_over(left_mm * Vec3::Ones());
  const double to_go_mm = pose.section.depth_mm + pose.section.start_mm + job.process.clearance_mm - tip.z();
  const Vec3 zero = words_of(machine, Vec3::Zero(), pose.rounded);
  const auto rounded = [&](const Vec3& from_apex) {
    return rounded_words(words_of(machine, pose.workpiece_from_element * from_apex, pose.rounded) - zero,
                         pose.rounded_along, pose.section.step_nm);
  };
  const auto up_edge = [&](const Vec3& edge) -> Vec3 { return tip + to_go_mm / edge.z() * edge; };
  const LinearPosition start = rounded(up_edge(corner.edges[facet]));
  const LinearPosition middle = rounded(tip);
  const LinearPosition end = rounded(up_edge(corner.edges[(facet + 1) % 3]));
  Routine routine;
  routine.start = start;
  std::vector<Step>& steps = routine.subroutine.steps;
  steps.emplace_back(increment(Motion::plunge, middle - start, feed_mm_per_min));
  const auto dwell_ms = static_cast<std::int32_t>(std::lround(1e3 * job.process.dwell_s));
  if (dwell_ms > 0) steps.emplace_back(Dwell{dwell_ms});
  steps.emplace_back(increment(Motion::retract, end - middle, feed_mm_per_min));
  return routine;
}

void check_v_in_poses(const Job& job, const Machine& machine, const std::array<CuttingPose, 3>& poses,
                      const ElementPose& stance) {
  const auto check_fins_in_poses = [&] {
    check_fins(job, machine, poses[0].corner, {poses[0].root_tilt, poses[1].root_tilt, poses[2].root_tilt},
               stance.who());
  };
  if (stance.element < 0) return check_fins_in_poses();
  const InputLocation where = job.where("machine");
  const VToolEdges edges = v_tool_edges(job.tool);
  const double error_deg = poses[0].corner.largest_error_deg();
  std::array<Vec3, 3> spines;
  for (std::size_t k = 0; k < 3; ++k) {
    // `root_tilt` rotates the element relative to the tool. Relative to the element, the tool is rotated in the
    // opposite direction.
    const Eigen::AngleAxisd turn(-poses[k].root_tilt.rad(), Vec3::UnitZ());
    const auto azimuth_deg = [](const Vec3& v) { return Angle::from_rad(std::atan2(v.y(), v.x())).deg(); };
    double room_deg = 90.0 - error_deg;
    for (const Vec3& edge : {edges.leading, edges.trailing, edges.spine}) {
      const double at_deg = azimuth_deg(edge);
      room_deg = std::min(room_deg, (poses[k].root_tilt.rad() > 0.0 ? at_deg : 90.0 - at_deg) - error_deg);
    }
    const double turned_deg = std::abs(poses[k].root_tilt.deg());
    if (turned_deg > room_deg)
      throw InputError(
          where,
          fmt::format("{0}in facet {2}, the tool would be rotated by {1} degrees, which B and C cannot correct, so "
                      "that it would cut into a neighbouring facet. The angles of this tool allow at most {3} degrees",
                      stance.who(), fixed(turned_deg, 3), k + 1, fixed(room_deg, 3)));
    spines[k] = turn * edges.spine;
  }
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3& along_second = spines[k];
    const Vec3& along_first = spines[(k + 1) % 3];
    const Angle first = Angle::from_rad(std::atan2(along_second.z(), along_second.x()));
    const Angle second = Angle::from_rad(std::atan2(along_first.z(), along_first.y()));
    const double covered_deg = first.deg() + second.deg();
    if (covered_deg < 90.0 + error_deg)
      throw InputError(
          where, fmt::format("{}the cuts along facets {} and {} would leave a fin of {} degrees between them, "
                             "but no fin is allowed: increase tool.wedge_deg, or reduce the slope of the substrate",
                             stance.who(), k + 1, (k + 1) % 3 + 1, fixed(90.0 + error_deg - covered_deg, 3)));
  }
  check_fins_in_poses();
  double most_turned = 0.0;
  for (const CuttingPose& pose : poses) most_turned = std::max(most_turned, std::abs(pose.root_tilt.rad()));
  const double half_nose = Angle::from_deg(0.5 * job.tool.nose_angle_deg).rad();
  const double up_facet_mm =
      (poses[0].section.depth_mm + stance.stock_mm) / std::sqrt(2.0 / 3.0) / std::cos(half_nose + most_turned);
  const double least_mm = 2.0 * up_facet_mm * std::sin(half_nose);
  if (job.tool.width_mm < least_mm - 1e-9)
    throw InputError(
        job.where("tool.width_mm"),
        fmt::format("{}must be >= {} for the cutting edges to reach from the apex to the blank's face, "
                    "got {}",
                    stance.who(), fixed(std::ceil(least_mm * 1e6) * 1e-6, 6), shortest(job.tool.width_mm)));
}

namespace {

std::string errors_text(const char* what, const std::array<double, 3>& arcmin) {
  if (arcmin == std::array<double, 3>{}) return "";
  return fmt::format(", {} {} {} {} arcmin", what, shortest(arcmin[0]), shortest(arcmin[1]), shortest(arcmin[2]));
}

/// Returns a description of the elements of a zone, or of a job without zones, for the header of a program.
std::string elements_text(const Job& job, std::size_t zone, std::size_t elements) {
  const geometry::Element element = blank_element(job, zone);
  const geometry::AngleErrors errors = angle_errors_of(job, zone);
  const double turn_deg = job.zones.empty() ? 0.0 : job.zones[zone].rotation_deg;
  return fmt::format("{} {} cube corners, apex {} mm deep, edges {} mm to the face{}{}{}", elements,
                     std::holds_alternative<geometry::HexagonalCube>(element) ? "hexagonal" : "triangular",
                     fixed(geometry::element_depth_mm(element), 6), fixed(cavity_edge_mm(element), 6),
                     turn_deg == 0.0 ? "" : fmt::format(", turned by {} deg", shortest(turn_deg)),
                     errors_text("dihedral errors", errors.dihedral_error_arcmin),
                     errors_text("facet tilts", errors.facet_tilt_arcmin));
}

}  // namespace

std::string zone_description(const Job& job, std::size_t zone) {
  return fmt::format("Zone {}: {}", zone + 1, elements_text(job, zone, job.zones[zone].apexes_mm.size()));
}

ProcessFacts chiseling_facts(const Job& job, double stock_mm, std::size_t elements) {
  ProcessFacts facts;
  facts.passes_mm = {0.0};
  facts.array_title = "Cube corner array";
  for (std::size_t zone = 0; zone < zone_count(job); ++zone)
    facts.cuts_per_facet = std::max(facts.cuts_per_facet, chiseling_layers(job, zone, stock_mm));
  if (job.zones.empty()) facts.description.push_back(elements_text(job, 0, elements));
  for (std::size_t zone = 0; zone < job.zones.size(); ++zone) facts.description.push_back(zone_description(job, zone));
  facts.description.push_back(
      fmt::format("{}, dihedral edges along -Y and 120 deg apart at B0 C0{}. Controller transformation off",
                  zero_text(job), job.zones.empty() ? "" : ", plus the rotation of each zone"));
  facts.description.push_back(
      fmt::format("Tool: V of {} deg, width {} mm, wedge {} deg, clearance {} deg as mounted. Reference: the tip",
                  shortest(job.tool.nose_angle_deg), shortest(job.tool.width_mm), shortest(job.tool.wedge_deg),
                  shortest(job.tool.clearance_deg)));
  return facts;
}

LinearPosition rounded_words(const Vec3& words_mm, const Vec3& along, Nanometres step_nm) {
  const Vec3 exact = words_mm * (kNanometresPerMm / static_cast<double>(step_nm));
  const auto place_of = [&](const Vec3& steps) -> LinearPosition {
    return LinearPosition(std::llround(steps.x()), std::llround(steps.y()), std::llround(steps.z())) * step_nm;
  };
  if (along == Vec3::Zero()) return place_of(exact);
  const Vec3 low = exact.array().floor();
  Vec3 best = low;
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 8; ++k) {
    const Vec3 candidate = low + Vec3((k & 1) != 0, (k & 2) != 0, (k & 4) != 0);
    const Vec3 error = candidate - exact;
    // Among grid points with equal errors along this direction, prefer the point nearest to the exact position.
    const double measure = std::abs(along.dot(error)) + 1e-3 * error.norm();
    if (measure >= least) continue;
    least = measure;
    best = candidate;
  }
  return place_of(best);
}

}  // namespace retrace::fabrication
