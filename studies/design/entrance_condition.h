#pragma once

// What a design's entrance face does to light, from what the design says that it is like.

#include "raytrace/light/optics.h"
#include "studies/design/design.h"

namespace retrace::studies {

/// \param optics all but its entrance and its facets' texture \throw InputError naming the key of a roughness that no
/// model holds for
raytrace::EntranceCondition condition_of(const Design& design, const raytrace::Optics& optics);

}  // namespace retrace::studies
