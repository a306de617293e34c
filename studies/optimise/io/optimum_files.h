#pragma once

// Documents and tables of `retrace optimize`.

#include <string>

#include "studies/optimise/optimise.h"

namespace retrace::studies {

/// The result as a `retrace.optimum/1` document.
std::string optimum_json(const Study& study, const OptimiseRequest& request, const Optimum& optimum, double elapsed_s);

/// The front, one design a line.
std::string front_csv(const Study& study, const Optimum& optimum);

/// The chosen design, what it was chosen from and its tolerance bands, for the terminal.
std::string optimum_text(const Study& study, const OptimiseRequest& request, const Optimum& optimum);

}  // namespace retrace::studies
