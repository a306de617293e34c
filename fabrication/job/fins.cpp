#include "fabrication/job/fins.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>

#include "core/number_format.h"
#include "fabrication/job/v_tool.h"

namespace retrace::fabrication {

using geometry::Vec3;

namespace {

/// Boundary plane of the material that one cut leaves at a dihedral edge. Let h be the height of a point above the
/// facet that is cut, and g its height above the other facet at this edge. The cut leaves the points with h > `ratio` *
/// g.
struct CutBoundary {
  double ratio = 0.0;
  double shift_mm = 0.0;  ///< maximum displacement of the boundary, measured in h, due to rounded positions
};

CutBoundary boundary_of(Angle reach, Angle between, double step_mm) {
  const double rest_rad = between.rad() - reach.rad();
  if (rest_rad <= 0.0) return {std::numeric_limits<double>::infinity(), 0.0};
  CutBoundary boundary;
  boundary.ratio = std::sin(reach.rad()) / std::sin(rest_rad);
  boundary.shift_mm = rounded_across_mm(step_mm) * std::abs(1.0 + boundary.ratio * std::cos(between.rad())) +
                      rounded_along_mm(step_mm) * boundary.ratio * std::sin(between.rad());
  return boundary;
}

/// Returns the maximum height of the peak between three boundaries, one for each dihedral edge. Boundary k relates the
/// height above facet k to the height above the facet of boundary k + 1. The three relations form a cycle.
double peak_mm(const std::array<CutBoundary, 3>& boundaries) {
  const double product = boundaries[0].ratio * boundaries[1].ratio * boundaries[2].ratio;
  if (std::isinf(product)) return 0.0;
  if (product <= 1.0) return std::numeric_limits<double>::infinity();
  double highest_mm = 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    const CutBoundary& own = boundaries[k];
    const CutBoundary& next = boundaries[(k + 1) % 3];
    const CutBoundary& last = boundaries[(k + 2) % 3];
    highest_mm = std::max(highest_mm, own.shift_mm + own.ratio * (next.shift_mm + next.ratio * last.shift_mm));
  }
  return highest_mm / (product - 1.0);
}

}  // namespace

double rounded_along_mm(double step_mm) {
  // A position is the sum of a start point and a relative move. The rounding error of each of these two vectors is at
  // most the space diagonal of a cube with the side of one increment.
  return 2.0 * std::numbers::sqrt3 * step_mm;
}

double rounded_across_mm(double step_mm) {
  // A position is the sum of a start point and a relative move. Along the facet's normal, the rounding error of each of
  // these two vectors is at most half an increment.
  return step_mm;
}

std::array<EdgeCover, 3> edge_covers(const std::array<Vec3, 3>& normals, const std::array<Vec3, 3>& spines) {
  std::array<EdgeCover, 3> covers;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t next = (k + 1) % 3;
    const Vec3 edge = normals[k].cross(normals[next]).normalized();
    // Unit vectors in the two facets, perpendicular to the edge and away from it.
    const Vec3 along_first = edge.cross(normals[k]);
    const Vec3 along_second = normals[next].cross(edge);
    const auto reach = [&](std::size_t facet, const Vec3& along) {
      return Angle::from_rad(std::atan2(spines[facet].dot(normals[facet]), spines[facet].dot(along)));
    };
    covers[k] = {reach(k, along_first), reach(next, along_second),
                 Angle::from_rad(std::acos(along_first.dot(along_second)))};
  }
  return covers;
}

std::array<Vec3, 3> spines_of(const CubeCorner& corner, const Tool& tool, const std::array<Angle, 3>& root_tilts) {
  const Vec3 spine = v_tool_edges(tool).spine;
  std::array<Vec3, 3> spines;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3& normal = corner.normals[k];
    const Vec3 up = (Vec3::UnitZ() - normal.z() * normal).normalized();
    const Vec3 level = normal.cross(up);
    // v_tool_edges() uses coordinates along the two dihedral edges and the normal of a facet. For a facet with angle
    // errors, axes at 45 degrees to its upward direction replace the dihedral edges.
    Eigen::Matrix3d view;
    view << (up - level).normalized(), (up + level).normalized(), normal;
    spines[k] = view * (Eigen::AngleAxisd(-root_tilts[k].rad(), Vec3::UnitZ()) * spine);
  }
  return spines;
}

double rounded_fin_mm(const EdgeCover& cover, double step_mm) {
  const double overlap_rad = cover.first.rad() + cover.second.rad() - cover.between.rad();
  if (overlap_rad <= 0.0) return std::numeric_limits<double>::infinity();
  const double along_mm = rounded_along_mm(step_mm);
  const double across_mm = rounded_across_mm(step_mm);
  const auto height_mm = [&](Angle own, Angle other) {
    const double rest_rad = cover.between.rad() - other.rad();
    const double off_mm = along_mm * (std::sin(other.rad()) + std::abs(std::sin(rest_rad))) +
                          across_mm * (std::abs(std::cos(other.rad())) + std::abs(std::cos(rest_rad)));
    return across_mm + std::sin(own.rad()) * off_mm / std::sin(overlap_rad);
  };
  return std::max(height_mm(cover.first, cover.second), height_mm(cover.second, cover.first));
}

double rounded_peak_mm(const std::array<EdgeCover, 3>& covers, double step_mm) {
  std::array<CutBoundary, 3> firsts;
  std::array<CutBoundary, 3> seconds;
  for (std::size_t k = 0; k < 3; ++k) {
    firsts[k] = boundary_of(covers[k].first, covers[k].between, step_mm);
    // The boundaries of the second cuts form a cycle in the opposite order, from each facet to the preceding facet.
    seconds[2 - k] = boundary_of(covers[k].second, covers[k].between, step_mm);
  }
  return std::max(peak_mm(firsts), peak_mm(seconds));
}

double highest_fin_mm(const std::array<EdgeCover, 3>& covers, double step_mm) {
  double highest_mm = rounded_peak_mm(covers, step_mm);
  for (const EdgeCover& cover : covers) highest_mm = std::max(highest_mm, rounded_fin_mm(cover, step_mm));
  return highest_mm;
}

std::string fin_text(double fin_mm) {
  if (std::isinf(fin_mm)) return "a fin up to the face of the blank";
  return fmt::format("a fin of {} um", fixed(1e3 * fin_mm, 3));
}

double max_fin_mm(double step_mm) {
  return kEdgeStripMm - *std::max_element(std::begin(kEdgeLineSteps), std::end(kEdgeLineSteps)) * step_mm;
}

}  // namespace retrace::fabrication
