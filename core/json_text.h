#pragma once

// JSON documents as text in one fixed form, so that the same result always gives the same bytes.

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "core/warning.h"

namespace retrace {

/// Returns a JSON document as text. Keys are in the order in which they were set. Keys with the value NaN or infinity
/// are omitted. Numbers are written as the shortest text that reads back as the same number. An object that contains
/// only numbers and texts is written on one line. Arrays of numbers, and arrays of arrays of numbers, are also written
/// on one line. The text ends with a newline.
std::string to_text(const nlohmann::ordered_json& document);

/// Returns the JSON document of a result: the schema, the content, the version of the program, the warnings, and
/// whether the result is complete.
std::string result_text(std::string_view schema, nlohmann::ordered_json content, const Warnings& warnings,
                        bool complete = true);

}  // namespace retrace
