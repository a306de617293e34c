#pragma once

// Documents as JSON, as results quote the files they were made from, and back to TOML text.

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "core/schema/document.h"

namespace retrace::schema {

/// What a document gives, with its keys in the order of the format.
nlohmann::ordered_json to_json(const Document& document);

/// The text of a file of the format, of what its keys and tables are in `json`; what is not of the format is left out.
std::string toml_of_json(const Format& format, const nlohmann::ordered_json& json);

}  // namespace retrace::schema
