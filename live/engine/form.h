#pragma once

// Describes the keys of the design format for the page's form, and returns the values that a document has for these
// keys.

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "core/schema/document.h"

namespace retrace::live {

using Json = nlohmann::ordered_json;

/// Returns all tables and their keys. This is the member `groups` of the answer `form`.
Json form_json();

/// Returns the keys that have an effect in a design, in the order of the form, with their current values.
Json keys_json(const schema::Document& document);

/// Returns a JSON value of a request as TOML on one line.
/// \throw InputError for values that do not exist in TOML
std::string toml_of(const Json& value);

}  // namespace retrace::live
