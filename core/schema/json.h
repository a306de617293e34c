#pragma once

// Converts documents to JSON in the form that result files contain, and converts JSON to TOML text.

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "core/schema/document.h"

namespace retrace::schema {

/// Returns a value as JSON: null if it is not given.
nlohmann::ordered_json to_json(const Value& value);

/// Returns the keys that are given in a document as JSON, in the order of the format.
nlohmann::ordered_json to_json(const Document& document);

/// Returns a TOML text with the keys and tables of `json` that belong to the format. Other keys and tables are omitted.
std::string toml_of_json(const Format& format, const nlohmann::ordered_json& json);

}  // namespace retrace::schema
