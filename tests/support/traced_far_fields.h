#pragma once

#include <utility>
#include <vector>

#include "raytrace/exact/beam_tracer.h"
#include "raytrace/observers/far_field.h"

namespace retrace::testing {

/// Result of a trace of beams, and the far field of the returned beams.
struct TracedFarField {
  raytrace::BeamResult result;
  raytrace::FarField field;
};

/// Traces the beams of a part and collects their far field. The far field has the replicates of the population control.
inline TracedFarField traced_far_field(
    const geometry::Part& part, const raytrace::Optics& optics, const raytrace::Illumination& light,
    raytrace::FarFieldPolicy policy, const raytrace::BeamPolicy& beams, const std::vector<double>& cones_deg = {0.5},
    raytrace::BeamTracer::Elements elements = raytrace::BeamTracer::Elements::individual) {
  if (beams.population_control) policy.replicates = beams.population_control->replicates;
  raytrace::FarFieldCollector collector(part, light, policy);
  const auto add = [&](const raytrace::ReturnedBeam& beam) { collector.add(beam); };
  raytrace::BeamResult result =
      raytrace::BeamTracer(part, elements).trace(optics, light, cones_deg, beams, nullptr, add);
  return {std::move(result), collector.finish()};
}

/// Returns the far field of a part whose cells are traced separately. Beams below the cut-off 1e-6 are truncated.
inline raytrace::FarField far_field_of_cells(const geometry::Part& part, const raytrace::Optics& optics,
                                             const raytrace::Illumination& light,
                                             const raytrace::FarFieldPolicy& policy) {
  raytrace::BeamPolicy beams;
  beams.cutoff = 1e-6;
  beams.separate_cells = true;
  return traced_far_field(part, optics, light, policy, beams).field;
}

}  // namespace retrace::testing
