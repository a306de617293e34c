#pragma once

// Facts about a design that determine which engines can trace it.

#include "core/error.h"
#include "design/design.h"
#include "raytrace/engines/engine.h"

namespace retrace::design {

/// Returns the facts about a design on which the choice of the engine depends, except EngineFacts::has_unequal_cells.
/// \param optics optical properties of the design; null: facts that depend on them are not set
raytrace::EngineFacts engine_facts(const Design& design, const raytrace::Optics* optics);

/// Returns the position of the key in the design file that causes an obstacle (a reason why an engine cannot trace the
/// design). If no single key is the cause, returns a position without a key.
InputLocation position_of(const Design& design, raytrace::Obstacle obstacle);

}  // namespace retrace::design
