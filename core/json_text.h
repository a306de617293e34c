#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace retrace {

/// A JSON document as text: keys in the order they were set, numbers as the shortest text that reads back equal, and
/// keys whose value is NaN or infinite left out. Objects of numbers and texts alone stand on one line, and so do
/// numbers in arrays, nested or not. Ends with a newline.
std::string to_text(const nlohmann::ordered_json& document);

}  // namespace retrace
