#include "raytrace/exact_surface.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace retrace::raytrace {
namespace {

// Relative to the element's size: rounding of doubles at large coordinates stays below the first; what it may leave
// open where pieces of the surface meet stays below the second.
constexpr double kTolerance = 1e-10;
constexpr double kWideTolerance = 1e-6;

Vec3 place_of(const geometry::Placement& placement) {
  return {placement.offset_mm.x(), placement.offset_mm.y(), placement.height_mm};
}

/// True if the ray passes the box, widened by `pad_mm`, somewhere in -pad..t_max.
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
    : placements_(part.placements), size_mm_(part.size_mm) {
  patches_.reserve(part.patches.size());
  for (const auto& patch : part.patches) patches_.push_back(compile(patch));
  for (auto& placement : placements_) placement.offset_mm -= centre_mm;
}

ExactSurface::Patch ExactSurface::compile(const geometry::SurfacePatch& source) {
  Patch patch;
  patch.cells = source.cells;
  patch.lower.setConstant(INFINITY);
  patch.upper.setConstant(-INFINITY);
  for (const auto& cell : source.cells) {
    patch.lower = patch.lower.cwiseMin(cell.lower);
    patch.upper = patch.upper.cwiseMax(cell.upper);
  }
  for (const auto& f : source.facets) {
    Facet facet{f.normal, f.offset_mm, static_cast<std::uint32_t>(patch.edges.size()), f.corner_count, f.role};
    for (std::uint32_t k = 0; k < f.corner_count; ++k) {
      const Vec3& a = source.vertices[source.corners[f.first_corner + k]];
      const Vec3& b = source.vertices[source.corners[f.first_corner + (k + 1) % f.corner_count]];
      const Vec3 inward = f.normal.cross(b - a).normalized();
      patch.edges.push_back({inward, inward.dot(a)});
    }
    patch.facets.push_back(facet);
  }
  return patch;
}

double ExactSurface::distance(FacetRef ref, const Vec3& origin, const Vec3& direction) const {
  const Facet& f = facet(ref);
  const Vec3 local = origin - place_of(placements_[ref.placement]);
  return (f.offset_mm - f.normal.dot(local)) / f.normal.dot(direction);
}

double ExactSurface::margin(FacetRef ref, const Vec3& point) const {
  const geometry::Placement& placement = placements_[ref.placement];
  const Patch& patch = patches_[placement.patch];
  return local_margin(patch, patch.facets[ref.facet], point - place_of(placement));
}

double ExactSurface::local_margin(const Patch& patch, const Facet& facet, const Vec3& local) const {
  double least = INFINITY;
  for (std::uint32_t e = facet.first_edge; e < facet.first_edge + facet.edge_count; ++e)
    least = std::min(least, patch.edges[e].inward.dot(local) - patch.edges[e].offset_mm);
  return least;
}

std::optional<SurfaceHit> ExactSurface::first_hit(const SurfaceRay& ray) const {
  return first_within(ray, kTolerance * size_mm_);
}

std::optional<SurfaceHit> ExactSurface::first_hit_of_widened(const SurfaceRay& ray) const {
  return first_within(ray, kWideTolerance * size_mm_);
}

std::optional<SurfaceHit> ExactSurface::first_within(const SurfaceRay& ray, double tolerance_mm) const {
  SurfaceHit best;
  best.t = ray.t_max;
  for (std::uint32_t p = 0; p < placements_.size(); ++p) {
    const Patch& patch = patches_[placements_[p].patch];
    const Vec3 local = ray.origin - place_of(placements_[p]);
    if (!meets_box(local, ray.direction, patch.lower, patch.upper, tolerance_mm, best.t)) continue;
    for (const auto& cell : patch.cells)
      if (meets_box(local, ray.direction, cell.lower, cell.upper, tolerance_mm, best.t))
        search_cell(ray, p, cell, tolerance_mm, best);
  }
  if (best.facet.placement == FacetRef::kNone) return std::nullopt;
  return best;
}

void ExactSurface::search_cell(const SurfaceRay& ray, std::uint32_t placement, const geometry::PatchCell& cell,
                               double tolerance_mm, SurfaceHit& best) const {
  const Patch& patch = patches_[placements_[placement].patch];
  const Vec3 local = ray.origin - place_of(placements_[placement]);
  for (std::uint32_t f = cell.first_facet; f < cell.first_facet + cell.facet_count; ++f) {
    const Facet& facet = patch.facets[f];
    const double towards = facet.normal.dot(ray.direction);
    if (ray.inside ? towards <= 0.0 : towards >= 0.0) continue;
    if (ray.source == FacetRef{placement, f}) continue;
    const double t = (facet.offset_mm - facet.normal.dot(local)) / towards;
    if (t < -tolerance_mm || t >= best.t) continue;
    if (local_margin(patch, facet, local + t * ray.direction) < -tolerance_mm) continue;
    best.facet = {placement, f};
    best.t = std::max(t, 0.0);
  }
}

}  // namespace retrace::raytrace
