#pragma once

// Reads what a study file says of its sweep: grid or sample.

#include "studies/sweep/sweep.h"

namespace retrace::studies {

/// The sweep that a study describes in [sweep]; without that table, its grid. \throw InputError
Sweep read_sweep(Study study);

}  // namespace retrace::studies
