#pragma once

// Description of all requests as JSON, from which the Python package and the documentation are made.

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace retrace::requests {

/// Returns the description of all requests (docs/library.md, "Requests").
nlohmann::ordered_json description_json();

/// Returns the keyword of a field in Python. The field is named as in messages, see Row::field(). It is a
/// FieldSpelling.
std::string keyword_of_field(std::string_view field);

}  // namespace retrace::requests
