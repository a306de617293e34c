#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/angle.h"
#include "core/length_units.h"
#include "fabrication/chisel/check/simulation/facet_figures.h"
#include "fabrication/chisel/check/simulation/plane_fit.h"
#include "fabrication/job/fins.h"

namespace retrace::fabrication {
namespace {

using geometry::Vec2;
using geometry::Vec3;

/// Width of the strip along a dihedral edge in which residual material is attributed to the edge and not to a facet. A
/// measuring line in this strip also crosses residual material of the neighbouring facet.
constexpr double kStripMm = kEdgeStripMm;
/// Minimum distance of measuring lines from the border of a facet, as a fraction of the facet's size.
constexpr double kWithin = 1e-6;
/// Angle, in rad, between the tool's leading edge and the measured directions. There is one measured direction on each
/// side of the edge.
constexpr double kBesideLeadingRad = 1e-5;

/// Generates the points at which a facet is measured. Their coordinates are distances from the apex along the two
/// dihedral edges of the facet.
class Places {
 public:
  /// \param edges_mm lengths of the two dihedral edges
  /// \param turn angle by which the facet is rotated about its normal, relative to the tool
  /// \param step_mm least increment of the control
  Places(const Vec2& edges_mm, bool is_hexagonal, double nose_angle_deg, Angle turn, double step_mm)
      : edges_mm_(edges_mm),
        is_hexagonal_(is_hexagonal),
        step_mm_(step_mm),
        leading_rad_(Angle::from_deg(45.0 + 0.5 * nose_angle_deg).rad() - turn.rad()) {}

  std::vector<Vec2> all() const {
    std::vector<Vec2> places;
    constexpr double kQuarter = 0.5 * std::numbers::pi;
    constexpr int kDirections = 9;
    std::vector<double> directions = {leading_rad_ - kBesideLeadingRad, leading_rad_ + kBesideLeadingRad};
    for (int i = 0; i < kDirections; ++i) directions.push_back((i + 0.4871) / kDirections * kQuarter);
    for (const double direction : directions) {
      const Vec2 unit(std::cos(direction), std::sin(direction));
      for (const double share : fractions()) {
        const Vec2 place = share * reach(unit) * unit;
        places.push_back(place);
      }
    }
    for (const double steps : kEdgeLineSteps)
      for (const double share : fractions()) {
        const double off = steps * step_mm_;
        places.emplace_back(share * along(0, off), off);
        places.emplace_back(off, share * along(1, off));
      }
    return places;
  }

 private:
  static std::vector<double> fractions() {
    return {1e-4, 0.013, 0.11, 0.23, 0.37, 0.49, 0.61, 0.73, 0.87, 0.97, 1.0 - kWithin};
  }
  /// Returns the distance from the apex to the border of the facet in a direction.
  double reach(const Vec2& unit) const {
    const Vec2 shares = unit.cwiseQuotient(edges_mm_);
    return is_hexagonal_ ? 0.5 / shares.maxCoeff() : 1.0 / shares.sum();
  }
  /// Returns the length of the facet along one of its dihedral edges, at the distance `off_mm` from this edge.
  double along(Eigen::Index edge, double off_mm) const {
    return is_hexagonal_ ? 0.5 * edges_mm_[edge] : edges_mm_[edge] - off_mm;
  }

  Vec2 edges_mm_;
  bool is_hexagonal_;
  double step_mm_;
  double leading_rad_;
};

LineSurface surface_at(const Vec3& point, const Vec3& direction, double exit, std::span<const SweptVolume> sweeps,
                       std::span<const RigidMotion> poses, const ToolWedge& wedge, std::vector<LineSpan>& spans) {
  spans.clear();
  for (const SweptVolume& sweep : sweeps)
    if (const auto span =
            swept_span(wedge, sweep, poses[sweep.pose].point(point), poses[sweep.pose].direction(direction)))
      spans.push_back(*span);
  return surface_along(spans, exit);
}

/// Returns the height above a facet, along its normal, up to which material is attributed to this facet. The following
/// limits apply:
/// - the blank's face,
/// - another facet, if the angle between both facets is less than 90 degrees,
/// - the width of the strip along a dihedral edge, if the point is in this strip,
/// - the height of a fin, if the point is close to both other facets. Near the apex, the normal is nearly parallel to
///   the common dihedral edge of the other facets. Rounded positions may leave a fin (thin ridge) along this edge.
double exit_of(const CubeCavity& cavity, std::size_t facet, const Vec3& point, bool is_at_edge, double fin_mm) {
  constexpr double kParallel = 1e-9;
  const Vec3& normal = cavity.facets[facet].normal;
  double exit = cavity.to_face_mm(point, normal);
  if (is_at_edge) exit = std::min(exit, kStripMm);
  double fin_exit = -std::numeric_limits<double>::infinity();
  for (std::size_t other = 0; other < cavity.facets.size(); ++other) {
    if (other == facet) continue;
    const double towards = -normal.dot(cavity.facets[other].normal);
    const double height_mm = cavity.facets[other].height_mm(point);
    const double over_fin_mm = height_mm - fin_mm;
    if (towards >= kParallel) {
      exit = std::min(exit, (is_at_edge ? 0.5 * height_mm : height_mm - kStripMm) / towards);
      fin_exit = std::max(fin_exit, over_fin_mm / towards);
    } else if (over_fin_mm >= 0.0) {
      fin_exit = std::numeric_limits<double>::infinity();
    }
  }
  return std::min(exit, fin_exit);
}

/// Width of the margins that are excluded from the fit of a facet's plane, relative to the edge length. There are
/// margins along the dihedral edges and below the blank's face. The margin below the face is needed because a facet
/// that was cut too high ends before its designed rim.
constexpr double kPlaneMargin = 0.02;

void take(FacetFigures& figures, const Vec2& place, const LineSurface& surface) {
  const double lowest_mm = std::min(surface.lowest, surface.top);
  FacetDeviation& left = place.minCoeff() <= kStripMm ? figures.root : figures.highest;
  if (surface.top * kNmPerMm > left.nm) left = {surface.top * kNmPerMm, surface.top_line};
  if (lowest_mm * kNmPerMm < figures.deepest.nm) figures.deepest = {lowest_mm * kNmPerMm, surface.lowest_line};
}

}  // namespace

ElementFigures cavity_figures(const CubeCavity& cavity, std::span<const SweptVolume> sweeps,
                              std::span<const RigidMotion> poses, const ToolWedge& wedge, double nose_angle_deg,
                              const Prediction& prediction) {
  ElementFigures figures;
  figures.is_cut = !sweeps.empty();
  if (!figures.is_cut) return figures;
  const double edge_mm = cavity.facet_length_mm;
  std::vector<LineSpan> spans;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3& first = cavity.edges[k];
    const Vec3& second = cavity.edges[(k + 1) % 3];
    const Vec2 edges_mm(cavity.edge_length_mm(k), cavity.edge_length_mm((k + 1) % 3));
    const std::vector<Vec2> places =
        Places(edges_mm, cavity.is_hexagonal, nose_angle_deg, prediction.poses[k].root_tilt, prediction.step_mm).all();
    FacetFigures facet;
    PlaneFit plane;
    for (const Vec2& place : places) {
      const Vec3 from_apex = place.x() * first + place.y() * second;
      const Vec3 point = cavity.root_mm + from_apex;
      const Vec3& normal = cavity.facets[k].normal;
      const double at_face = cavity.to_face_mm(point, normal);
      const double exit = exit_of(cavity, k, point, place.minCoeff() <= kStripMm, prediction.fin_mm);
      if (exit <= 0.0) continue;
      const LineSurface surface = surface_at(point, normal, exit, sweeps, poses, wedge, spans);
      take(facet, place, surface);
      if (std::min(place.minCoeff(), at_face) < kPlaneMargin * edge_mm) continue;
      plane.add(cavity.facets[k].up_slope.dot(from_apex), cavity.facets[k].along.dot(from_apex), surface.lowest);
    }
    plane.fit(facet);
    facet.distance_nm = std::max(facet.highest.nm, -facet.deepest.nm);
    const double area_mm2 = (cavity.is_hexagonal ? 0.25 : 0.5) * edges_mm.prod() * first.cross(second).norm();
    facet.residual_mm3 = facet.mean_nm / kNmPerMm * area_mm2;
    figures.facets.push_back(facet);
  }
  return figures;
}

}  // namespace retrace::fabrication
