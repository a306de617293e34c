#pragma once

// What becomes of the light from one direction at one wavelength, by the exact engine alone: points of RRE, and what
// its returned beams show. What samples rays is in tracing.h.

#include <optional>
#include <vector>

#include "core/progress.h"
#include "raytrace/exact/beam_tracer.h"
#include "studies/design/design.h"
#include "studies/rre/rre.h"

namespace retrace::studies {

/// The light of a point.
raytrace::Illumination illumination_of(const RrePoint& at, const Design& design);

/// What is asked of the returned beams beyond RRE.
struct BeamQuestion {
  bool footprint = false;
  bool far_field = false;
};

/// Gathers the returned beams of one direction, as far as they are asked for.
class BeamCollector {
 public:
  /// \param cones how many acceptance cones beams are sorted by
  BeamCollector(const BeamQuestion& question, const geometry::Part& part, std::size_t cones,
                const raytrace::Illumination& illumination);

  /// None if nothing is asked. \pre the collector outlives it
  raytrace::BeamObserver observer();
  std::optional<Footprint> footprint() const;
  std::optional<FarField> far_field() const;

 private:
  std::optional<FootprintBuilder> footprint_;
  std::optional<FarFieldBuilder> far_field_;
};

/// What beams say of one direction at one wavelength.
struct BeamAnswer {
  raytrace::BeamResult traced;  ///< not complete if it was cancelled: the rest is then nothing
  std::optional<Footprint> footprint;
  std::optional<FarField> far_field;
};

/// \param part that `tracer` is of \throw BudgetError as BeamTracer::trace()
BeamAnswer follow_beams(const raytrace::BeamTracer& tracer, const geometry::Part& part, const raytrace::Optics& optics,
                        const raytrace::Illumination& illumination, const std::vector<double>& cones_deg,
                        const raytrace::BeamPolicy& policy, const BeamQuestion& question, const Cancellation* cancel,
                        Progress* progress);

/// The points of a direction, one a cone. \param at what they have in common
std::vector<RrePoint> points_of(const RrePoint& at, const std::vector<double>& cones_deg,
                                const raytrace::BeamResult& traced);
/// The same of what was sampled.
std::vector<RrePoint> points_of(const RrePoint& at, const raytrace::MonteCarloResult& traced);

}  // namespace retrace::studies
