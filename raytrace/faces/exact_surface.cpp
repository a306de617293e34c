#include "raytrace/faces/exact_surface.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

namespace retrace::raytrace {
namespace {

using geometry::PatchFacet, geometry::SurfacePatch;

// Tolerances of the searches, as fractions of the element size.
constexpr double kTolerance = 1e-10, kWideTolerance = 1e-6;

Vec3 position_of(const geometry::Placement& placement) {
  return {placement.offset_mm.x(), placement.offset_mm.y(), placement.height_mm};
}

/// Returns true if facet `a` is selected instead of `b` when a ray meets both at the same distance. The result of a
/// search then does not depend on its order.
bool precedes(const FacetRef& a, const FacetRef& b) {
  return b.placement != FacetRef::kNone && std::pair(a.placement, a.facet) < std::pair(b.placement, b.facet);
}

/// Returns true if a point of the facet's plane is in the facet's outline, or outside by at most the tolerance.
bool is_within(const SurfacePatch& patch, const PatchFacet& facet, const Vec3& point, double tolerance_mm) {
  const std::uint32_t* corners = patch.corners.data() + facet.first_corner;
  const Vec3* from = &patch.vertices[corners[facet.corner_count - 1]];
  for (std::uint32_t k = 0; k < facet.corner_count; ++k) {
    const Vec3* to = &patch.vertices[corners[k]];
    const Vec3 along = *to - *from;
    const double inwards = facet.normal.dot(along.cross(point - *from));
    if (inwards < 0.0 && inwards * inwards > tolerance_mm * tolerance_mm * along.squaredNorm()) return false;
    from = to;
  }
  return true;
}

/// Returns true if the ray passes through the box, enlarged by `pad_mm`, at some t from -pad_mm to t_max.
bool meets_box(const Vec3& origin, const Vec3& direction, const Vec3& lower, const Vec3& upper, double pad_mm,
               double t_max) {
  double enter = -pad_mm;
  double leave = t_max;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const double low = lower[axis] - pad_mm - origin[axis];
    const double high = upper[axis] + pad_mm - origin[axis];
    if (direction[axis] == 0.0) {
      if (low > 0.0 || high < 0.0) return false;
      continue;
    }
    const double a = low / direction[axis];
    const double b = high / direction[axis];
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  return enter <= leave;
}

}  // namespace

ExactSurface::ExactSurface(const geometry::Part& part, const Vec2& centre_mm)
    : part_(&part), placements_(part.placements) {
  boxes_.reserve(part.patches.size());
  for (const auto& patch : part.patches) {
    Box& box = boxes_.emplace_back(Box{Vec3::Constant(INFINITY), Vec3::Constant(-INFINITY)});
    for (const auto& cell : patch.cells) {
      box.lower = box.lower.cwiseMin(cell.lower);
      box.upper = box.upper.cwiseMax(cell.upper);
    }
  }
  for (auto& placement : placements_) placement.offset_mm -= centre_mm;
}

double ExactSurface::tolerance_mm() const {
  return kTolerance * part_->size_mm;
}

double ExactSurface::wide_tolerance_mm() const {
  return kWideTolerance * part_->size_mm;
}

std::optional<SurfaceHit> ExactSurface::first_hit(const SurfaceRay& ray) const {
  const double tolerance = tolerance_mm();
  SurfaceHit best;
  best.t = ray.t_max;
  for (std::uint32_t p = 0; p < placements_.size(); ++p) {
    const std::uint32_t patch = placements_[p].patch;
    const Vec3 local = ray.origin - position_of(placements_[p]);
    if (!meets_box(local, ray.direction, boxes_[patch].lower, boxes_[patch].upper, tolerance, best.t)) continue;
    for (const auto& cell : part_->patches[patch].cells)
      if (meets_box(local, ray.direction, cell.lower, cell.upper, tolerance, best.t))
        search(ray, p, {cell.first_facet, cell.facet_count}, tolerance, best);
  }
  return found_hit(best);
}

std::optional<SurfaceHit> ExactSurface::found_hit(SurfaceHit best) {
  if (best.facet.placement == FacetRef::kNone) return std::nullopt;
  best.t = std::max(best.t, 0.0);
  return best;
}

void ExactSurface::search(const SurfaceRay& ray, std::uint32_t placement, const FacetRange& range, double tolerance_mm,
                          SurfaceHit& best) const {
  const SurfacePatch& patch = part_->patches[placements_[placement].patch];
  const Vec3 local = ray.origin - position_of(placements_[placement]);
  for (std::uint32_t f = range.first; f < range.first + range.count; ++f) {
    const PatchFacet& facet = patch.facets[f];
    const double towards = facet.normal.dot(ray.direction);
    if (ray.inside ? towards <= 0.0 : towards >= 0.0) continue;
    if (ray.source == FacetRef{placement, f}) continue;
    const double t = (facet.offset_mm - facet.normal.dot(local)) / towards;
    const FacetRef ref{placement, f};
    if (t < -tolerance_mm || t > best.t || (t == best.t && !precedes(ref, best.facet))) continue;
    if (!is_within(patch, facet, local + t * ray.direction, tolerance_mm)) continue;
    best.facet = ref;
    best.t = t;
  }
}

}  // namespace retrace::raytrace
