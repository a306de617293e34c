#include "fabrication/chisel/check/simulation/nose.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/angle.h"

namespace retrace::fabrication {
namespace {

using geometry::Vec3;

/// Maximum distance from a dihedral edge up to which cuts are searched, in radii of the nose.
constexpr double kFurthest = 40.0;
/// Maximum height of the tool's tip above the facets at the lower end of a cut, in radii of the nose. Cuts that stay
/// higher do not reach the dihedral edges and are ignored.
constexpr double kNear = 20.0;

/// Returns the normalised component of a vector that is perpendicular to a unit vector.
Vec3 across(const Vec3& v, const Vec3& unit) {
  return (v - unit * unit.dot(v)).normalized();
}

class Searcher {
 public:
  Searcher(const CubeCavity& cavity, double radius_mm, std::span<const SweptVolume> sweeps,
           std::span<const RigidMotion> poses, const ToolWedge& nosed)
      : cavity_(cavity), radius_mm_(radius_mm), poses_(poses), nosed_(nosed) {
    for (const SweptVolume& sweep : sweeps)
      if (is_near(sweep)) sweeps_.push_back(sweep);
  }

  NoseResidue run() const {
    NoseResidue residue;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& edge = cavity_.edges[k];
      // Position of the measurement. For a hexagonal element, it is the centre of the dihedral edge.
      const Vec3 place = cavity_.root_mm + 0.25 * cavity_.facet_length_mm * edge;
      for (const std::size_t facet : {k, (k + 2) % 3}) {
        const Vec3& normal = cavity_.facets[facet].normal;
        residue.strip_mm =
            std::max(residue.strip_mm,
                     strip_mm(place,
                              normal.cross(edge).dot(cavity_.facets[facet].up_slope) > 0.0 ? Vec3(normal.cross(edge))
                                                                                           : Vec3(edge.cross(normal)),
                              normal));
      }
      const Vec3 between = (cavity_.facets[k].normal + cavity_.facets[(k + 2) % 3].normal).normalized();
      residue.ridge_mm = std::max(residue.ridge_mm, first_cut_mm(place, between, kFurthest * radius_mm_));
    }
    return residue;
  }

 private:
  bool is_near(const SweptVolume& sweep) const {
    const RigidMotion back = poses_[sweep.pose].inverse();
    double least_mm = std::numeric_limits<double>::infinity();
    for (const Vec3& tip : {back.point(sweep.from_mm), back.point(sweep.to_mm)}) {
      double most_mm = -std::numeric_limits<double>::infinity();
      for (const DesignFacet& facet : cavity_.facets) most_mm = std::max(most_mm, facet.height_mm(tip));
      least_mm = std::min(least_mm, most_mm);
    }
    return least_mm < kNear * radius_mm_;
  }

  /// Returns the distance from `point` to the first cut along a line, or `furthest_mm` if there is none.
  double first_cut_mm(const Vec3& point, const Vec3& direction, double furthest_mm) const {
    double first = furthest_mm;
    for (const SweptVolume& sweep : sweeps_) {
      const RigidMotion& pose = poses_[sweep.pose];
      const auto span = swept_span(nosed_, sweep, pose.point(point), pose.direction(direction));
      if (span && span->high > 0.0) first = std::min(first, std::max(span->low, 0.0));
    }
    return first;
  }

  /// Finds, by bisection, the minimum distance from the dihedral edge at which a cut exists close to the facet. A cut
  /// is close if its height above the facet is less than half of the radius. The height is not exactly 0, because the
  /// ends of the arc are slightly above the facet due to the clearance angle.
  double strip_mm(const Vec3& edge_point, const Vec3& along_facet, const Vec3& normal) const {
    const double high_mm = 0.5 * radius_mm_;
    double low = 0.0;
    double high = kFurthest * radius_mm_;
    constexpr int kHalvings = 32;
    for (int i = 0; i < kHalvings; ++i) {
      const double middle = 0.5 * (low + high);
      (first_cut_mm(edge_point + middle * along_facet, normal, high_mm) < high_mm ? high : low) = middle;
    }
    return high;
  }

  const CubeCavity& cavity_;
  double radius_mm_;
  std::span<const RigidMotion> poses_;
  const ToolWedge& nosed_;
  std::vector<SweptVolume> sweeps_;
};

}  // namespace

ToolWedge nosed_wedge(const Tool& tool, const Machine& machine) {
  ToolWedge wedge = v_tool_wedge(tool, machine);
  const Vec3 leading = wedge.edge;
  const Vec3 trailing = wedge.clearance_direction;
  const Vec3 spine = wedge.rake_direction;
  const double radius_mm = 1e-3 * tool.edge_radius_um;
  const double half_nose = Angle::from_deg(0.5 * tool.nose_angle_deg).rad();
  const Vec3 middle = (leading + trailing).normalized();
  const Vec3 centre = radius_mm / std::sin(half_nose) * middle;
  // Rotate from the outward normal of one edge to the outward normal of the other edge.
  const Vec3 first = -across(trailing, leading);
  const Vec3 last = -across(leading, trailing);
  const double angle = std::acos(std::clamp(first.dot(last), -1.0, 1.0));
  const Vec3 turned = across(last, first);
  // Number of tangent planes that approximate the arc of the nose, without the flanks at its ends.
  constexpr int tangents = 32;
  for (int k = 1; k <= tangents; ++k) {
    const double at = angle * k / (tangents + 1);
    const Vec3 outwards = std::cos(at) * first + std::sin(at) * turned;
    const Vec3 along = -std::sin(at) * first + std::cos(at) * turned;
    Vec3 normal = along.cross(spine).normalized();
    if (normal.dot(outwards) < 0.0) normal = -normal;
    wedge.sides.push_back({normal, normal.dot(centre + radius_mm * outwards)});
  }
  return wedge;
}

NoseResidue nose_residue(const CubeCavity& cavity, double radius_mm, std::span<const SweptVolume> sweeps,
                         std::span<const RigidMotion> poses, const ToolWedge& nosed) {
  return Searcher(cavity, radius_mm, sweeps, poses, nosed).run();
}

}  // namespace retrace::fabrication
