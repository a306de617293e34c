#include "fabrication/chisel/check/chisel_reach.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/angle.h"
#include "core/error.h"
#include "core/number_format.h"
#include "fabrication/chisel/check/cavity.h"
#include "fabrication/chisel/check/simulation/swept_volume.h"
#include "fabrication/job/v_tool.h"
#include "geometry/elements/element_cells.h"

namespace retrace::fabrication {
namespace {

using geometry::Vec2;
using geometry::Vec3;

/// Returns a machine without rotary axes for the simulation. Its linear axes are parallel to the coordinate axes.
/// Instead of rotary axes, the class Cutter rotates the workpiece: the machine frame is the frame of the facet that is
/// cut.
Machine still_machine() {
  Machine machine;
  machine.x.direction.value = Vec3::UnitX();
  machine.y.direction.value = Vec3::UnitY();
  machine.z.direction.value = Vec3::UnitZ();
  return machine;
}

/// Simulates the cutting of one cavity with the planes of the tool.
class Cutter {
 public:
  Cutter(const geometry::Element& element, const Tool& tool)
      : cavity_(cavity_of({}, element)),
        half_mm_(0.5 * tool.width_mm),
        wedge_(tool_wedge(tool, still_machine(), Angle::from_deg(90.0))) {
    for (std::size_t k = 0; k < 3; ++k) plunge(k);
  }

  /// Returns the fraction of a facet that is free of material, sampled on a grid.
  double open_fraction() const {
    constexpr int kGrid = 60;
    constexpr double kOpenMm = 1e-5;
    const double side_mm = cavity_.is_hexagonal ? 0.5 * cavity_.facet_length_mm : cavity_.facet_length_mm;
    int open = 0;
    int all = 0;
    for (int i = 0; i < kGrid; ++i)
      for (int j = 0; j < kGrid; ++j) {
        const Vec2 place((i + 0.5) / kGrid * side_mm, (j + 0.5) / kGrid * side_mm);
        if (!cavity_.is_hexagonal && place.sum() > side_mm) continue;
        ++all;
        const Vec3 point = cavity_.root_mm + place.x() * cavity_.edges[0] + place.y() * cavity_.edges[1];
        if (is_open(point + kOpenMm * cavity_.facets[0].normal)) ++open;
      }
    return static_cast<double>(open) / all;
  }

  double core_mm() const { return surface_over(cavity_.root_mm, Vec3::UnitZ()); }

 private:
  /// Adds plunges down facet `k`, with a horizontal cutting edge. Each plunge ends where an end of the cutting edge
  /// reaches a dihedral edge.
  void plunge(std::size_t k) {
    constexpr int kPasses = 1201;  // odd, so that one pass is at the centre
    const DesignFacet& facet = cavity_.facets[k];
    // In the frame of the tool, the facet is the plane y = 0. Its outward normal is -y, and its upward direction is z.
    RigidMotion pose;
    pose.rotation.row(0) = facet.along.transpose();
    pose.rotation.row(1) = -facet.normal.transpose();
    pose.rotation.row(2) = facet.up_slope.transpose();
    const auto index = static_cast<std::uint32_t>(poses_.size());
    poses_.push_back(pose);
    const double reach_mm = cavity_.facet_length_mm / std::numbers::sqrt2;
    const double most_mm = reach_mm - half_mm_;
    for (int i = 0; i < kPasses; ++i) {
      const double along_mm = most_mm * (2.0 * i / (kPasses - 1) - 1.0);
      const Vec3 tip =
          pose.point(cavity_.root_mm + along_mm * facet.along + (std::abs(along_mm) + half_mm_) * facet.up_slope);
      sweeps_.push_back({index, {1, 0}, false, tip + Vec3(0.0, 0.0, 4.0 * reach_mm), tip});
    }
  }

  /// Returns true if a plunge removes a point.
  bool is_open(const Vec3& point) const {
    constexpr double kNear = 1e-9;
    return std::any_of(sweeps_.begin(), sweeps_.end(), [&](const SweptVolume& sweep) {
      const RigidMotion& pose = poses_[sweep.pose];
      const auto span = swept_span(wedge_, sweep, pose.point(point), pose.direction(Vec3::UnitZ()));
      return span && span->low <= kNear && span->high >= -kNear;
    });
  }

  double surface_over(const Vec3& point, const Vec3& direction) const {
    spans_.clear();
    for (const SweptVolume& sweep : sweeps_) {
      const RigidMotion& pose = poses_[sweep.pose];
      if (const auto span = swept_span(wedge_, sweep, pose.point(point), pose.direction(direction)))
        spans_.push_back(*span);
    }
    return surface_along(spans_, -point.z() / direction.z()).top;
  }

  CubeCavity cavity_;
  double half_mm_;
  ToolWedge wedge_;
  std::vector<RigidMotion> poses_;
  std::vector<SweptVolume> sweeps_;
  mutable std::vector<LineSpan> spans_;
};

}  // namespace

double facet_area_mm2(const geometry::Element& element) {
  const double edge_mm = cavity_edge_mm(element);
  return (std::holds_alternative<geometry::HexagonalCube>(element) ? 0.25 : 0.5) * edge_mm * edge_mm;
}

ChiselReach chisel_reach(const geometry::Element& element, const Tool& tool) {
  const double half_mm = 0.5 * tool.width_mm;
  ChiselReach reach;
  reach.facet_area_mm2 = facet_area_mm2(element);
  reach.fraction = 1.0 - half_mm * half_mm / reach.facet_area_mm2;
  const double rake = Angle::from_deg(tool.clearance_deg + tool.wedge_deg).rad();
  for (std::size_t k = 0; k < 3; ++k) {
    const double azimuth = std::numbers::pi / 3.0 * (2.0 * static_cast<double>(k) + 1.0);
    const Vec3 outwards(std::cos(azimuth), std::sin(azimuth), 0.0);
    const Vec3 up = (outwards + std::numbers::sqrt2 * Vec3::UnitZ()) / std::numbers::sqrt3;
    const Vec3 normal = (Vec3::UnitZ() - std::numbers::sqrt2 * outwards) / std::numbers::sqrt3;
    // The rake face rises away from the facet. The tool is above the rake face.
    reach.caps[k].normal = std::sin(rake) * up - std::cos(rake) * normal;
    reach.caps[k].point_mm = half_mm * up;
  }
  reach.core_mm = reach.caps[0].normal.dot(reach.caps[0].point_mm) / reach.caps[0].normal.z();
  const Cutter cutter(element, tool);
  reach.cut_fraction = cutter.open_fraction();
  reach.cut_core_mm = cutter.core_mm();
  return reach;
}

void check_chisel_reach(const geometry::Element& element, const Tool& tool, const InputLocation& width,
                        const InputLocation& wedge) {
  const double least_deg = Angle::from_rad(std::atan(std::sqrt(0.5))).deg();
  const double rake_deg = tool.clearance_deg + tool.wedge_deg;
  if (rake_deg <= least_deg)
    throw InputError(wedge, fmt::format("the sum of wedge_deg and clearance_deg must be > {}, otherwise fins remain "
                                        "along the dihedral edges, got {}",
                                        fixed_apart(least_deg, rake_deg, 3), shortest(rake_deg)));
  const double rake = Angle::from_deg(rake_deg).rad();
  // Height of the uncut core above the apex, per mm of the tool's width.
  const double rise =
      0.5 * std::sin(rake) * std::numbers::sqrt3 / (std::numbers::sqrt2 * std::sin(rake) - std::cos(rake));
  const double most_mm = geometry::element_depth_mm(element) / rise;
  if (tool.width_mm >= most_mm)
    throw InputError(
        width,
        fmt::format(
            "must be < {}, otherwise the remaining material above the apex reaches the face of the blank, got {}",
            fixed_apart(most_mm, tool.width_mm, 6), shortest(tool.width_mm)));
}

}  // namespace retrace::fabrication
