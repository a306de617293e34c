#pragma once

// Cells of a family with errors of the angles between their facets.

#include <cstddef>
#include <vector>

#include "core/progress.h"
#include "studies/compose/compose.h"

namespace retrace::studies {

/// How many angles between facets cells of those values have: three of a cube corner, one of a prism, 0 of all else.
std::size_t angles_of(const Study& study, const PointValues& values);

/// Goals of the cell with each of these errors added to its own, in minutes of arc; several are computed at a time.
/// \pre as many errors as angles_of() \throw Interrupted; InputError if such a cell cannot be computed
std::vector<std::vector<double>> goals_with_errors(const Study& study, const ComposeRequest& request,
                                                   const FamilyCell& cell,
                                                   const std::vector<std::vector<double>>& errors_arcmin,
                                                   const Cancellation* cancel);

}  // namespace retrace::studies
