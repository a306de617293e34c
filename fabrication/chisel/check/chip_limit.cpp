#include "fabrication/chisel/check/chip_limit.h"

#include <algorithm>
#include <cmath>

#include "core/overloaded.h"
#include "fabrication/machine/edge_cut.h"

namespace retrace::fabrication {
namespace {

using geometry::Vec3;

/// Dimensions of the chip that a V-shaped tool removes at a dihedral edge, for a layer with a thickness of 1 mm.
struct EdgeChipSize {
  double thickness = 1.0;  ///< maximum thickness, between the tool's flank and the material on the neighbouring facet
  double reach = 1.0;      ///< maximum distance from the dihedral edge
};

EdgeChipSize beside_edges(const CubeCavity& cavity, std::size_t facet, const Vec3& spine) {
  EdgeChipSize most;
  const Vec3& normal = cavity.facets[facet].normal;
  const std::size_t next = (facet + 1) % 3;
  for (const bool is_second : {false, true}) {
    const Vec3& edge = cavity.edges[is_second ? next : facet];
    const Vec3& other = cavity.edges[is_second ? facet : next];
    const Vec3 across = other - other.dot(edge) * edge;
    const double away = spine.dot(across.normalized());
    if (away <= 0.0) continue;
    const double slope = spine.dot(normal) / away;
    // Cosine of the angle between the facet and the material on the neighbouring facet. This angle is computed in two
    // sections: normal to the edge, and in the plane of the two other edges. The larger of the two cosines is used.
    const Vec3& third = cavity.edges[(facet + 2) % 3];
    const double cosine =
        std::max(-normal.dot(cavity.facets[is_second ? next : (facet + 2) % 3].normal), other.dot(third));
    const double sine = std::sqrt(1.0 - cosine * cosine);
    constexpr double kLeast = 1e-3;
    const double thickness = slope / std::max(kLeast, sine - slope * cosine);
    most.thickness = std::max(most.thickness, thickness);
    // The division by across.norm() converts a distance normal to `edge` into a distance along the other dihedral edge.
    most.reach = std::max(most.reach, (1.0 + thickness * cosine) / (sine * across.norm()));
  }
  return most;
}

}  // namespace

ChipLimit::ChipLimit(const VerificationModel& workpiece, std::size_t element, const std::optional<FacetCut>& cut,
                     const ToolWedge& wedge, const RigidMotion& back) {
  depth_mm_ = depth_of_cut_mm(workpiece, cut);
  slack_mm_ = workpiece.tolerance_mm + workpiece.prediction(element).root_mm;
  std::visit(Overloaded{[&](const PrismGroove& groove) { limit_chisel(workpiece, element, groove, cut); },
                        [&](const CubeCavity& cavity) {
                          if (cut) limit_v_tool(cavity, *cut, back.direction(wedge.rake_direction));
                        }},
             workpiece.cavities[element]);
}

void ChipLimit::limit_v_tool(const CubeCavity& cavity, const FacetCut& cut, const Vec3& spine) {
  kind_ = Kind::v_shaped;
  const EdgeChipSize beside = beside_edges(cavity, cut.facet, spine);
  ratio_ = beside.thickness;
  reach_mm_ = beside.reach * (depth_mm_ + slack_mm_);
  kinks_mm_ = {reach_mm_, reach_mm_};
}

void ChipLimit::limit_chisel(const VerificationModel& workpiece, std::size_t element, const PrismGroove& groove,
                             const std::optional<FacetCut>& cut) {
  const Tool& tool = workpiece.job->tool;
  const Angle rake = Angle::from_rad(Angle::from_deg(tool.clearance_deg + tool.wedge_deg).rad() +
                                     clearance_change(*workpiece.machine).rad());
  apex_ = Angle::from_rad(std::acos(-groove.facets[0].normal.dot(groove.facets[1].normal)));
  rake_slope_ = std::tan(rake.rad());
  const double sine = std::sin(apex_.rad());
  const double cosine = std::cos(apex_.rad());
  // A plunge with a tilted edge leaves an uncut strip at the root, and a burr above this strip. Add the height of the
  // burr to the tolerance.
  const double across = rake_slope_ * sine + cosine;
  if (across > 0.0)
    slack_mm_ += workpiece.prediction(element).root_mm *
                 std::max(0.0, (sine - rake_slope_ * cosine + rake_slope_) / across - 1.0);
  const double depth_mm = depth_mm_ + slack_mm_;
  if (!cut) {
    const double half = 0.5 * apex_.rad();
    ratio_ = std::max(0.0, std::tan(half - rake.rad())) / std::sin(half);
  } else if (cut->is_by_clearance) {
    kind_ = Kind::plunge;
    // The limit has kinks at two distances from the tip. At the first distance, the surface that the last cut left on
    // the other facet crosses the top of the layer that this plunge removes. At the second distance, this surface
    // crosses the rake face.
    kinks_mm_ = {depth_mm * (1.0 + cosine) / sine, depth_mm / std::max(1e-9, sine - rake_slope_ * cosine)};
  } else {
    kind_ = Kind::plough;
    ratio_ = std::max(0.0, std::sin(apex_.rad() - rake.rad()) / std::sin(rake.rad()));
  }
}

double ChipLimit::at(double from_tip_mm, double from_end_mm) const {
  const double depth_mm = depth_mm_ + slack_mm_;
  switch (kind_) {
    case Kind::plunge: return plunge_at(from_tip_mm);
    case Kind::plough: return ratio_ * depth_mm + slack_mm_;
    case Kind::between: return ratio_ * depth_mm + slack_mm_;
    case Kind::v_shaped: return std::min(from_tip_mm, from_end_mm) <= reach_mm_ ? ratio_ * depth_mm : depth_mm;
  }
  return 0.0;
}

/// Returns the maximum chip thickness of a plunge. The chip consists of two parts: the layer that the last cut left on
/// this facet, and the material on the other facet that is below the rake face.
double ChipLimit::plunge_at(double from_tip_mm) const {
  const double depth_mm = depth_mm_ + slack_mm_;
  const double sine = std::sin(apex_.rad());
  const double cosine = std::cos(apex_.rad());
  const double rake_mm = from_tip_mm * rake_slope_;
  constexpr double kRight = 1e-9;
  // A measuring line starts on the plunged facet. Compute the height of this start point above the surface that the
  // last cut left on the other facet.
  const double over_mm = from_tip_mm * sine - depth_mm;
  if (cosine < -kRight) return std::max(depth_mm, std::min(rake_mm, over_mm / cosine));
  if (cosine > kRight) return depth_mm + std::max(0.0, rake_mm - std::max(depth_mm, over_mm / cosine));
  return over_mm <= slack_mm_ ? std::max(depth_mm, rake_mm) : depth_mm;
}

}  // namespace retrace::fabrication
