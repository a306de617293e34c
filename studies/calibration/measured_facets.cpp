#include "studies/calibration/measured_facets.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <Eigen/QR>
#include <cmath>
#include <numbers>

#include "core/length_units.h"
#include "fabrication/chisel/plan/edge_cuts.h"
#include "fabrication/machine/setup.h"

namespace retrace::studies {
namespace {

using namespace fabrication;
using geometry::Vec3;

/// Minimum sine of the angle between two facets. Below it, a small tilt of a facet does not change the angle.
constexpr double kParallel = 1e-6;

/// Returns the angle of the groove between two facets with the given normals, measured outside of the material.
double included_rad(const Vec3& a, const Vec3& b) {
  return std::numbers::pi - std::atan2(a.cross(b).norm(), a.dot(b));
}

/// Returns a direction as text: "+X", "-Y" etc. for a direction along an axis, otherwise its components.
std::string direction_text(const Vec3& direction) {
  constexpr double kAlongAxis = 0.99;
  for (Eigen::Index axis = 0; axis < 3; ++axis)
    if (std::abs(direction[axis]) > kAlongAxis)
      return fmt::format("{}{}", direction[axis] < 0.0 ? '-' : '+', "XYZ"[axis]);
  return fmt::format("({:.3f} {:.3f} {:.3f})", direction.x(), direction.y(), direction.z());
}

Eigen::Matrix3d rotation_by(const Vec3& turn_arcsec) {
  const Vec3 turn = turn_arcsec / kArcsecPerRad;
  if (turn.isZero(0.0)) return Eigen::Matrix3d::Identity();
  return rotation_about(turn.normalized(), Angle::from_rad(turn.norm()));
}

}  // namespace

Eigen::Matrix3d PartPose::face_rotation() const {
  return rotation_by(rotation_arcsec);
}

Eigen::Matrix3d PartPose::rotation() const {
  return rotation_by(rotation_arcsec) * rotation_by({face_rotation_arcsec.x(), face_rotation_arcsec.y(), 0.0});
}

CutPart::CutPart(const FabricationResult& result, const std::vector<std::size_t>& elements)
    : cavities_(designed_cavities(result.job)), half_edge_mm_(0.5 * result.job.tool.width_mm) {
  for (const FacetEdgeCut& cut : facet_edge_cuts(result.job, result.plan, elements))
    if (cut.ends_at_root || cut.is_ploughed) cuts_[{cut.element, cut.facet}] = cut.cut;
}

std::string CutPart::obstacle_for(const Measurement& m) const {
  for (const std::optional<FacetId>& place : {std::optional(m.at), m.from}) {
    if (!place) continue;
    if (place->element >= cavities_.size())
      return fmt::format("the elements of the job have the numbers 0 to {}, got {}", cavities_.size() - 1,
                         place->element);
    const std::size_t facets = common(cavities_[place->element]).facets.size();
    if (place->facet >= facets)
      return fmt::format("the facets of element {} have the numbers 1 to {}, got {}", place->element, facets,
                         place->facet + 1);
    if (!cuts_.contains({place->element, place->facet})) return fmt::format("element {} is not cut", place->element);
  }
  if (m.what == FacetQuantity::angle) {
    if (!m.from)
      return "from_element and from_facet must be given for an angle, because it is measured between two facets";
    const Vec3& a = common(cavities_[m.at.element]).facets[m.at.facet].normal;
    const Vec3& b = common(cavities_[m.from->element]).facets[m.from->facet].normal;
    if (a.cross(b).norm() < kParallel) return "the two facets of an angle must not be parallel";
  }
  if (m.what == FacetQuantity::cut_end && m.from)
    return "from_element and from_facet must be empty for end_nm, which is the height above the other facet of this "
           "element";
  return {};
}

std::string CutPart::positive_sense(const Measurement& m) const {
  switch (m.what) {
    case FacetQuantity::distance: return "material is left";
    case FacetQuantity::tilt_up: return "rises away from the root";
    case FacetQuantity::tilt_along:
      return "rises towards " + direction_text(common(cavities_[m.at.element]).facets[m.at.facet].along);
    case FacetQuantity::angle: return "opens the groove";
    case FacetQuantity::depth: return "deeper";
    case FacetQuantity::cut_end: break;
  }
  return "ends above the other facet";
}

CutPart::MachinedFacet CutPart::machined_facet(const FacetId& at, const Machine& real, const PartPose& pose) const {
  const Cavity& groove = cavities_[at.element];
  MachinedFacet facet{&groove, at.facet, {}};
  facet.plane = cut_plane(real, cuts_.at({at.element, at.facet}), facet.design().normal);
  const Eigen::Matrix3d rotation = pose.rotation();
  facet.plane.point_mm = kMmPerUm * pose.shift_um + rotation * facet.plane.point_mm;
  facet.plane.normal = rotation * facet.plane.normal;
  return facet;
}

double CutPart::depth_nm(const FacetId& at, const Machine& real, const PartPose& pose) const {
  const DesignElement& groove = common(cavities_[at.element]);
  const auto facets = static_cast<Eigen::Index>(groove.facets.size());
  Eigen::MatrixXd normals(facets, 3);
  Eigen::VectorXd heights(facets);
  for (Eigen::Index f = 0; f < facets; ++f) {
    const MachinedFacet facet = machined_facet({at.element, static_cast<std::size_t>(f)}, real, pose);
    normals.row(f) = facet.plane.normal.transpose();
    heights[f] = facet.plane.normal.dot(facet.plane.point_mm - groove.root_mm);
  }
  const Vec3 root = normals.completeOrthogonalDecomposition().solve(heights);
  return -kNmPerMm * groove.axis.dot(root);
}

double CutPart::end_nm(const Measurement& m, const Machine& real) const {
  const std::size_t facets = common(cavities_[m.at.element]).facets.size();
  const MachinedFacet other = machined_facet({m.at.element, (m.at.facet + 1) % facets}, real, {});
  const EdgeCut& cut = cuts_.at({m.at.element, m.at.facet});
  const RigidMotion back = machine_from_workpiece(real, rotary_pose(real, cut.at)).inverse();
  const Vec3 end =
      back.point(machine_point(real, cut.at) + edge_frame(real) * cut.tip_mm +
                 (real.tilt == Tilt::table ? m.along_edge * half_edge_mm_ : 0.0) * cutting_edge(real, cut.edge_rise));
  return kNmPerMm * other.plane.normal.dot(end - other.plane.point_mm);
}

double CutPart::of_one(const Measurement& m, const FacetId& at, const Machine& real, const PartPose& pose) const {
  const MachinedFacet facet = machined_facet(at, real, pose);
  switch (m.what) {
    case FacetQuantity::distance: {
      const Vec3 place = m.position_mm
                             ? Vec3(common(*facet.cavity).root_mm + m.position_mm->x() * facet.design().up_slope +
                                    m.position_mm->y() * facet.design().along)
                             : facet_centre(*facet.cavity, at.facet);
      return kNmPerMm * facet.height_mm(place);
    }
    case FacetQuantity::tilt_up: return kArcsecPerRad * facet.rise(facet.design().up_slope);
    case FacetQuantity::tilt_along: return kArcsecPerRad * facet.rise(facet.design().along);
    case FacetQuantity::angle: {
      const MachinedFacet other = machined_facet(*m.from, real, pose);
      return kArcsecPerRad * (included_rad(facet.plane.normal, other.plane.normal) -
                              included_rad(facet.design().normal, other.design().normal));
    }
    case FacetQuantity::depth: return depth_nm(at, real, pose);
    case FacetQuantity::cut_end: break;
  }
  return end_nm(m, real);
}

double CutPart::predicted(const Measurement& m, const Machine& real, const PartPose& pose) const {
  const double value = of_one(m, m.at, real, pose);
  return m.from && m.what != FacetQuantity::angle ? value - of_one(m, *m.from, real, pose) : value;
}

}  // namespace retrace::studies
