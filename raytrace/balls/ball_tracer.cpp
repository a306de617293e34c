#include "raytrace/balls/ball_tracer.h"

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <numbers>

#include "raytrace/balls/ball_walker.h"
#include "raytrace/sampling/flush_denormals.h"
#include "raytrace/sampling/replicates.h"
#include "raytrace/sampling/sobol.h"

namespace retrace::raytrace {
namespace {

/// Maps random numbers in the unit square to points where rays of the beam start.
class BallEntry {
 public:
  BallEntry(const BallLayer& layer, const Vec3& to_source) : layer_(layer), lattice_(layer), to_source_(to_source) {
    across_ = source_axis(to_source);
    up_ = to_source.cross(across_);
  }

  Vec3 operator()(const std::array<double, 2>& u) const {
    if (layer_.pitch_mm) {
      const Vec2 place = lattice_.period_mm().cwiseProduct(Vec2(u[0], u[1]));
      return {place.x(), place.y(), layer_.radius_mm()};
    }
    const double away = layer_.radius_mm() * std::sqrt(u[0]);
    const double turn = 2.0 * std::numbers::pi * u[1];
    return away * (std::cos(turn) * across_ + std::sin(turn) * up_) + 2.0 * layer_.radius_mm() * to_source_;
  }

 private:
  const BallLayer& layer_;
  BallLattice lattice_;
  Vec3 to_source_;
  Vec3 across_;
  Vec3 up_;
};

/// Returns the incident light for tracing. Its s axis is the first axis of `stokes`, source_axis(). Its p axis,
/// direction x s, is opposite to the second axis of `stokes`. The sign of the Stokes parameter U is therefore reversed.
Light incident_light(const Stokes& stokes, const Vec3& to_source) {
  Light light;
  light.stokes = stokes;
  light.stokes.u = -stokes.u;
  light.s_axis = source_axis(to_source);
  return light;
}

}  // namespace

MonteCarloResult BallTracer::trace(const Optics& optics, const Illumination& illumination,
                                   const std::vector<double>& cones_deg, const Sampling& sampling,
                                   const PathPolicy& policy, const Cancellation* cancel, const DirectionScore* score,
                                   Progress* progress) const {
  LightSetup setup(geometry::Part{}, Vec2::Zero(), optics, illumination, cones_deg);
  setup.score = score;
  const BallEntry entry(layer_, setup.to_source);
  const Light light = incident_light(illumination.stokes, setup.to_source);
  const std::size_t score_size = score != nullptr ? score->size() : 0;
  const auto task = [&](std::uint32_t replicate, std::uint32_t first, std::uint32_t last) -> std::optional<Tally> {
    const FlushDenormals flush;
    Tally tally(cones_deg.size(), score_size);
    const auto keys = scramble_keys(sampling.seed, replicate);
    const SobolSquare square(keys[0], keys[1]);
    const RandomKey key{sampling.seed, kChoiceStream};
    BallWalker walker(layer_, setup, policy, tally);
    for (std::uint32_t ray = first; ray < last; ++ray) {
      if (cancel != nullptr && cancel->requested()) return std::nullopt;
      walker.trace(entry(square(ray)), -setup.to_source, light, {key, replicate, ray});
    }
    return tally;
  };
  Rounds rounds(
      sampling, cones_deg, score_size,
      [&](std::uint32_t from, std::uint32_t until, std::vector<Tally>& replicates) {
        return trace_replicates(from, until, replicates, task);
      },
      progress);
  while (!rounds.advance()) continue;
  return rounds.result();
}

}  // namespace retrace::raytrace
