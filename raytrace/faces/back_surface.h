#pragma once

// The search for the facet of the back that a ray meets: Embree finds the boxes, double precision decides.

#include <memory>
#include <optional>

#include "geometry/part/part.h"
#include "raytrace/faces/exact_surface.h"
#include "raytrace/faces/surface_ray.h"

namespace retrace::raytrace {

/// The part's back surface, ready for rays. Embree says which cells a ray passes; which of their facets it meets, and
/// where, is found in double precision. Safe to use from many threads.
class BackSurface {
 public:
  /// \param part must outlive this
  /// \param centre_mm point of the plane that becomes the origin of rays: keeps single-precision coordinates small
  /// \throw std::bad_alloc
  BackSurface(const geometry::Part& part, const Vec2& centre_mm);
  BackSurface(geometry::Part&&, const Vec2&) = delete;
  BackSurface(const BackSurface&) = delete;
  BackSurface& operator=(const BackSurface&) = delete;
  ~BackSurface();

  /// The first facet that the ray meets from its own side, or nothing up to `t_max`.
  std::optional<SurfaceHit> first_hit(const SurfaceRay& ray) const;

  /// For a ray that must meet the surface: as first_hit if that finds any, else with facets slightly widened, as
  /// rounding may have left a gap between two of them.
  std::optional<SurfaceHit> certain_first_hit(const SurfaceRay& ray) const;

  const ExactSurface::Facet& facet(FacetRef ref) const { return exact_.facet(ref); }
  /// Where it stands.
  const geometry::Placement& placement(FacetRef ref) const { return exact_.placements()[ref.placement]; }

 private:
  struct Boxes;

  ExactSurface exact_;
  std::unique_ptr<Boxes> boxes_;
};

}  // namespace retrace::raytrace
