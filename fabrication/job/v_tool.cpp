#include "fabrication/job/v_tool.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/angle.h"
#include "core/number_format.h"
#include "fabrication/job/cube_corner.h"
#include "fabrication/job/fins.h"
#include "geometry/elements/element_cells.h"

namespace retrace::fabrication {
namespace {

using geometry::Vec3;

double rad(double deg) {
  return Angle::from_deg(deg).rad();
}

/// Returns the sum of the two angular sectors that the cuts along both facets remove at a dihedral edge. If the sum is
/// less than 90 degrees, a fin remains between the cuts.
double covered_deg(const VToolEdges& edges) {
  const Vec3& s = edges.spine;
  return Angle::from_rad(std::atan2(s.z(), s.y()) + std::atan2(s.z(), s.x())).deg();
}

}  // namespace

VToolEdges v_tool_edges(const Tool& tool) {
  const double half = rad(0.5 * tool.nose_angle_deg);
  const double from_second = rad(45.0) - half;  // the angle between the two dihedral edges of a facet is 90 degrees
  VToolEdges edges;
  edges.leading = {std::sin(from_second), std::cos(from_second), 0.0};
  const Vec3 behind(std::cos(from_second), -std::sin(from_second), 0.0);
  const double c = rad(tool.clearance_deg);
  const Vec3 across = std::cos(c) * behind + std::sin(c) * Vec3::UnitZ();
  const Vec3 into_tool = std::cos(c) * Vec3::UnitZ() - std::sin(c) * behind;
  edges.trailing = std::cos(2.0 * half) * edges.leading + std::sin(2.0 * half) * across;
  const Vec3 middle = std::cos(half) * edges.leading + std::sin(half) * across;
  const double rise = std::atan(std::sin(half) * std::tan(rad(tool.wedge_deg)));
  edges.spine = std::cos(rise) * middle + std::sin(rise) * into_tool;
  return edges;
}

double cavity_edge_mm(const geometry::Element& element) {
  return std::numbers::sqrt3 * geometry::element_depth_mm(element);
}

double nose_strip_mm(const Tool& tool) {
  return 1e-3 * tool.edge_radius_um * (std::sin(rad(45.0)) / std::sin(rad(0.5 * tool.nose_angle_deg)) - 1.0);
}

void check_v_tool(const geometry::Element& element, const geometry::AngleErrors& errors, const Tool& tool,
                  const schema::Refuse& refuse) {
  // Maximum deviation of the element's angles from 90 degrees.
  double error_deg = 0.0;
  double edge_mm = cavity_edge_mm(element);
  const CubeCorner corner = cube_corner(element, errors);
  if (errors != geometry::AngleErrors{}) {
    error_deg = corner.largest_error_deg();
    for (const Vec3& edge : corner.edges) edge_mm = std::max(edge_mm, corner.depth_mm / edge.z());
  }
  if (tool.nose_angle_deg >= 90.0 - error_deg)
    refuse("tool.nose_angle_deg",
           fmt::format("must be < {}, the angle between the dihedral edges of a facet, for "
                       "the tool to reach the apex, got {}",
                       error_deg == 0.0 ? "90" : fixed(90.0 - error_deg, 4), shortest(tool.nose_angle_deg)));
  const VToolEdges edges = v_tool_edges(tool);
  for (const Vec3& edge : {edges.leading, edges.trailing, edges.spine})
    if (edge.z() < 0.0 || edge.head<2>().minCoeff() < std::sin(rad(error_deg)))
      refuse("tool.wedge_deg", fmt::format("is too large: with the given tool.nose_angle_deg and tool.clearance_deg, "
                                           "the tool cuts into a neighbouring facet at the apex, got {}",
                                           shortest(tool.wedge_deg)));
  if (covered_deg(edges) < 90.0 + error_deg)
    refuse("tool.wedge_deg", fmt::format("is too small: with the given tool.nose_angle_deg and tool.clearance_deg, the "
                                         "cuts of two facets leave a fin along their edge, got {}",
                                         shortest(tool.wedge_deg)));
  if (std::isinf(rounded_peak_mm(edge_covers(corner.normals, spines_of(corner, tool)), 0.0)))
    refuse("tool.wedge_deg", fmt::format("is too small: with the given tool.nose_angle_deg and tool.clearance_deg, the "
                                         "cuts of the three facets leave a peak between them, got {}",
                                         shortest(tool.wedge_deg)));
  constexpr double kMaxRadiusFraction = 0.1;
  const double aperture_mm = geometry::bounding_box(geometry::element_cell(element).outline).upper.x() * 2.0;
  if (1e-3 * tool.edge_radius_um > kMaxRadiusFraction * aperture_mm)
    refuse("tool.edge_radius_um",
           fmt::format("must be <= {}, one tenth of the element's aperture, because otherwise the element is too small "
                       "for the nose of the tool, got {}",
                       fixed_apart(1e3 * kMaxRadiusFraction * aperture_mm, tool.edge_radius_um, 3),
                       shortest(tool.edge_radius_um)));
  // While the tip is in the apex, the ends of the cutting edges must be above the face of the blank.
  const double least_mm = std::numbers::sqrt2 * edge_mm * std::tan(rad(0.5 * tool.nose_angle_deg));
  if (tool.width_mm < least_mm)
    refuse("tool.width_mm", fmt::format("must be >= {} for the cutting edges to reach from the apex to the blank's "
                                        "face, got {}",
                                        fixed(std::ceil(least_mm * 1e6) * 1e-6, 6), shortest(tool.width_mm)));
}

}  // namespace retrace::fabrication
