#include "core/schema/json.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/overloaded.h"
#include "core/schema/reader.h"
#include "core/toml_file.h"

namespace retrace::schema {
namespace {

using Json = nlohmann::ordered_json;

/// Converts the TOML texts of a list's entries to a JSON array.
Json anything_json(const std::vector<std::string>& texts) {
  Json json = Json::array();
  for (const std::string& text : texts)
    json.push_back(Json::parse(parse_toml("value = " + text, "").as_json("value"))["value"]);
  return json;
}

Json value_json(const Kind& kind, const Value& value) {
  if (std::holds_alternative<Anything>(kind)) return anything_json(std::get<std::vector<std::string>>(value));
  if (std::holds_alternative<Integer>(kind)) return static_cast<std::int64_t>(std::get<double>(value));
  return to_json(value);
}

Json table_json(const Document& document, const Table& table, const std::string& path) {
  Json json = Json::object();
  for (const Row& row : table.rows)
    if (const std::string key = path_in(path, row.key); document.has(key) && document.row(key) == &row)
      json[row.key] = value_json(row.kind, document.value(key));
  for (const Table& inner : table.tables) {
    const std::string name = path_in(path, inner.name);
    if (!document.has(name)) continue;
    if (inner.presence != Presence::list) json[inner.name] = table_json(document, inner, name);
    for (std::size_t k = 0; inner.presence == Presence::list && k < document.count(name); ++k)
      json[inner.name].push_back(table_json(document, inner, path_of_entry(name, k)));
  }
  return json;
}

std::string toml_value(const Json& value) {
  if (value.is_string()) return toml_text(value.get<std::string>());
  if (!value.is_array() && !value.is_object()) return value.dump();
  std::string text;
  for (const auto& [key, item] : value.items())
    text += (text.empty() ? "" : ", ") + (value.is_object() ? toml_text(key) + " = " : "") + toml_value(item);
  return value.is_object() ? fmt::format("{{{}}}", text) : fmt::format("[{}]", text);
}

}  // namespace

Json to_json(const Value& value) {
  return std::visit(Overloaded{[](std::monostate) { return Json(); },
                               [](const Named& named) {
                                 Json json = Json::object();
                                 for (const auto& [name, each] : named)
                                   std::visit([&, &key = name](const auto& v) { json[key] = v; }, each);
                                 return json;
                               },
                               [](const auto& each) { return Json(each); }},
                    value);
}

Json to_json(const Document& document) {
  return table_json(document, document.table(), "");
}

std::string toml_of_json(const Format& format, const Json& json) {
  std::string keys = fmt::format("schema = {}\n", toml_text(format.id));
  std::string tables;
  const std::vector<TomlRename> names = former_names(format);
  if (!json.is_object()) return keys;
  for (const auto& [name, value] : json.items()) {
    const std::string current = current_path(name, names);
    const bool is_known = std::ranges::count(format.root.rows, current, &Row::key) > 0 ||
                          std::ranges::count(format.root.tables, current, &Table::name) > 0;
    if (is_known && !value.is_object()) keys += fmt::format("{} = {}\n", name, toml_value(value));
    if (!is_known || !value.is_object()) continue;
    tables += fmt::format("[{}]\n", name);
    for (const auto& [key, item] : value.items()) tables += fmt::format("{} = {}\n", toml_text(key), toml_value(item));
  }
  return keys + tables;
}

}  // namespace retrace::schema
