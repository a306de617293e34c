#pragma once

// Converts documents to JSON, as result files contain them, and JSON to TOML text.

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "core/schema/document.h"

namespace retrace::schema {

/// Returns the keys that are given in a document as JSON, in the order of the format.
nlohmann::ordered_json to_json(const Document& document);

/// Returns a TOML text with the keys and tables of `json` that belong to the format. All others are omitted.
std::string toml_of_json(const Format& format, const nlohmann::ordered_json& json);

}  // namespace retrace::schema
