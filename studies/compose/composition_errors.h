#pragma once

// Effects of errors of the angles between facets on a composed part: the yield, the sensitivity to each angle, and the
// composition that is optimized for the worst random parts.

#include "studies/compose/compose.h"

namespace retrace::studies {

/// Computes the effects of angle errors on the best part of a composition.
/// \pre request.errors is set, and the cells of all zones have angles between facets
/// \throw Interrupted if the computation is cancelled
/// \throw InputError if cells with angle errors cannot be computed
ErrorEffects effects_of_errors(const Study& study, const ComposeRequest& request, const Composition& composition,
                               OptimiseObserver* observer, const Cancellation* cancel);

}  // namespace retrace::studies
