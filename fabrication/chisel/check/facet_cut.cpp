#include "fabrication/chisel/check/facet_cut.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "fabrication/chisel/on_machine.h"

namespace retrace::fabrication {
namespace {

using geometry::Vec3;

/// Tolerance for rounded positions in the program.
constexpr double kRoundingMm = 2e-6;

}  // namespace

Vec3 swept_normal(const ToolWedge& wedge, const SweptVolume& sweep) {
  constexpr double kMinLengthMm = 1e-9;
  const Vec3 normal = wedge.edge.cross(sweep.to_mm - sweep.from_mm);
  return normal.norm() < kMinLengthMm ? Vec3(Vec3::Zero()) : Vec3(normal.normalized());
}

std::optional<FacetCut> facet_cut(const DesignElement& element, const ToolWedge& wedge, const SweptVolume& sweep,
                                  const RigidMotion& back) {
  const Vec3 normal = back.direction(swept_normal(wedge, sweep));
  const Vec3 clearance_face = back.direction(wedge.sides[0].outward);
  std::optional<FacetCut> cut;
  double most = kMinCosAlongFacet;
  std::size_t by_clearance = 0;
  for (std::size_t f = 0; f < element.facets.size(); ++f) {
    const Vec3& outward = element.facets[f].normal;
    if (clearance_face.dot(outward) < clearance_face.dot(element.facets[by_clearance].normal)) by_clearance = f;
    if (std::abs(normal.dot(outward)) <= most) continue;
    most = std::abs(normal.dot(outward));
    cut = FacetCut{f, 1e9, false};
  }
  if (!cut) return std::nullopt;
  cut->is_by_clearance = cut->facet == by_clearance;
  for (const Vec3& tip : {sweep.from_mm, sweep.to_mm})
    for (const double side : {-1.0, 1.0})
      cut->remaining_mm =
          std::min(cut->remaining_mm,
                   element.facets[cut->facet].height_mm(back.point(tip + side * wedge.half_width_mm * wedge.edge)));
  return cut;
}

double finishing_allowance_mm(const VerificationModel& workpiece) {
  const Process& process = workpiece.job->process;
  return has_finishing_cuts(*workpiece.job) ? 1e-3 * process.finishing_cuts * process.finishing_depth_um : 0.0;
}

bool is_finishing(const VerificationModel& workpiece, const FacetCut& cut) {
  const double slack_mm =
      std::min(workpiece.tolerance_mm, 1e-4 * workpiece.job->process.finishing_depth_um) + kRoundingMm;
  return cut.remaining_mm < finishing_allowance_mm(workpiece) - slack_mm;
}

double depth_of_cut_mm(const VerificationModel& workpiece, const std::optional<FacetCut>& cut) {
  const Process& process = workpiece.job->process;
  return 1e-3 * (cut && is_finishing(workpiece, *cut) ? process.finishing_depth_um : process.roughing_depth_um);
}

}  // namespace retrace::fabrication
