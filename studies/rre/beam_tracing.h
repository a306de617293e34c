#pragma once

// Traces light from one direction at one wavelength by the exact engine only: points of RRE, footprint and far field.
// Methods with random sampling are in tracing.h.

#include <optional>
#include <vector>

#include "core/progress.h"
#include "design/design.h"
#include "raytrace/exact/beam_tracer.h"
#include "studies/rre/rre.h"

namespace retrace::studies {

/// Returns the illumination (direction and polarisation) for a point of RRE.
raytrace::Illumination illumination_of(const RrePoint& at, const design::Design& design);

/// Results that a request needs from returned beams in addition to RRE.
struct BeamOutputRequest {
  bool footprint = false;
  bool far_field = false;
};

/// Collects the returned beams of one direction for the footprint and the far field, if they are requested.
class BeamCollector {
 public:
  /// \param cones number of acceptance cones into which beams are sorted
  BeamCollector(const BeamOutputRequest& question, const geometry::Part& part, std::size_t cones,
                const raytrace::Illumination& illumination);

  /// Returns the observer that receives the beams. Empty if nothing is requested.
  /// \pre the collector exists as long as the observer
  raytrace::BeamObserver observer();
  std::optional<Footprint> footprint() const;
  std::optional<FarField> far_field() const;

 private:
  std::optional<FootprintBuilder> footprint_;
  std::optional<FarFieldBuilder> far_field_;
};

/// Results of exact beams for one direction at one wavelength.
struct BeamOutputs {
  raytrace::BeamResult traced;  ///< not complete if tracing was cancelled; the other members are then empty
  std::optional<Footprint> footprint;
  std::optional<FarField> far_field;
};

/// Traces the beams of one direction at one wavelength.
/// \param part part for which `tracer` was made
/// \throw BudgetError in the same cases as BeamTracer::trace()
BeamOutputs trace_exact_beams(const raytrace::BeamTracer& tracer, const geometry::Part& part,
                              const raytrace::Optics& optics, const raytrace::Illumination& illumination,
                              const std::vector<double>& cones_deg, const raytrace::BeamPolicy& policy,
                              const BeamOutputRequest& question, const Cancellation* cancel, Progress* progress);

/// Returns the points of a direction from exact beams, one for each acceptance cone.
/// \param at point with the data that all cones have in common
std::vector<RrePoint> points_of(const RrePoint& at, const std::vector<double>& cones_deg,
                                const raytrace::BeamResult& traced);
/// Returns the points of a direction from a randomly sampled result, one for each acceptance cone.
std::vector<RrePoint> points_of(const RrePoint& at, const raytrace::MonteCarloResult& traced);

}  // namespace retrace::studies
