#pragma once

// Answers to requests of the page about an opened design, as JSON. README.md of live/ describes the contents of each
// answer.

#include <nlohmann/json_fwd.hpp>

#include "live/engine/opened_design.h"
#include "live/engine/time_limit.h"

namespace retrace::live {

using Json = nlohmann::ordered_json;

/// Returns the keys of a design, and what the page can compute for it.
Json design_json(const OpenedDesign& opened);
/// Returns the three-dimensional part for display, and its plan.
Json part_json(const OpenedDesign& opened);
/// Returns binary STL of one element on its plate.
Json stl_json(const OpenedDesign& opened);

// The functions with the parameter `request` throw InputError if a value of the request is missing or invalid.

/// Traces the light from one direction.
Json direction_json(const OpenedDesign& opened, const Json& request, const TimeLimit& limit);
/// Computes RRE (retroreflective efficiency) for many directions until the time limit is reached.
Json rre_json(const OpenedDesign& opened, const Json& request, const TimeLimit& limit);
/// Traces the light that enters at one position.
Json path_json(const OpenedDesign& opened, const Json& request);
/// Returns the most frequent light paths.
Json typical_paths_json(const OpenedDesign& opened, const Json& request);

/// Returns the photometric standards whose limits retrace contains.
Json standards_json();
/// Computes the test points of a standard.
Json photometry_json(const OpenedDesign& opened, const Json& request, TimeLimit& limit);

}  // namespace retrace::live
