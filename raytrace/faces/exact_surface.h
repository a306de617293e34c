#pragma once

// Intersection of rays with the planes and outlines of the back surface in double precision.

#include <optional>
#include <vector>

#include "geometry/part/part.h"
#include "raytrace/faces/surface_ray.h"

namespace retrace::raytrace {

/// The planes and outlines of the back surface in double precision. first_hit() tests the boxes of all patches.
/// BackSurface is faster, because it finds the boxes near a ray with Embree.
class ExactSurface {
 public:
  using Facet = geometry::PatchFacet;

  /// Consecutive facets of a patch.
  struct FacetRange {
    std::uint32_t first = 0;
    std::uint32_t count = 0;
  };

  /// \param part must outlive this object
  /// \param centre_mm point of the plane z = 0 that becomes the origin of rays
  ExactSurface(const geometry::Part& part, const Vec2& centre_mm);
  ExactSurface(geometry::Part&&, const Vec2&) = delete;

  const Facet& facet(FacetRef ref) const { return part_->patches[placements_[ref.placement].patch].facets[ref.facet]; }

  /// Returns the first facet that the ray meets up to the distance `t_max`. A ray inside the part meets only facets
  /// through which it could leave the part. A ray outside meets only facets through which it could enter.
  std::optional<SurfaceHit> first_hit(const SurfaceRay& ray) const;

  /// Replaces `best` if the ray meets a facet of `range` at a smaller distance than `best`. The result does not depend
  /// on the order of searches. Distances slightly below 0, which rounding may cause, are preserved.
  /// \param tolerance_mm distance by which facets are enlarged
  void search(const SurfaceRay& ray, std::uint32_t placement, const FacetRange& range, double tolerance_mm,
              SurfaceHit& best) const;

  /// Returns the hit found by calls of search(), or nothing if they have found none. A distance below 0 becomes 0.
  static std::optional<SurfaceHit> found_hit(SurfaceHit best);

  /// Returns the placements of the patches, relative to the origin of rays.
  const std::vector<geometry::Placement>& placements() const { return placements_; }

  /// Returns an upper bound of the rounding errors of coordinates. wide_tolerance_mm() returns an upper bound of the
  /// gaps that rounding may cause between adjacent facets.
  double tolerance_mm() const;
  double wide_tolerance_mm() const;

 private:
  struct Box {
    Vec3 lower;
    Vec3 upper;
  };

  const geometry::Part* part_;
  std::vector<Box> boxes_;  ///< indexed by patch
  std::vector<geometry::Placement> placements_;
};

}  // namespace retrace::raytrace
