#pragma once

// Reads what a study file asks of an optimisation: objective, constraints, Pareto front, tolerance bands.

#include "studies/optimise/optimise.h"

namespace retrace::studies {

/// What [optimize] and [[constraint]] of a study ask. \throw InputError
OptimiseRequest read_optimise(const Study& study);

}  // namespace retrace::studies
