#pragma once

// The rows of the design format as the page's form wants them, and the values that a document has for them.

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "core/schema/document.h"

namespace retrace::live {

using Json = nlohmann::ordered_json;

/// All tables with their rows: `groups` of the ask `form`.
Json form_json();

/// The keys that mean something beside what a design says, in the order of the form, with the values that hold.
Json keys_json(const schema::Document& document);

/// A value of a JSON request as TOML, on one line. \throw InputError for what TOML has not
std::string toml_of(const Json& value);

}  // namespace retrace::live
