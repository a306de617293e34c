#pragma once

// Output documents and tables of `retrace optimize`.

#include <string>

#include "studies/optimise/optimise.h"

namespace retrace::studies {

/// Returns the result as a document of the format `retrace.optimum/1`.
std::string optimum_json(const Study& study, const OptimiseRequest& request, const Optimum& optimum, double elapsed_s);

/// Returns the Pareto front as CSV, with one line for each design.
std::string front_csv(const Study& study, const Optimum& optimum);

/// Returns the chosen design, its alternatives and its tolerance bands for the terminal.
std::string optimum_text(const Study& study, const OptimiseRequest& request, const Optimum& optimum);

}  // namespace retrace::studies
