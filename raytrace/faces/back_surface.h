#pragma once

// Search for the first facet of the back surface that a ray meets. Embree finds bounding boxes along the ray. The facet
// and the point are computed in double precision.

#include <memory>
#include <optional>

#include "geometry/part/part.h"
#include "raytrace/faces/exact_surface.h"
#include "raytrace/faces/surface_ray.h"

namespace retrace::raytrace {

/// The part's back surface, prepared for ray tracing. Embree finds the bounding boxes that a ray passes. The facets in
/// them are tested in double precision. All member functions are thread-safe.
class BackSurface {
 public:
  /// \param part must outlive this object
  /// \param centre_mm point of the plane z = 0 that becomes the origin of rays; it keeps coordinates small, which
  ///        reduces single-precision errors
  /// \throw std::bad_alloc
  BackSurface(const geometry::Part& part, const Vec2& centre_mm);
  BackSurface(geometry::Part&&, const Vec2&) = delete;
  BackSurface(const BackSurface&) = delete;
  BackSurface& operator=(const BackSurface&) = delete;
  ~BackSurface();

  /// Returns the first facet that the ray meets up to the distance `t_max`. A ray inside the part meets only facets
  /// through which it could leave the part. A ray outside meets only facets through which it could enter.
  std::optional<SurfaceHit> first_hit(const SurfaceRay& ray) const;

  /// Returns the first facet for a ray that must meet the surface. If first_hit() finds no facet, the search is
  /// repeated with slightly enlarged facets, because rounding may leave a gap between two facets.
  std::optional<SurfaceHit> first_hit_with_tolerance(const SurfaceRay& ray) const;

  const ExactSurface::Facet& facet(FacetRef ref) const { return exact_.facet(ref); }
  /// Returns the position of the patch that contains the facet.
  const geometry::Placement& placement(FacetRef ref) const { return exact_.placements()[ref.placement]; }

 private:
  struct Boxes;

  ExactSurface exact_;
  std::unique_ptr<Boxes> boxes_;
};

}  // namespace retrace::raytrace
