#pragma once

// Reads what a study file asks of a composition: goals, rules for shares, prices, constraints over cells and the part.

#include "studies/compose/compose.h"

namespace retrace::studies {

/// What [compose] and [[constraint]] of a study ask. \throw InputError
ComposeRequest read_compose(const Study& study);

}  // namespace retrace::studies
