#pragma once

// Describes all requests as JSON. The Python package and the documentation are generated from this JSON.

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace retrace::requests {

/// Returns the description of all requests and their fields as JSON (see "Requests" in docs/library.md).
nlohmann::ordered_json description_json();

/// Returns the Python keyword of a field. The function can be used as a FieldSpelling (core/field.h).
/// \param field name of the field in messages, as returned by Row::field()
std::string keyword_of_field(std::string_view field);

}  // namespace retrace::requests
