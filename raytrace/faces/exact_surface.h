#pragma once

// Intersection of rays with the planes and outlines of the back surface in double precision.

#include <optional>
#include <vector>

#include "geometry/part/part.h"
#include "raytrace/faces/surface_ray.h"

namespace retrace::raytrace {

/// The back surface in double precision: its planes and outlines. Finds hits by itself in time linear in the cells near
/// the ray; BackSurface knows which cells those are.
class ExactSurface {
 public:
  using Facet = geometry::PatchFacet;

  /// Consecutive facets of a patch.
  struct FacetRange {
    std::uint32_t first = 0;
    std::uint32_t count = 0;
  };

  /// \param part must outlive this
  /// \param centre_mm point of the plane that becomes the origin of rays
  ExactSurface(const geometry::Part& part, const Vec2& centre_mm);
  ExactSurface(geometry::Part&&, const Vec2&) = delete;

  const Facet& facet(FacetRef ref) const { return part_->patches[placements_[ref.placement].patch].facets[ref.facet]; }

  /// The first facet that the ray meets from its own side: one that it leaves the part through if inside, enters
  /// through if outside. Nothing beyond `t_max`.
  std::optional<SurfaceHit> first_hit(const SurfaceRay& ray) const;

  /// Takes into `best` what the ray meets of some facets of a placement before that, whatever the order of searches; a
  /// t just below 0 is kept as it is. \param tolerance_mm how much larger facets are taken than they are
  void search(const SurfaceRay& ray, std::uint32_t placement, const FacetRange& range, double tolerance_mm,
              SurfaceHit& best) const;

  /// What searches have found, if anything.
  static std::optional<SurfaceHit> settled(SurfaceHit best);

  /// Moved to their places as rays see them.
  const std::vector<geometry::Placement>& placements() const { return placements_; }

  /// Rounding of doubles at large coordinates stays below the first; what it may leave open where pieces of the surface
  /// meet stays below the second.
  double tolerance_mm() const;
  double wide_tolerance_mm() const;

 private:
  struct Box {
    Vec3 lower;
    Vec3 upper;
  };

  const geometry::Part* part_;
  std::vector<Box> boxes_;  ///< by patch
  std::vector<geometry::Placement> placements_;
};

}  // namespace retrace::raytrace
