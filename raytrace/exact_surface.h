#pragma once

#include <optional>
#include <vector>

#include "geometry/part.h"
#include "raytrace/surface_ray.h"

namespace retrace::raytrace {

/// The back surface in double precision: its planes and outlines. Finds hits by itself (slowly, in time linear in the
/// cells near the ray) where single precision cannot be trusted.
class ExactSurface {
 public:
  struct Edge {
    Vec3 inward = Vec3::Zero();  ///< unit, in the facet's plane
    double offset_mm = 0.0;
  };
  struct Facet {
    Vec3 normal = Vec3::Zero();
    double offset_mm = 0.0;
    std::uint32_t first_edge = 0;
    std::uint32_t edge_count = 0;
    geometry::FacetRole role = geometry::FacetRole::retro_facet;
  };

  /// \param centre_mm point of the plane that becomes the origin of rays
  ExactSurface(const geometry::Part& part, const Vec2& centre_mm);

  const Facet& facet(FacetRef ref) const { return patches_[placements_[ref.placement].patch].facets[ref.facet]; }

  /// Distance along the ray to the facet's plane.
  double distance(FacetRef ref, const Vec3& origin, const Vec3& direction) const;

  /// How far inside its outline a point of the facet's plane lies; negative outside.
  double margin(FacetRef ref, const Vec3& point) const;

  /// The first facet that the ray meets from its own side: one that it leaves the part through if inside, enters
  /// through if outside. Nothing beyond `t_max`.
  std::optional<SurfaceHit> first_hit(const SurfaceRay& ray) const;

  /// The same with facets a little larger than they are: for a ray that cannot have missed the surface but did, through
  /// what rounding left open between two pieces of it.
  std::optional<SurfaceHit> first_hit_of_widened(const SurfaceRay& ray) const;

  const std::vector<geometry::Placement>& placements() const { return placements_; }

 private:
  struct Patch {
    std::vector<Facet> facets;
    std::vector<Edge> edges;
    std::vector<geometry::PatchCell> cells;
    Vec3 lower = Vec3::Zero();
    Vec3 upper = Vec3::Zero();
  };

  static Patch compile(const geometry::SurfacePatch& source);
  double local_margin(const Patch& patch, const Facet& facet, const Vec3& local) const;
  std::optional<SurfaceHit> first_within(const SurfaceRay& ray, double tolerance_mm) const;
  void search_cell(const SurfaceRay& ray, std::uint32_t placement, const geometry::PatchCell& cell, double tolerance_mm,
                   SurfaceHit& best) const;

  std::vector<Patch> patches_;
  std::vector<geometry::Placement> placements_;
  double size_mm_ = 0.0;
};

}  // namespace retrace::raytrace
