#pragma once

// The light that rough facets scatter out of beams, followed as rays.

#include <cstdint>
#include <memory>
#include <vector>

#include "raytrace/exact/beam_tracer.h"
#include "raytrace/exact/scattered_light.h"
#include "raytrace/paths/path_tracer.h"

namespace retrace::raytrace {

class WayToSource;

/// Starts rays for the light that rough facets scatter out of beams. A ray starts at a random point of the beam's
/// polygon on the facet, in a random direction of the scattering lobe, and is traced like a Monte Carlo ray. It never
/// becomes a beam again, so that no light is counted twice.
/// Cones much narrower than the lobe receive few random rays. If the light is diffracted one time and then only
/// reflected on its path to the source, it is therefore scored by expected value: an additional ray starts in a
/// direction that leads into the cone, with the power of the lobe in this direction (docs/theory/beams.md). For one
/// replicate and one thread.
class ScatteredRays : public ScatteredReplicate {
 public:
  /// \param setup outlives this \param key of the random numbers of this replicate and round
  ScatteredRays(const PathSetup& setup, RandomKey key, std::uint32_t replicate, std::uint32_t round,
                const Cancellation* cancel = nullptr);

  /// Rays for all that these sites scatter, each for at most `most_power` of it: the sites get them in proportion to
  /// what they scatter, by systematic sampling. Stops half way if it was cancelled.
  void launch(const std::vector<ScatterSite>& sites, double most_power) override;

  const Tally& tally() const override { return tally_; }

 private:
  void launch_one(const ScatterSite& site, double power);
  void follow_scored(const Vec3& position, const Ray& ray, std::uint32_t number, std::uint32_t& choices);
  void score(const WayToSource& way, const Vec3& position, const Vec3& normal, const Ray& met, double power,
             std::uint32_t number, std::uint32_t& choices);

  const PathSetup& setup_;
  RandomKey key_;
  std::uint32_t replicate_;
  std::uint32_t number_;
  const Cancellation* cancel_;
  Tally tally_;
  PathWalker walker_;
  Tally apart_;  ///< tally of one ray at a time; see follow_scored()
  PathWalker walker_apart_;
};

/// Follows scattered light as rays: ScatteredRays of each replicate.
class ScatteredLightByRays : public ScatteredLight {
 public:
  /// \param surface of `tracer`'s part; both outlive this
  ScatteredLightByRays(const BeamTracer& tracer, const BackSurface& surface, const Optics& optics,
                       const Illumination& illumination, const std::vector<double>& cones_deg);

  std::unique_ptr<ScatteredReplicate> replicate(RandomKey key, std::uint32_t number, std::uint32_t round,
                                                const Cancellation* cancel) const override;

 private:
  PathSetup setup_;
};

/// A point of a convex polygon: uniform over its area for `u` uniform in the unit square.
Vec3 point_of(const Corners& corners, const Vec2& u);

}  // namespace retrace::raytrace
