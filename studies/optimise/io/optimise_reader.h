#pragma once

// Reads the request for an optimization from a study file: objective, constraints, Pareto front, tolerance bands.

#include "studies/optimise/optimise.h"

namespace retrace::studies {

/// Reads the tables [optimize] and [[constraint]] of a study.
/// \throw InputError for invalid keys
OptimiseRequest read_optimise(const Study& study);

}  // namespace retrace::studies
