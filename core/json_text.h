#pragma once

// JSON documents as text in one fixed form, so that the same result always gives the same bytes.

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "core/warning.h"

namespace retrace {

/// A JSON document as text: keys in the order they were set, numbers as the shortest text that reads back equal, and
/// keys whose value is NaN or infinite left out. Objects of numbers and texts alone stand on one line, and so do
/// numbers in arrays, nested or not. Ends with a newline.
std::string to_text(const nlohmann::ordered_json& document);

/// The document of a result: its schema, what it holds, and what every result says of itself at its end: the program's
/// version, warnings, and whether all that was requested is there.
std::string result_text(std::string_view schema, nlohmann::ordered_json content, const Warnings& warnings,
                        bool complete = true);

}  // namespace retrace
