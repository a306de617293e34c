#pragma once

// Computes the goals of a cell with errors of the angles between its facets.

#include <cstddef>
#include <vector>

#include "core/progress.h"
#include "studies/compose/compose.h"

namespace retrace::studies {

/// Returns the number of angles between facets that may have errors: three for a cube corner, one for a prism,
/// otherwise 0.
std::size_t angles_of(const Study& study, const PointValues& values);

/// Returns the goals of the cell for each set of angle errors. Several sets are computed in parallel.
/// \param errors_arcmin sets of errors, which are added to the errors that the design of the cell specifies
/// \pre each set has angles_of() errors
/// \throw Interrupted if the computation is cancelled
/// \throw InputError if a cell with errors cannot be computed
std::vector<std::vector<double>> goals_with_errors(const Study& study, const ComposeRequest& request,
                                                   const FamilyCell& cell,
                                                   const std::vector<std::vector<double>>& errors_arcmin,
                                                   const Cancellation* cancel);

}  // namespace retrace::studies
