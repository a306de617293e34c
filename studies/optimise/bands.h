#pragma once

// Tolerance bands of single keys around the best design. Internal to studies/optimise.

#include "studies/optimise/optimise.h"

namespace retrace::studies {

/// Returns the range of a key within which the first quantity of the objective loses at most `band_loss` of its value.
ToleranceBand tolerance_band(const Study& study, const OptimiseRequest& request, const Variant& best,
                             const std::string& key, const Cancellation* cancel);

}  // namespace retrace::studies
