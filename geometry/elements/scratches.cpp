// Scratches along the facets of prisms, from root to rim.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <vector>

#include "geometry/elements/scratches.h"

namespace retrace::geometry {
namespace {

// Width, relative to an element's size, below which facets are attributed to rounding errors and omitted.
constexpr double kSliver = 1e-9;

/// Interval along the roof edge in which the height of the surface above the facet's plane is linear.
struct Stretch {
  double from_mm = 0.0, to_mm = 0.0;
  double from_height_mm = 0.0, to_height_mm = 0.0;

  bool is_scratch() const { return from_height_mm != 0.0 || to_height_mm != 0.0; }
};

/// Returns the profile of a facet along the roof edge, from one end of the prism to the other. The origin is the centre
/// of the roof edge.
/// \param height_per_depth change of height when a plane is moved by a unit along its normal
std::vector<Stretch> profile_of(const std::vector<Scratch>& scratches, std::size_t facet, double half_length_mm,
                                double height_per_depth) {
  std::vector<Scratch> own;
  std::copy_if(scratches.begin(), scratches.end(), std::back_inserter(own),
               [&](const Scratch& s) { return s.facet == facet; });
  std::sort(own.begin(), own.end(), [](const Scratch& a, const Scratch& b) { return a.position_mm < b.position_mm; });
  std::vector<Stretch> profile;
  double reached_mm = -half_length_mm;
  for (const Scratch& s : own) {
    const double from_mm = s.position_mm - 0.5 * s.width_mm;
    const double to_mm = s.position_mm + 0.5 * s.width_mm;
    const double height_mm = s.depth_mm * height_per_depth;
    profile.push_back({reached_mm, from_mm, 0.0, 0.0});
    profile.push_back({from_mm, s.position_mm, 0.0, height_mm});
    profile.push_back({s.position_mm, to_mm, height_mm, 0.0});
    reached_mm = to_mm;
  }
  profile.push_back({reached_mm, half_length_mm, 0.0, 0.0});
  return profile;
}

/// Roof edge of a prism's cell, with coordinates along it.
struct RoofEdge {
  Eigen::Index axis = 1;  ///< axis along the edge
  double sign = 1.0;      ///< sign of this axis in the direction of the prism's own +y
  double middle_mm = 0.0;
  double half_length_mm = 0.0;

  /// Returns the strip of the xy plane in which the coordinate along the roof edge is within an interval.
  Rectangle band(const Stretch& stretch) const {
    constexpr double far = 1e9;
    Rectangle band{Vec2::Constant(-far), Vec2::Constant(far)};
    const double a = middle_mm + sign * stretch.from_mm;
    const double b = middle_mm + sign * stretch.to_mm;
    band.lower[axis] = std::min(a, b);
    band.upper[axis] = std::max(a, b);
    return band;
  }
};

RoofEdge roof_edge_of(const Cell& cell) {
  const Rectangle box = bounding_box(cell.outline);
  RoofEdge edge;
  edge.axis = cell.rotated ? 0 : 1;
  edge.sign = cell.rotated ? -1.0 : 1.0;
  edge.middle_mm = 0.5 * (box.lower[edge.axis] + box.upper[edge.axis]);
  edge.half_length_mm = 0.5 * box.size()[edge.axis];
  return edge;
}

/// Returns the portion of a facet in an interval, at the height of the scratch. The outline is empty if the interval
/// does not overlap the facet.
CellFacet piece_of(const CellFacet& facet, const Stretch& stretch, const RoofEdge& edge, double sliver_mm) {
  CellFacet piece = facet;
  piece.outline = clip(facet.outline, edge.band(stretch), sliver_mm);
  if (piece.outline.empty() || !stretch.is_scratch()) return piece;
  piece.is_edge = true;
  piece.centroid_mm.reset();
  const double rise = edge.sign * (stretch.to_height_mm - stretch.from_height_mm) / (stretch.to_mm - stretch.from_mm);
  piece.plane.slope[edge.axis] += rise;
  piece.plane.height_mm += stretch.from_height_mm - rise * (edge.middle_mm + edge.sign * stretch.from_mm);
  return piece;
}

}  // namespace

Cell with_scratches(const Cell& cell, const PartSpec& spec) {
  if (!cell.is_element || spec.scratches.empty()) return cell;
  const RoofEdge edge = roof_edge_of(cell);
  const double half_apex_rad = 0.5 * std::get<RtpElement>(spec.element).apex_angle_deg * std::numbers::pi / 180.0;
  const double sliver_mm = kSliver * edge.half_length_mm;
  Cell scratched = cell;
  scratched.facets.clear();
  for (const CellFacet& facet : cell.facets) {
    const double across = facet.plane.slope[1 - edge.axis];
    // The flat of a chamfered root belongs to no facet and is therefore not scratched.
    if (across == 0.0) {
      scratched.facets.push_back(facet);
      continue;
    }
    for (const Stretch& stretch :
         profile_of(spec.scratches, across < 0.0 ? 0 : 1, edge.half_length_mm, 1.0 / std::sin(half_apex_rad))) {
      CellFacet piece = piece_of(facet, stretch, edge, sliver_mm);
      if (!piece.outline.empty()) scratched.facets.push_back(std::move(piece));
    }
  }
  return scratched;
}

}  // namespace retrace::geometry
