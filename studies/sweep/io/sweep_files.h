#pragma once

// Output documents and tables of `retrace sweep`.

#include <string>

#include "studies/sweep/sweep.h"

namespace retrace::studies {

/// Returns the result as a document of the format `retrace.sweep/1`.
std::string sweep_json(const SweepResult& result);

/// Returns the inputs and quantities of the points as CSV. The text is the same for every run of the same sweep.
std::string sweep_csv(const SweepResult& result);

/// Returns the values of the parameters and of the quantities of a point in one line.
std::string point_text(const Sweep& sweep, const compute::StoredPoint& point);

/// Returns a line about the finished points of a sweep that still runs: their number, and the values of the last one.
std::string sweep_so_far(const Sweep& sweep, const std::vector<compute::StoredPoint>& points);

/// Returns the points as a table for the terminal.
std::string sweep_table(const SweepResult& result);

}  // namespace retrace::studies
