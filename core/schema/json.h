#pragma once

// Converts documents to JSON, in the form in which result files contain them, and JSON to TOML text.

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "core/schema/document.h"

namespace retrace::schema {

/// Converts a value to JSON. A value that is not given becomes null.
nlohmann::ordered_json to_json(const Value& value);

/// Converts a document to JSON, with the keys in the order of the format. Keys that are not given are omitted.
nlohmann::ordered_json to_json(const Document& document);

/// Returns a TOML text with the keys and tables of `json` that belong to the format. Other keys and tables are omitted.
std::string toml_of_json(const Format& format, const nlohmann::ordered_json& json);

}  // namespace retrace::schema
