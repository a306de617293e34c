#pragma once

// What the page asks of an opened design, as JSON: README.md of live/ says what each answer holds.

#include <nlohmann/json_fwd.hpp>

#include "live/engine/opened_design.h"
#include "live/engine/time_limit.h"

namespace retrace::live {

using Json = nlohmann::ordered_json;

/// What a design says, and what of it the page can do.
Json design_json(const OpenedDesign& opened);
/// The part to look at, and its plan.
Json part_json(const OpenedDesign& opened);
/// Binary STL of one element on its plate.
Json stl_json(const OpenedDesign& opened);

// Of a request. \throw InputError for what it lacks

/// What becomes of the light from one direction.
Json direction_json(const OpenedDesign& opened, const Json& request, const TimeLimit& limit);
/// RRE from many, as far as there is time.
Json rre_json(const OpenedDesign& opened, const Json& request, const TimeLimit& limit);
/// The way of light that enters at one place.
Json path_json(const OpenedDesign& opened, const Json& request);
/// The most frequent ways.
Json stories_json(const OpenedDesign& opened, const Json& request);

/// The standards whose limits are shipped.
Json standards_json();
/// Test points of a standard.
Json photometry_json(const OpenedDesign& opened, const Json& request, TimeLimit& limit);

}  // namespace retrace::live
