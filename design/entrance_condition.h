#pragma once

// Converts the state of a design's entrance face (contamination and damage) to an optical model.

#include "design/design.h"
#include "raytrace/light/optics.h"

namespace retrace::design {

/// Returns the optical model of contamination and damage of the entrance face.
/// \param optics optical properties, complete except for the entrance face and the texture of the facets
/// \throw InputError at the key of a roughness for which no model is valid
raytrace::EntranceCondition condition_of(const Design& design, const raytrace::Optics& optics);

}  // namespace retrace::design
