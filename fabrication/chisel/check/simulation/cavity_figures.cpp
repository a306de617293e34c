#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/angle.h"
#include "fabrication/chisel/check/simulation/facet_figures.h"
#include "fabrication/chisel/check/simulation/plane_fit.h"

namespace retrace::fabrication {
namespace {

using geometry::Vec2;
using geometry::Vec3;

/// Nearer to a dihedral edge than this a line runs into what the other facet keeps as soon as that is off: what is left
/// counts for the edge, and so far from the facet.
constexpr double kStripMm = 1e-3;
/// Where what is left at an edge is taken, and where the facet begins.
constexpr double kAtEdgeMm = 1.5e-6;
constexpr double kBesideEdgeMm = 8e-6;
/// Lines stay this share of a facet within its borders.
constexpr double kWithin = 1e-6;
/// Directions from the apex on both sides of the tool's leading edge.
constexpr double kBesideLeadingRad = 1e-5;

/// Places of a facet: along its two dihedral edges, from the apex.
class Places {
 public:
  /// \param turn of the facet in the tool's view
  Places(double edge_mm, bool is_hexagonal, double nose_angle_deg, Angle turn)
      : edge_mm_(edge_mm),
        is_hexagonal_(is_hexagonal),
        leading_rad_(Angle::from_deg(45.0 + 0.5 * nose_angle_deg).rad() - turn.rad()) {}

  std::vector<Vec2> all() const {
    std::vector<Vec2> places;
    constexpr double kQuarter = 0.5 * std::numbers::pi;
    constexpr int kDirections = 9;
    std::vector<double> directions = {leading_rad_ - kBesideLeadingRad, leading_rad_ + kBesideLeadingRad};
    for (int i = 0; i < kDirections; ++i) directions.push_back((i + 0.4871) / kDirections * kQuarter);
    for (const double direction : directions) {
      const Vec2 unit(std::cos(direction), std::sin(direction));
      for (const double share : shares()) {
        const Vec2 place = share * reach(unit) * unit;
        // Nearer to the apex than that a line runs along both other facets, as near as their words are rounded.
        if (place.maxCoeff() >= kBesideEdgeMm) places.push_back(place);
      }
    }
    for (const double off : {kAtEdgeMm, kBesideEdgeMm})
      for (const double share : shares()) {
        const double along = share * (is_hexagonal_ ? 0.5 * edge_mm_ : edge_mm_ - off);
        places.emplace_back(along, off);
        places.emplace_back(off, along);
      }
    return places;
  }

 private:
  static std::vector<double> shares() {
    return {1e-4, 0.013, 0.11, 0.23, 0.37, 0.49, 0.61, 0.73, 0.87, 0.97, 1.0 - kWithin};
  }
  /// From the apex to the facet's border.
  double reach(const Vec2& unit) const {
    return is_hexagonal_ ? 0.5 * edge_mm_ / unit.maxCoeff() : edge_mm_ / unit.sum();
  }

  double edge_mm_;
  bool is_hexagonal_;
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

/// Share of a facet's breadth at its edges, and of its edges' length below the blank's face, from which its plane is
/// not taken: a facet that stands above its design leaves the blank there.
constexpr double kPlaneMargin = 0.02;

void take(FacetFigures& figures, const Vec2& place, const LineSurface& surface) {
  const double lowest_mm = std::min(surface.lowest, surface.top);
  FacetDeviation& left = place.minCoeff() <= kStripMm ? figures.root : figures.highest;
  if (surface.top * kNmPerMm > left.nm) left = {surface.top * kNmPerMm, surface.top_line};
  if (lowest_mm * kNmPerMm < figures.deepest.nm) figures.deepest = {lowest_mm * kNmPerMm, surface.lowest_line};
}

}  // namespace

ElementFigures cavity_figures(const Groove& cavity, bool is_hexagonal, std::span<const SweptVolume> sweeps,
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
    const std::vector<Vec2> places = Places(edge_mm, is_hexagonal, nose_angle_deg, prediction.poses[k].root_tilt).all();
    FacetFigures facet;
    PlaneFit plane;
    for (const Vec2& place : places) {
      const Vec3 point = cavity.root_mm + place.x() * first + place.y() * second;
      const Vec3& normal = cavity.facets[k].normal;
      const double at_face = cavity.to_face_mm(point, normal);
      const double exit = place.minCoeff() <= kStripMm ? std::min(at_face, kStripMm) : at_face;
      const LineSurface surface = surface_at(point, normal, exit, sweeps, poses, wedge, spans);
      take(facet, place, surface);
      if (std::min(place.minCoeff(), at_face) < kPlaneMargin * edge_mm) continue;
      plane.add(place.sum() / std::numbers::sqrt2, (place.y() - place.x()) / std::numbers::sqrt2, surface.lowest);
    }
    plane.fit(facet);
    facet.distance_nm = std::max(facet.highest.nm, -facet.deepest.nm);
    const double area_mm2 = (is_hexagonal ? 0.25 : 0.5) * edge_mm * edge_mm;
    facet.residual_mm3 = facet.mean_nm / kNmPerMm * area_mm2;
    figures.facets.push_back(facet);
  }
  return figures;
}

}  // namespace retrace::fabrication
