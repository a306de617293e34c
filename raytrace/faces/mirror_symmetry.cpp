#include "raytrace/faces/mirror_symmetry.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "core/memory_budget.h"
#include "geometry/centroid.h"
#include "geometry/point_lookup.h"

namespace retrace::raytrace {
namespace {

using geometry::Part, geometry::PatchCell, geometry::PatchFacet, geometry::Placement, geometry::SurfacePatch;
using geometry::Vec2, geometry::Vec3;

// Tolerances. Two positions are equal if their distance is less than kSamePlace times the element size. Two normals are
// equal if the norm of their difference is at most kSameNormal.
constexpr double kSamePlace = 1e-8;
constexpr double kSameNormal = 1e-9;
// Memory in bytes per facet of FacetsByPlace.
constexpr double kBytesPerFacet = 350.0;

/// Returns true if a FacetsByPlace of all facets of the part fits into the memory budget.
bool fits_memory(const Part& part) {
  double facets = 0.0;
  for (const Placement& placement : part.placements)
    facets += static_cast<double>(part.patches[placement.patch].facets.size());
  return kBytesPerFacet * facets <= static_cast<double>(element_memory_bytes());
}

/// A facet at its position in the part.
struct PlacedFacet {
  std::vector<Vec3> corners;
  Vec3 middle = Vec3::Zero();  ///< centroid of the corners
  Vec3 normal = Vec3::UnitZ();
  geometry::FacetRole role = geometry::FacetRole::retro_facet;
};

PlacedFacet standing(const SurfacePatch& patch, const PatchFacet& facet, const Vec3& shift) {
  PlacedFacet result{{}, Vec3::Zero(), facet.normal, facet.role};
  for (std::uint32_t c = 0; c < facet.corner_count; ++c)
    result.corners.push_back(patch.vertices[patch.corners[facet.first_corner + c]] + shift);
  result.middle = geometry::centroid(std::span<const Vec3>(result.corners));
  return result;
}

PlacedFacet mirror_image(PlacedFacet facet, Eigen::Index axis, double about_mm) {
  const auto mirror = [&](Vec3& p) { p[axis] = 2.0 * about_mm - p[axis]; };
  for (Vec3& corner : facet.corners) mirror(corner);
  mirror(facet.middle);
  facet.normal[axis] = -facet.normal[axis];
  return facet;
}

/// All facets of a part. A facet can be looked up by its centroid.
class FacetsByPlace {
 public:
  explicit FacetsByPlace(const Part& part) : near_mm_(kSamePlace * part.size_mm), by_middle_(near_mm_) {
    for (const Placement& placement : part.placements) {
      const SurfacePatch& patch = part.patches[placement.patch];
      const Vec3 shift(placement.offset_mm.x(), placement.offset_mm.y(), placement.height_mm);
      for (const PatchFacet& facet : patch.facets) {
        facets_.push_back(standing(patch, facet, shift));
        by_middle_.insert(facets_.back().middle, facets_.size() - 1);
      }
    }
  }

  const std::vector<PlacedFacet>& all() const { return facets_; }

  bool has(const PlacedFacet& facet) const {
    bool found = false;
    by_middle_.visit(facet.middle, [&](std::size_t k) { found = found || is_same(facets_[k], facet); });
    return found;
  }

 private:
  bool is_same(const PlacedFacet& a, const PlacedFacet& b) const {
    const auto is_corner_of_a = [&](const Vec3& p) {
      return std::any_of(a.corners.begin(), a.corners.end(),
                         [&](const Vec3& q) { return (p - q).squaredNorm() <= near_mm_ * near_mm_; });
    };
    return a.role == b.role && a.corners.size() == b.corners.size() && (a.normal - b.normal).norm() <= kSameNormal &&
           std::all_of(b.corners.begin(), b.corners.end(), is_corner_of_a);
  }

  double near_mm_;
  std::vector<PlacedFacet> facets_;
  geometry::PointLookup<std::size_t> by_middle_;
};

/// Returns the facets of the central period of an infinite part. The patch of such a part contains several periods,
/// stored row by row.
std::vector<PlacedFacet> central_facets(const Part& part) {
  const SurfacePatch& patch = part.patches.front();
  const auto side = static_cast<std::size_t>(2 * part.periods_beyond + 1);
  const std::size_t each = patch.cells.size() / (side * side);
  const std::size_t first = (side * side / 2) * each;
  const Vec2& offset = part.placements.front().offset_mm;
  std::vector<PlacedFacet> facets;
  for (std::size_t k = first; k < first + each; ++k) {
    const PatchCell& cell = patch.cells[k];
    for (std::uint32_t f = cell.first_facet; f < cell.first_facet + cell.facet_count; ++f)
      facets.push_back(standing(patch, patch.facets[f], {offset.x(), offset.y(), 0.0}));
  }
  return facets;
}

bool holds(const FacetsByPlace& part, const std::vector<PlacedFacet>& facets, Eigen::Index axis, double about_mm) {
  return std::all_of(facets.begin(), facets.end(),
                     [&](const PlacedFacet& f) { return part.has(mirror_image(f, axis, about_mm)); });
}

/// Returns true if an infinite part is symmetric about a plane normal to `axis`. The tested planes map the first facet
/// of the central period to a facet that is at most one period away.
bool endless_is_mirrored(const Part& part, Eigen::Index axis) {
  const FacetsByPlace all(part);
  const std::vector<PlacedFacet> central = central_facets(part);
  const PlacedFacet& first = central.front();
  for (const PlacedFacet& other : all.all()) {
    const double about_mm = 0.5 * (first.middle[axis] + other.middle[axis]);
    const bool is_near = std::abs(other.middle[axis] - first.middle[axis]) <= (*part.period_mm)[axis];
    const Vec3 image = mirror_image(first, axis, about_mm).middle;
    if (is_near && (image - other.middle).norm() <= kSamePlace * part.size_mm && holds(all, central, axis, about_mm))
      return true;
  }
  return false;
}

/// Returns true if each corner of an outline has a mirror image among the corners.
bool is_mirrored(const geometry::Polygon& outline, Eigen::Index axis, double about_mm, double near_mm) {
  return std::all_of(outline.begin(), outline.end(), [&](Vec2 p) {
    p[axis] = 2.0 * about_mm - p[axis];
    return std::any_of(outline.begin(), outline.end(), [&](const Vec2& q) { return (p - q).norm() <= near_mm; });
  });
}

}  // namespace

bool is_mirror_symmetric(const Part& part, Eigen::Index axis) {
  if (!fits_memory(part)) return false;
  if (part.period_mm) return endless_is_mirrored(part, axis);
  const double about_mm = geometry::bounding_box(part.outline).centre()[axis];
  if (!is_mirrored(part.outline, axis, about_mm, kSamePlace * part.size_mm)) return false;
  const FacetsByPlace all(part);
  return holds(all, all.all(), axis, about_mm);
}

}  // namespace retrace::raytrace
