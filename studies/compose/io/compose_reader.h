#pragma once

// Reads the request for a composition from a study file: goals, rules for areas, prices, and constraints on cells and
// the part.

#include "studies/compose/compose.h"

namespace retrace::studies {

/// Reads the tables [compose] and [[constraint]] of a study.
/// \throw InputError for invalid keys
ComposeRequest read_compose(const Study& study);

}  // namespace retrace::studies
