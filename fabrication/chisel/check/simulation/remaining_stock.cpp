#include "fabrication/chisel/check/simulation/remaining_stock.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/overloaded.h"

namespace retrace::fabrication {
namespace {

using geometry::Vec2;
using geometry::Vec3;

/// Extent of the modelled part of the blank in a cross-section.
struct SectionExtent {
  double half_mm = 0.0;   ///< half of the width
  double below_mm = 0.0;  ///< depth below the origin of the section
};

/// Extent of the modelled part of the blank beyond the rims and below the root, relative to the size of the element.
constexpr double kBeyond = 0.2;
/// Number of polygons that approximate the blank below a face that is not flat.
constexpr int kStrips = 12;

/// Returns the height of the blank's face in a section.
double face_height_mm(const SectionPlane& plane, const DesignElement& element, const BlankFace& face,
                      double across_mm) {
  const Vec3 foot = plane.origin_mm + across_mm * plane.across;
  double up_mm = element.to_face_mm(foot, plane.up);
  if (face.is_flat()) return up_mm;
  constexpr int kRounds = 6;
  constexpr double kMinNormalCosine = 0.05;
  for (int round = 0; round < kRounds; ++round) {
    const BlankFace::Projection under = face.projection_of(foot + up_mm * plane.up);
    up_mm -= under.height_mm / std::max(kMinNormalCosine, under.normal.dot(plane.up));
  }
  return up_mm;
}

StockSection section_of(const SectionPlane& plane, const DesignElement& element, const BlankFace& face,
                        const SectionExtent& extent) {
  StockSection section;
  section.plane = plane;
  const int strips = face.is_flat() ? 1 : kStrips;
  const auto corner = [&](int k) -> Vec2 {
    const double u = extent.half_mm * (2.0 * k / strips - 1.0);
    return {u, std::max(face_height_mm(plane, element, face, u), -extent.below_mm)};
  };
  for (int k = 0; k < strips; ++k) {
    const Vec2 a = corner(k);
    const Vec2 b = corner(k + 1);
    section.polygons.push_back({{a.x(), -extent.below_mm}, {b.x(), -extent.below_mm}, b, a});
  }
  return section;
}

/// Returns the positions of the sections along the root of a prism. There are sections near both ends, and at least two
/// sections in each pass of the tool.
std::vector<double> stations_mm(const PrismGroove& groove, double wall_mm, double tool_width_mm) {
  const double end_mm = std::max(0.5 * groove.half_width_mm, groove.half_width_mm - wall_mm);
  const int count = 1 + 2 * static_cast<int>(std::ceil(2.0 * groove.half_width_mm / tool_width_mm - 1e-9));
  std::vector<double> stations;
  for (int k = 0; k < count; ++k) stations.push_back(end_mm * (2.0 * k / (count - 1) - 1.0));
  return stations;
}

/// Returns the positions of the cross-sections of a dihedral edge, as distances from the apex along the edge. The first
/// layer begins at a third of the edge length. The second section is slightly beyond this point, so that all layers
/// cross it. The section near the apex is crossed only by the last layers.
std::vector<double> places_mm(double edge_mm, double depth_mm) {
  const double first = std::min(edge_mm / 3.0 + 1.5 * depth_mm, 0.45 * edge_mm);
  return {0.12 * edge_mm, first, 0.6 * edge_mm};
}

std::vector<StockSection> sections_of(const PrismGroove& groove, const BlankFace& face, double wall_mm,
                                      double tool_width_mm) {
  const Vec3 across = groove.axis.cross(groove.root_direction);
  const double rise = groove.axis.dot(groove.facets[0].up_slope);
  const double slope = std::sqrt(1.0 - rise * rise) / rise;
  const SectionExtent extent{(1.0 + kBeyond) * (groove.half_base_mm + slope * groove.stock_mm),
                             kBeyond * groove.depth_mm};
  std::vector<StockSection> sections;
  for (const double along : stations_mm(groove, wall_mm, tool_width_mm))
    sections.push_back(section_of(
        {groove.root_mm + along * groove.root_direction, across, groove.axis, across.cross(groove.axis).normalized()},
        groove, face, extent));
  return sections;
}

std::vector<StockSection> sections_of(const CubeCavity& cavity, const BlankFace& face, double depth_mm) {
  const double edge_mm = std::numbers::sqrt3 * (cavity.depth_mm + cavity.stock_mm);
  std::vector<StockSection> sections;
  for (std::size_t k = 0; k < 3; ++k)
    for (const double place : places_mm(edge_mm, depth_mm)) {
      const Vec3& first = cavity.edges[(k + 1) % 3];
      const Vec3& second = cavity.edges[(k + 2) % 3];
      const Vec3 up = (first + second).normalized();
      const Vec3 across = (first - second).normalized();
      const double half_mm = (edge_mm - place) / std::numbers::sqrt2 + 0.5 * kBeyond * edge_mm;
      sections.push_back(section_of({cavity.root_mm + place * cavity.edges[k], across, up, across.cross(up)}, cavity,
                                    face, {half_mm, 0.5 * kBeyond * edge_mm}));
    }
  return sections;
}

}  // namespace

std::vector<ConvexPolygon> StockSection::cut(std::span<const ToolWedge::Side> sides, const RigidMotion& pose) {
  // Minimum component, in the section plane, of the normal of a side. A side with a smaller component is considered
  // parallel to the section plane.
  constexpr double kAcross = 1e-12;
  const Vec3 u = pose.direction(plane.across);
  const Vec3 v = pose.direction(plane.up);
  const Vec3 origin = pose.point(plane.origin_mm);
  std::vector<HalfPlane> body;
  body.reserve(sides.size());
  for (const ToolWedge::Side& side : sides) {
    const Vec2 outward(side.outward.dot(u), side.outward.dot(v));
    const double bound_mm = side.bound_mm - side.outward.dot(origin);
    const double length = outward.norm();
    if (length > kAcross)
      body.push_back({outward / length, bound_mm / length});
    else if (bound_mm < 0.0)
      return {};
  }
  return subtract(polygons, body);
}

RemainingStock::RemainingStock(const Cavity& groove, const BlankFace& face, double wall_mm, double tool_width_mm,
                               double depth_mm)
    : sections_(std::visit(
          Overloaded{[&](const PrismGroove& prism) { return sections_of(prism, face, wall_mm, tool_width_mm); },
                     [&](const CubeCavity& cavity) { return sections_of(cavity, face, depth_mm); }},
          groove)) {}

}  // namespace retrace::fabrication
