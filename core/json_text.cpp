#include "core/json_text.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/number_format.h"
#include "core/version.h"

namespace retrace {
namespace {

using Json = nlohmann::ordered_json;

bool is_written(const Json& value) {
  return !value.is_number_float() || std::isfinite(value.get<double>());
}

/// Returns true for a number and for an array of numbers of any depth, such as coordinates.
bool is_numeric(const Json& value) {
  return value.is_number() || (value.is_array() && std::all_of(value.begin(), value.end(), is_numeric));
}

bool is_flat(const Json& value) {
  if (value.is_array() && is_numeric(value)) return true;
  return std::all_of(value.begin(), value.end(), [](const Json& v) { return !v.is_structured() || v.empty(); });
}

class Writer {
 public:
  std::string text;

  void write(const Json& value, int depth) {
    if (value.is_object() || value.is_array())
      write_members(value, depth);
    else if (value.is_number_float())
      text += shortest(value.get<double>());
    else
      text += value.dump(-1, ' ', false, Json::error_handler_t::replace);
  }

 private:
  void write_members(const Json& value, int depth) {
    const bool one_line = is_flat(value);
    text += value.is_object() ? '{' : '[';
    bool first = true;
    for (auto it = value.begin(); it != value.end(); ++it) {
      if (!is_written(*it)) continue;
      if (!first) text += one_line ? ", " : ",";
      first = false;
      if (!one_line) text += '\n' + std::string(2 * (static_cast<std::size_t>(depth) + 1), ' ');
      if (value.is_object()) text += Json(it.key()).dump(-1, ' ', false, Json::error_handler_t::replace) + ": ";
      write(*it, depth + 1);
    }
    if (!one_line && !first) text += '\n' + std::string(2 * static_cast<std::size_t>(depth), ' ');
    text += value.is_object() ? '}' : ']';
  }
};

}  // namespace

std::string to_text(const nlohmann::ordered_json& document) {
  Writer writer;
  writer.write(document, 0);
  return writer.text + '\n';
}

std::string result_text(std::string_view schema, Json content, const Warnings& warnings, bool complete) {
  Json document = {{"schema", schema}};
  for (auto& member : content.items()) document[member.key()] = std::move(member.value());
  document["version"] = kVersion;
  document["warnings"] = texts_of(warnings);
  document["complete"] = complete;
  return to_text(document);
}

}  // namespace retrace
