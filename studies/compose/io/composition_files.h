#pragma once

// Output documents and tables of `retrace compose`.

#include <string>

#include "studies/compose/compose.h"

namespace retrace::studies {

/// Returns the result as a document of the format `retrace.composition/2`.
std::string composition_json(const Study& study, const ComposeRequest& request, const Composition& composition,
                             double elapsed_s);

/// Returns the contribution of each zone to each goal as CSV, with one line for each goal.
std::string composition_csv(const Study& study, const ComposeRequest& request, const Composition& composition);

/// Returns the zones, goals, prices and the proof of optimality for the terminal.
std::string composition_text(const Study& study, const ComposeRequest& request, const Composition& composition);

/// Returns why there is no part, or why the part does not reach the requested minimum goal. Empty if a part reaches it.
std::string why_not_reached(const Study& study, const ComposeRequest& request, const Composition& composition);

}  // namespace retrace::studies
