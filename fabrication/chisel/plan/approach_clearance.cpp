#include "fabrication/chisel/plan/approach_clearance.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/elements/element_cells.h"

namespace retrace::fabrication {
namespace {

using geometry::Vec3;

/// Fraction of the process's clearance that rapid moves must keep. The verification requires a slightly smaller
/// fraction.
constexpr double kClearanceFraction = 0.95;
constexpr double kStepFraction = 0.25;
constexpr int kMaxSteps = 400;

}  // namespace

ApproachClearance::ApproachClearance(const Job& job, const Machine& machine)
    : machine_(machine),
      face_(job),
      half_edge_mm_(cuts_prisms(job) ? 0.5 * job.tool.width_mm : 0.0),
      clearance_mm_(kClearanceFraction * job.process.clearance_mm) {
  double least_mm = std::numeric_limits<double>::infinity();
  for (std::size_t zone = 0; zone < zone_count(job); ++zone)
    least_mm = std::min(least_mm,
                        geometry::bounding_box(geometry::aperture_outline(blank_element(job, zone))).size().minCoeff());
  step_mm_ = kStepFraction * least_mm;
}

double ApproachClearance::min_height_mm(const LinearPosition& at, const CuttingPose& pose) const {
  AxisPositions axes{millimetres(at[0]), millimetres(at[1]), millimetres(at[2]), 0.0, pose.rounded.c_deg};
  (machine_.tilt == Tilt::table ? axes.a_deg : axes.b_deg) = pose.rounded.a_deg;
  const ToolPose tool = forward(machine_, axes);
  double least = face_.height_mm(tool.reference_mm);
  if (half_edge_mm_ == 0.0) return least;
  const Vec3 half_edge = half_edge_mm_ * (tool.workpiece_from_machine * edge_direction(machine_));
  for (const double side : {-1.0, 1.0}) least = std::min(least, face_.height_mm(tool.reference_mm + side * half_edge));
  return least;
}

/// Returns true if the whole box between the two ends of a rapid move is clear. The axes can arrive at different times,
/// so the tool can pass through any point of this box.
bool ApproachClearance::is_clear_along(const LinearPosition& from, const LinearPosition& to,
                                       const CuttingPose& pose) const {
  const Vec3 by = millimetres(LinearPosition(to - from));
  Eigen::Vector3i steps;
  for (Eigen::Index k = 0; k < 3; ++k)
    steps[k] = by[k] == 0.0      ? 0
               : face_.is_flat() ? 1
                                 : std::clamp(static_cast<int>(std::ceil(std::abs(by[k]) / step_mm_)), 1, kMaxSteps);
  const auto part = [](Nanometres low, Nanometres high, int i, int count) {
    return count == 0 ? low : low + std::llround(static_cast<double>(high - low) * i / count);
  };
  for (int i = 0; i <= steps.x(); ++i)
    for (int j = 0; j <= steps.y(); ++j)
      for (int k = 0; k <= steps.z(); ++k) {
        const LinearPosition at(part(from.x(), to.x(), i, steps.x()), part(from.y(), to.y(), j, steps.y()),
                                part(from.z(), to.z(), k, steps.z()));
        if (min_height_mm(at, pose) < clearance_mm_) return false;
      }
  return true;
}

bool ApproachClearance::is_clear(const AxisWords& from, const CycleCall& visit, const CuttingPose& pose) const {
  AxisWords at = from;
  for (const Move& move : approach(from, visit)) {
    AxisWords to = at;
    go_to(to, move.to);
    // As long as X and Y are not known, the tool is at the safe height and nothing has to be checked.
    if (to[kX] && to[kY] && to[kZ]) {
      const LinearPosition last(*to[kX], *to[kY], *to[kZ]);
      const LinearPosition first(at[kX].value_or(last.x()), at[kY].value_or(last.y()), at[kZ].value_or(last.z()));
      if (!is_clear_along(first, last, pose)) return false;
    }
    at = to;
  }
  return true;
}

}  // namespace retrace::fabrication
