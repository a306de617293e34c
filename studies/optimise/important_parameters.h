#pragma once

// Chooses the parameters over which the result of an optimization is drawn.

#include <cstddef>
#include <vector>

#include "studies/optimise/optimise.h"

namespace retrace::studies {

/// Returns the parameters that explain most of the variation of the objective over all evaluated designs, the most
/// important first. Returns at most two. Parameters whose values are not numbers are omitted. Only one parameter is
/// returned if the study has only one continuous parameter.
std::vector<std::size_t> important_parameters(const Study& study, const Optimum& optimum);

}  // namespace retrace::studies
