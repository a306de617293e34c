#pragma once

// Division of the incident light into the first beams of a run.

#include "raytrace/exact/beam_queue.h"
#include "raytrace/exact/beam_record.h"
#include "raytrace/exact/beam_scene.h"

namespace retrace::raytrace {

/// Queues the beams that enter through the entrance face. Light that is lost by rounding is added to `record`. If
/// BeamScene::symmetry is set, beams at equivalent positions of the array become one beam.
void enter_beams(const BeamScene& scene, BeamRecord& record, BeamQueue& queue);

}  // namespace retrace::raytrace
