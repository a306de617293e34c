#pragma once

// The beam tracer and the ray tracer of one part, and the choice between them.

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <variant>
#include <vector>

#include "core/progress.h"
#include "raytrace/engines/engine.h"
#include "raytrace/exact/beam_tracer.h"
#include "raytrace/exact/scattered_light.h"
#include "raytrace/faces/back_surface.h"
#include "raytrace/paths/monte_carlo.h"

namespace retrace::raytrace {

/// Result of tracing light from one direction at one wavelength.
struct EngineResult {
  Engine engine = Engine::exact;  ///< engine that was used: exact, stochastic, cell or embree
  std::variant<BeamResult, MonteCarloResult> traced;
  std::uint64_t beams = 0;  ///< engine `stochastic`: number of traced beams
};

/// Traces light from different directions and at different wavelengths through a part. The tracers are constructed when
/// they are needed for the first time. All threads may share one object.
class PartEngines {
 public:
  struct Settings {
    Engine rays = Engine::embree;  ///< result of ray_engine()
    BeamTracer::Elements elements = BeamTracer::Elements::instanced;
    bool has_texture = false;  ///< true if retro facets scatter
    /// Policy of exact beams. by_fastest() traces no stochastic beams if a cut-off is given.
    BeamPolicy beams = {};
    PathPolicy paths = {};
    std::vector<double> cones_deg = {};
  };
  /// Incident light from one direction at one wavelength, with the parameters of its sampling.
  struct Light {
    const Optics& optics;
    Illumination illumination;
    Sampling sampling;
  };

  /// \param entrance curved entrance face; null for a plane one
  /// \pre `part`, `entrance` and `cancel` outlive this object
  PartEngines(const geometry::Part& part, const geometry::Entrance* entrance, Settings settings,
              const Cancellation* cancel);

  /// Sets the number of calls of by_fastest() that will follow. The construction time of the beam tracer is divided
  /// evenly among these calls. Only the first call of expect() has an effect.
  void expect(std::size_t count);
  const Settings& settings() const { return settings_; }
  const BeamTracer& beam_tracer();

  EngineResult by_rays(const Light& light, Progress& progress);
  EngineResult by_stochastic_beams(const Light& light, Progress& progress);
  /// Traces with the method (exact beams, stochastic beams or rays) that is expected to reach the goal first. The
  /// method is selected before every round. A method continues where it stopped if another method turns out to be
  /// slower than expected. Returns nothing if tracing was cancelled.
  /// \pre expect() was called
  std::optional<EngineResult> by_fastest(const Light& light, Progress& progress);

 private:
  struct Beams;

  const MonteCarlo& ray_tracer();
  double ns_of_segment() const;
  std::unique_ptr<ScatteredLight> scattered_light(const Light& light);
  void begin(Beams& beams, const Light& light);

  const geometry::Part& part_;
  const geometry::Entrance* entrance_;
  Settings settings_;
  const Cancellation* cancel_;
  /// Expected time, in ns, for constructing `beam_tracer_`, divided by the number of calls of by_fastest().
  std::optional<double> tracer_ns_;
  std::once_flag beam_tracer_is_made_;
  std::optional<BeamTracer> beam_tracer_;
  std::optional<BackSurface> scattering_;  ///< back surface for rays of scattered light; set if `has_texture`
  std::once_flag ray_tracer_is_made_;
  std::optional<MonteCarlo> ray_tracer_;
};

}  // namespace retrace::raytrace
