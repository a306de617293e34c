#pragma once

// Processes the fragments of a beam at the faces of the part.

#include "raytrace/exact/beam_queue.h"
#include "raytrace/exact/beam_record.h"
#include "raytrace/exact/beam_scene.h"
#include "raytrace/exact/visible_facets.h"

namespace retrace::raytrace {

/// The next step of a beam.
struct BeamStep {
  const BeamScene& scene;
  const Beam& beam;
  Frame frame;  ///< coordinate axes of the beam
  Horizon horizon;
  BeamRecord& record;
  BeamQueue& queue;  ///< receives the beams after the step
};

/// Fragment of the cross-section of a beam.
struct Fragment {
  const FlatPolygon& polygon;
  double area_fraction = 0.0;  ///< its part of Beam::area_fraction
};

/// Processes a fragment that meets a facet.
void meet_facet(const BeamStep& step, const Fragment& fragment, const Candidate& facet);

/// Processes a fragment that meets no facet within the horizon.
void pass_facets(const BeamStep& step, const Fragment& fragment);

}  // namespace retrace::raytrace
