#pragma once

// Reads the sweep of a study file: a grid or a sample.

#include "studies/sweep/sweep.h"

namespace retrace::studies {

/// Reads the table [sweep] of a study. Without this table, the sweep is a grid.
/// \throw InputError for invalid keys
Sweep read_sweep(Study study);

}  // namespace retrace::studies
