#pragma once

#include <memory>
#include <optional>

#include "geometry/part.h"
#include "raytrace/exact_surface.h"
#include "raytrace/surface_ray.h"

namespace retrace::raytrace {

/// The part's back surface, ready for rays. Embree says which facet a ray meets; the plane in double precision says
/// where. Where single precision might name the wrong one - near edges, or when what it names does not fit the ray -
/// the answer comes from double precision alone. Safe to use from many threads.
class BackSurface {
 public:
  /// \param centre_mm point of the plane that becomes the origin of rays: keeps single-precision coordinates small
  BackSurface(const geometry::Part& part, const Vec2& centre_mm);
  ~BackSurface();
  BackSurface(BackSurface&&) noexcept;
  BackSurface& operator=(BackSurface&&) noexcept;

  /// The first facet that the ray meets from its own side, or nothing up to `t_max`.
  std::optional<SurfaceHit> first_hit(const SurfaceRay& ray) const;

  /// The same in double precision alone.
  std::optional<SurfaceHit> exact_first_hit(const SurfaceRay& ray) const;

  /// For a ray that must meet the surface: exactly if it does, else with facets slightly widened.
  std::optional<SurfaceHit> certain_first_hit(const SurfaceRay& ray) const;

  const ExactSurface::Facet& facet(FacetRef ref) const { return exact_.facet(ref); }

 private:
  struct Embree;
  std::optional<SurfaceHit> marked(std::optional<SurfaceHit> hit, const SurfaceRay& ray) const;
  bool is_near_edge(FacetRef facet, const Vec3& point, const Vec3& direction) const;

  ExactSurface exact_;
  std::unique_ptr<Embree> embree_;
  double edge_band_mm_ = 0.0;
};

}  // namespace retrace::raytrace
