#include "raytrace/faces/facet_boxes.h"

#include <algorithm>
#include <cmath>

namespace retrace::raytrace {
namespace {

// Maximum number of facets of a cell that has one box for all facets. In larger cells, each facet has a box.
constexpr std::uint32_t kFewFacets = 16;
// Maximum number of boxes per facet.
constexpr double kMaxBoxes = 8.0;
// A facet has a single box if the cosine of the angle between its longest direction and the nearest coordinate axis is
// greater than this value. This box then contains little empty space.
constexpr double kAlongAnAxis = 0.98;

std::vector<Vec3> corners_of(const geometry::SurfacePatch& patch, const geometry::PatchFacet& facet) {
  std::vector<Vec3> corners;
  corners.reserve(facet.corner_count);
  for (std::uint32_t c = 0; c < facet.corner_count; ++c)
    corners.push_back(patch.vertices[patch.corners[facet.first_corner + c]]);
  return corners;
}

/// Returns the vector from the first corner to the most distant corner.
Vec3 length_of(const std::vector<Vec3>& corners) {
  return *std::max_element(corners.begin(), corners.end(), [&](const Vec3& a, const Vec3& b) {
    return (a - corners.front()).squaredNorm() < (b - corners.front()).squaredNorm();
  }) - corners.front();
}

/// Returns the number of boxes of a facet. A single box of a long oblique facet would be mostly empty. The facet is
/// therefore divided into parts that are about as long as wide.
std::uint16_t pieces_of(const std::vector<Vec3>& corners) {
  const Vec3 along = length_of(corners).normalized();
  if (along.cwiseAbs().maxCoeff() > kAlongAnAxis) return 1;
  double length = 0.0;
  double width = 0.0;
  for (const Vec3& p : corners) {
    const Vec3 from = p - corners.front();
    length = std::max(length, from.norm());
    width = std::max(width, (from - from.dot(along) * along).norm());
  }
  if (!(length > 0.0)) return 1;
  return static_cast<std::uint16_t>(std::clamp(length / std::max(width, length / kMaxBoxes), 1.0, kMaxBoxes));
}

/// Returns the part of a polygon where along . p >= level.
std::vector<Vec3> beyond(const std::vector<Vec3>& polygon, const Vec3& along, double level) {
  std::vector<Vec3> left;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vec3& p = polygon[k];
    const Vec3& q = polygon[(k + 1) % polygon.size()];
    const double dp = along.dot(p) - level;
    const double dq = along.dot(q) - level;
    if (dp >= 0.0) left.push_back(p);
    if ((dp > 0.0 && dq < 0.0) || (dp < 0.0 && dq > 0.0)) left.push_back(p + dp / (dp - dq) * (q - p));
  }
  return left;
}

std::vector<Vec3> piece_of(std::vector<Vec3> corners, const BoxContent& content) {
  if (content.parts == 1) return corners;
  const Vec3 along = length_of(corners);
  double low = INFINITY;
  double high = -INFINITY;
  for (const Vec3& p : corners) {
    low = std::min(low, along.dot(p));
    high = std::max(high, along.dot(p));
  }
  const double step = (high - low) / content.parts;
  if (content.part > 0) corners = beyond(corners, along, low + content.part * step);
  if (content.part + 1 < content.parts) corners = beyond(corners, -along, -(low + (content.part + 1) * step));
  return corners;
}

}  // namespace

std::vector<BoxContent> box_contents(const geometry::SurfacePatch& patch) {
  std::vector<BoxContent> contents;
  contents.reserve(patch.cells.size());
  for (const auto& cell : patch.cells) {
    if (cell.facet_count <= kFewFacets) {
      contents.push_back({{cell.first_facet, cell.facet_count}, 0, 1});
      continue;
    }
    for (std::uint32_t f = cell.first_facet; f < cell.first_facet + cell.facet_count; ++f) {
      const std::uint16_t pieces = pieces_of(corners_of(patch, patch.facets[f]));
      for (std::uint16_t k = 0; k < pieces; ++k) contents.push_back({{f, 1}, k, pieces});
    }
  }
  return contents;
}

FacetBox bounding_box_of(const geometry::SurfacePatch& patch, const BoxContent& content) {
  FacetBox box{Vec3::Constant(INFINITY), Vec3::Constant(-INFINITY)};
  for (std::uint32_t f = content.range.first; f < content.range.first + content.range.count; ++f)
    for (const Vec3& p : piece_of(corners_of(patch, patch.facets[f]), content)) {
      box.lower = box.lower.cwiseMin(p);
      box.upper = box.upper.cwiseMax(p);
    }
  return box;
}

}  // namespace retrace::raytrace
