#pragma once

// Documents and tables of `retrace sweep`.

#include <string>

#include "studies/sweep/sweep.h"

namespace retrace::studies {

/// The result as a `retrace.sweep/1` document.
std::string sweep_json(const SweepResult& result);

/// One line a point, inputs and quantities; the same for every run of a sweep.
std::string sweep_csv(const SweepResult& result);

/// The points as a table for the terminal.
std::string sweep_table(const SweepResult& result);

}  // namespace retrace::studies
