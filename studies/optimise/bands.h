#pragma once

// Internal to studies/optimise: tolerance bands of single keys about the best design.

#include "studies/optimise/optimise.h"

namespace retrace::studies {

/// How far a key of a design may be off before the first quantity of the objective has lost `band_loss` of its value.
ToleranceBand tolerance_band(const Study& study, const OptimiseRequest& request, const Variant& best,
                             const std::string& key, const Cancellation* cancel);

}  // namespace retrace::studies
