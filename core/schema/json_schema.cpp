#include "core/schema/json_schema.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "core/overloaded.h"

namespace retrace::schema {
namespace {

using Json = nlohmann::ordered_json;

Json number_json(const NumberRange& range, std::string_view type = "number") {
  Json json = {{"type", type}};
  if (std::isfinite(range.low)) json[range.low_included ? "minimum" : "exclusiveMinimum"] = range.low;
  if (std::isfinite(range.high)) json[range.high_included ? "maximum" : "exclusiveMaximum"] = range.high;
  return json;
}

Json list_json(Json items, std::size_t least, std::size_t most) {
  return {{"type", "array"}, {"items", std::move(items)}, {"minItems", least}, {"maxItems", most}};
}

Json kind_json(const Kind& kind) {
  return std::visit(
      Overloaded{[](const Number& number) { return number_json(number.range); },
                 [](const Whole& whole) { return number_json(whole.range, "integer"); },
                 [](const Flag&) {
                   return Json{{"type", "boolean"}};
                 },
                 [](const Word& word) {
                   return Json{{"type", "string"}, {"enum", word.words}};
                 },
                 [](const Text&) {
                   return Json{{"type", "string"}};
                 },
                 [](const Numbers& list) { return list_json(number_json(list.range), list.count, list.count); },
                 [](const NumberRows& rows) {
                   return list_json(list_json(number_json(rows.range), rows.columns, rows.columns), rows.least,
                                    rows.most);
                 },
                 [](const Texts&) {
                   return Json{{"type", "array"}, {"items", {{"type", "string"}}}, {"minItems", 1}};
                 }},
      kind);
}

/// The default as JSON has it; null if there is none.
Json default_json(const Default& otherwise) {
  return std::visit(
      Overloaded{[](const Required&) { return Json(); }, [](const None&) { return Json(); },
                 [](const Computed&) { return Json(); }, [](std::span<const double> numbers) { return Json(numbers); },
                 [](const auto& value) { return Json(value); }},
      otherwise);
}

std::string description(std::string_view meaning, std::string_view name) {
  const std::string_view unit = unit_of(name);
  return unit.empty() ? std::string(meaning) : fmt::format("{} In {}.", meaning, unit);
}

Json row_json(const Row& row) {
  Json json = {{"description", description(row.meaning, row.key)}};
  if (const auto* const computed = std::get_if<Computed>(&row.otherwise))
    json["description"] = fmt::format("{} By default: {}.", json["description"].get<std::string>(), computed->sentence);
  json.update(kind_json(row.kind));
  if (Json value = default_json(row.otherwise); !value.is_null()) json["default"] = std::move(value);
  return json;
}

/// A table on the way down from the root, and the conditions that keys of it decide.
struct Place {
  const Table& table;
  Place* around;
  Json conditions = Json::array();
};

const Row* word_row(const Table& table, std::string_view key) {
  for (const Row& row : table.rows)
    if (row.key == key && std::holds_alternative<Word>(row.kind)) return &row;
  return nullptr;
}

/// What a table must be for its key (or that of a table in it) to be one of the words; null if there is no such key.
Json met_json(const Table& table, const When& when, std::string_view key) {
  const std::string_view first = key.substr(0, key.find('.'));
  if (const Row* const row = word_row(table, key)) {
    Json json = {{"properties", {{key, {{"enum", when.words}}}}}};
    const auto* const word = std::get_if<std::string_view>(&row->otherwise);
    if (word == nullptr || std::find(when.words.begin(), when.words.end(), *word) == when.words.end())
      json["required"] = {key};
    return json;
  }
  for (const Table& inner : table.tables)
    if (first != key && inner.name == first)
      return {{"properties", {{first, met_json(inner, when, key.substr(first.size() + 1))}}}, {"required", {first}}};
  return nullptr;
}

/// The nearest table that decides a condition. \throw std::logic_error if there is none
Place& decider(const When& when, Place& from) {
  for (Place* place = &from; place != nullptr; place = place->around)
    if (!met_json(place->table, when, when.key).is_null()) return *place;
  throw std::logic_error("a condition names no word: " + std::string(when.key));
}

/// What is said of the table of `inner`, said of that of `outer`.
Json as_seen_from(const Place& outer, const Place& inner, Json json) {
  for (const Place* place = &inner; place != &outer; place = place->around) {
    if (place->table.presence == Presence::list) json = {{"items", std::move(json)}};
    json = {{"properties", {{place->table.name, std::move(json)}}}};
  }
  return json;
}

/// A key or a table of a table.
struct Property {
  std::string_view name;
  Json json;
  bool is_required;
  When when;
};

Json table_json(const Table& table, Place* around);

std::vector<Property> properties_of(Place& place) {
  std::vector<Property> properties;
  for (const Row& row : place.table.rows)
    properties.push_back({row.key, row_json(row), std::holds_alternative<Required>(row.otherwise), row.when});
  for (const Table& inner : place.table.tables)
    properties.push_back({inner.name, table_json(inner, &place), inner.presence == Presence::always, inner.when});
  return properties;
}

/// Puts what holds under a condition where the condition is decided. A key is refused where none of its rows holds.
void add_conditions(const std::vector<Property>& all, std::string_view name, Place& place) {
  Json any = Json::array();
  Place* outer = nullptr;
  for (const Property& property : all) {
    if (property.name != name) continue;
    outer = &decider(property.when, place);
    any.push_back(met_json(outer->table, property.when, property.when.key));
    Json then = {{"properties", {{name, property.json}}}};
    if (property.is_required) then["required"] = {name};
    outer->conditions.push_back({{"if", any.back()}, {"then", as_seen_from(*outer, place, std::move(then))}});
  }
  outer->conditions.push_back(
      {{"if", {{"anyOf", std::move(any)}}}, {"else", as_seen_from(*outer, place, {{"properties", {{name, false}}}})}});
}

void add_properties(Json& json, Place& place) {
  const std::vector<Property> properties = properties_of(place);
  for (const Property& property : properties) {
    if (json["properties"].contains(property.name)) continue;
    if (property.when.key.empty()) {
      json["properties"][property.name] = property.json;
      if (property.is_required) json["required"].push_back(property.name);
    } else {
      json["properties"][property.name] = {{"description", property.json["description"]}};
      add_conditions(properties, property.name, place);
    }
  }
}

void add_rule(const OneOf& rule, Json& json) {
  Json one_of = Json::array();
  for (const std::string_view key : rule.keys) one_of.push_back({{"required", {key}}});
  json["oneOf"] = std::move(one_of);
}
void add_rule(const Check& rule, Json& json) {
  json["description"] = fmt::format("{} {}", json["description"].get<std::string>(), rule.meaning);
}

Json table_json(const Table& table, Place* around) {
  Place place = {table, around};
  Json json = {{"description", description(table.meaning, table.name)},
               {"type", "object"},
               {"additionalProperties", false},
               {"required", Json::array()},
               {"properties", Json::object()}};
  add_properties(json, place);
  for (const Rule& rule : table.rules) std::visit([&](const auto& each) { add_rule(each, json); }, rule);
  if (!place.conditions.empty()) json["allOf"] = std::move(place.conditions);
  if (table.presence != Presence::list) return json;
  return {{"description", json["description"]}, {"type", "array"}, {"items", std::move(json)}};
}

}  // namespace

Json json_schema(const Format& format) {
  Json json = {{"$schema", "http://json-schema.org/draft-07/schema#"}, {"title", format.title}};
  json.update(table_json(format.root, nullptr));
  const Json id = {{"schema", {{"description", "The format of the file."}, {"const", format.id}}}};
  Json properties = id;
  properties.update(json["properties"]);
  json["properties"] = std::move(properties);
  json["required"].insert(json["required"].begin(), "schema");
  return json;
}

}  // namespace retrace::schema
