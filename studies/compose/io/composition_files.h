#pragma once

// Documents and tables of `retrace compose`.

#include <string>

#include "studies/compose/compose.h"

namespace retrace::studies {

/// The result as a `retrace.composition/1` document.
std::string composition_json(const Study& study, const ComposeRequest& request, const Composition& composition,
                             double elapsed_s);

/// What each zone gives to each goal, one goal a line.
std::string composition_csv(const Study& study, const ComposeRequest& request, const Composition& composition);

/// Zones, goals, prices and what is known of how good the part is, for the terminal.
std::string composition_text(const Study& study, const ComposeRequest& request, const Composition& composition);

/// Why there is no part, or why the part does not reach what was asked: the goals that exclude every mixture. Empty if
/// there is one that does.
std::string why_not_reached(const Study& study, const ComposeRequest& request, const Composition& composition);

}  // namespace retrace::studies
