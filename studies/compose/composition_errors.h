#pragma once

// Computes the effects of errors of the angles between facets on a composed part: its yield, its sensitivity to each
// angle, and the part that is optimal for the worst of the drawn parts.

#include "studies/compose/compose.h"

namespace retrace::studies {

/// Returns the effects for the best part of a composition.
/// \pre request.errors is set, and the cells of all zones have angles between facets
/// \throw Interrupted if the computation is cancelled
/// \throw InputError for cells that cannot be computed with errors
ErrorEffects effects_of_errors(const Study& study, const ComposeRequest& request, const Composition& composition,
                               OptimiseObserver* observer, const Cancellation* cancel);

}  // namespace retrace::studies
