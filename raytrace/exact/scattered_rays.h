#pragma once

// Ray tracing of the light that rough facets scatter out of beams.

#include <cstdint>
#include <memory>
#include <vector>

#include "raytrace/exact/beam_tracer.h"
#include "raytrace/exact/scattered_light.h"
#include "raytrace/paths/path_tracer.h"

namespace retrace::raytrace {

class PathToSource;

/// Starts rays for the light that rough facets scatter out of beams. Each ray starts at a random point of the beam's
/// polygon on the facet, in a random direction of the scattering lobe. It is traced like a Monte Carlo ray and never
/// becomes a beam again, so that no light is counted twice.
///
/// Few random rays reach a cone that is much narrower than the lobe. Next-event estimation is therefore used for light
/// that is diffracted one time and then only reflected on its path to the source. An additional ray starts in a
/// direction that leads into the cone, with the power of the lobe in this direction (docs/theory/beams.md).
/// An object serves one replicate and one thread.
class ScatteredRays : public ScatteredReplicate {
 public:
  /// \param setup must outlive this object
  /// \param key key of the random numbers of this replicate and round
  ScatteredRays(const PathSetup& setup, RandomKey key, std::uint32_t replicate, std::uint32_t round,
                const Cancellation* cancel = nullptr);

  /// Traces rays for all light that the sites scatter. Each ray has at most the power `max_power`. The rays are
  /// distributed over the sites in proportion to the scattered power, by systematic sampling. Stops early if cancelled.
  void launch(const std::vector<ScatterSite>& sites, double max_power) override;

  const Tally& tally() const override { return tally_; }

 private:
  void launch_one(const ScatterSite& site, double power);
  void follow_scored(const Vec3& position, const Ray& ray, std::uint32_t number, std::uint32_t& choices);
  void score(const PathToSource& path, const Vec3& position, const Vec3& normal, const Ray& met, double power,
             std::uint32_t number, std::uint32_t& choices);

  const PathSetup& setup_;
  RandomKey key_;
  std::uint32_t replicate_;
  std::uint32_t number_;
  const Cancellation* cancel_;
  Tally tally_;
  PathWalker walker_;
  Tally single_ray_tally_;  ///< tally of a single ray; see follow_scored()
  PathWalker single_ray_walker_;
};

/// Traces scattered light as rays. Each replicate has its own ScatteredRays.
class ScatteredLightByRays : public ScatteredLight {
 public:
  /// \param surface back surface of the part of `tracer`; both must outlive this object
  ScatteredLightByRays(const BeamTracer& tracer, const BackSurface& surface, const Optics& optics,
                       const Illumination& illumination, const std::vector<double>& cones_deg);

  std::unique_ptr<ScatteredReplicate> replicate(RandomKey key, std::uint32_t number, std::uint32_t round,
                                                const Cancellation* cancel) const override;

 private:
  PathSetup setup_;
};

/// Returns a point of a convex polygon. The point is uniformly distributed if `u` is uniform in the unit square.
Vec3 point_of(const Corners& corners, const Vec2& u);

}  // namespace retrace::raytrace
