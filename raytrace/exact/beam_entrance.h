#pragma once

// Division of the incident light into the first beams of a run.

#include "raytrace/exact/beam_queue.h"
#include "raytrace/exact/beam_record.h"
#include "raytrace/exact/beam_scene.h"

namespace retrace::raytrace {

/// Queues the beams that enter through the entrance face. Light that is lost by rounding is recorded. Beams at
/// identical positions of an array become one beam if the scene has a symmetry.
/// \param entrance outline of the entrance face
void enter_beams(const BeamScene& scene, const geometry::Polygon& entrance, BeamRecord& record, BeamQueue& queue);

}  // namespace retrace::raytrace
