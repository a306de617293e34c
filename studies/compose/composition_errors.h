#pragma once

// What errors of the angles between facets make of a composed part: its yield, what each angle is worth, and the part
// that is best for the worst parts.

#include "studies/compose/compose.h"

namespace retrace::studies {

/// Of the best part. \pre request.errors; zones whose cells have angles between facets \throw Interrupted; InputError
/// for cells that cannot be computed with errors
ErrorEffects effects_of_errors(const Study& study, const ComposeRequest& request, const Composition& composition,
                               OptimiseObserver* observer, const Cancellation* cancel);

}  // namespace retrace::studies
