#pragma once

// Chooses the parameters that become the axes of the plots of an optimization.

#include <cstddef>
#include <vector>

#include "studies/optimise/optimise.h"

namespace retrace::studies {

/// Returns the one or two parameters that explain most of the variation of the objective over all evaluated designs,
/// the most important parameter first. Parameters whose values are not numbers are omitted. If the study has exactly
/// one continuous parameter, only one parameter is returned.
std::vector<std::size_t> important_parameters(const Study& study, const Optimum& optimum);

}  // namespace retrace::studies
