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

/// Returns the regular expression for texts with the given ending.
std::string ends_in(std::string_view ending) {
  return fmt::format("\\{}$", ending);
}

Json texts_json() {
  return {{"type", "array"}, {"items", {{"type", "string"}}}, {"minItems", 1}};
}

/// Returns the schema of a key whose value is a word. Current and former words are allowed.
Json word_json(const Word& word) {
  Json words(word.words);
  for (const FormerWord& each : word.former) words.push_back(each.former);
  return {{"type", "string"}, {"enum", std::move(words)}};
}

Json named_json(const ByName& named) {
  const Json each = std::visit(Overloaded{[](const Number& number) { return number_json(number.range); },
                                          [](const Word& word) { return word_json(word); }},
                               named.each);
  Json json = {{"type", "object"}, {"minProperties", 1}, {"additionalProperties", each}};
  if (named.names.empty()) return json;
  json["additionalProperties"] = false;
  json["required"] = named.names;
  for (const std::string_view name : named.names) json["properties"][name] = each;
  return json;
}

Json kind_json(const Kind& kind) {
  return std::visit(
      Overloaded{[](const Number& number) {
                   Json json = number_json(number.plausible);
                   const Json range = number_json(number.range);
                   return json.size() > 1 ? json : range;
                 },
                 [](const Integer& whole) { return number_json(whole.range, "integer"); },
                 [](const Flag&) {
                   return Json{{"type", "boolean"}};
                 },
                 [](const Word& word) { return word_json(word); },
                 [](const Text&) {
                   return Json{{"type", "string"}};
                 },
                 [](const File& file) {
                   return Json{{"type", "string"}, {"minLength", 1}, {"title", file.what}};
                 },
                 [](const WordOrFile& either) {
                   return Json{{"anyOf",
                                {{{"enum", either.words}}, {{"type", "string"}, {"pattern", ends_in(either.ending)}}}}};
                 },
                 [](const NumberOrNumbers& list) {
                   const Json number = number_json(list.range, list.is_integer ? "integer" : "number");
                   Json items = {{"type", "array"}, {"items", number}, {"minItems", 1}};
                   return Json{{"anyOf", {number, std::move(items)}}};
                 },
                 [](const Pairs& pairs) {
                   Json pair = {{"type", "array"},
                                {"items", {number_json(pairs.first), number_json(pairs.second)}},
                                {"minItems", 2},
                                {"maxItems", 2}};
                   return Json{{"type", "array"}, {"items", std::move(pair)}, {"minItems", pairs.min_count}};
                 },
                 [](const Numbers& list) { return list_json(number_json(list.range), list.count, list.count); },
                 [](const Terms& terms) {
                   return Json{{"type", "array"}, {"items", {{"type", "number"}}}, {"minItems", terms.count}};
                 },
                 [](const NumberRows& rows) {
                   return list_json(list_json(number_json(rows.range), rows.columns, rows.columns), rows.min_rows,
                                    rows.max_rows);
                 },
                 [](const Texts&) { return texts_json(); },
                 [](const TextOrTexts&) {
                   return Json{{"anyOf", {{{"type", "string"}}, texts_json()}}};
                 },
                 [](const Anything&) {
                   return Json{{"type", "array"}, {"minItems", 1}};
                 },
                 [](const ByName& named) { return named_json(named); }},
      kind);
}

/// Returns the default of a key as JSON, or null if there is none.
Json default_json(const Default& otherwise) {
  return std::visit(
      Overloaded{[](const Required&) { return Json(); }, [](const None&) { return Json(); },
                 [](const Computed&) { return Json(); }, [](std::span<const double> numbers) { return Json(numbers); },
                 [](const auto& value) { return Json(value); }},
      otherwise);
}

std::string description(std::string_view meaning, std::string_view name) {
  std::string text(meaning);
  // Removes the escapes that Markdown tables need.
  for (std::size_t at = 0; (at = text.find("\\|", at)) != std::string::npos;) text.erase(at, 1);
  const std::string_view unit = unit_of(name);
  return unit.empty() ? text : fmt::format("{} In {}.", text, unit);
}

Json row_json(const Row& row) {
  Json json = {{"description", description(row.meaning, row.key)}};
  if (const auto* const computed = std::get_if<Computed>(&row.default_spec))
    json["description"] = fmt::format("{} By default: {}.", json["description"].get<std::string>(), computed->sentence);
  json.update(kind_json(row.kind));
  if (Json value = default_json(row.default_spec); !value.is_null()) json["default"] = std::move(value);
  return json;
}

/// Table that is being traversed, or a table that contains it. `conditions` collects the parts of the schema that
/// depend on keys of the table.
struct Place {
  const Table& table;
  Place* around;
  Json conditions = Json::array();
};

/// Returns true if a condition may hold when its key is not given. If the rows (descriptions) of the key have different
/// defaults, the schema cannot decide whether the condition holds. The result is then true, and the reader of the
/// format checks the condition.
bool holds_by_default(const Condition& condition, const Table& table, std::string_view key) {
  using Is = Condition::Is;
  if (condition.is == Is::given || condition.is == Is::absent) return condition.is == Is::absent;
  const auto is_one = [&](const Row& row) {
    const auto* const word = std::get_if<std::string_view>(&row.default_spec);
    return row.key == key && word != nullptr && std::ranges::count(condition.words, *word) > 0;
  };
  const auto is_other = [&](const Row& row) { return row.key == key && !is_one(row); };
  return condition.is == Is::one_of ? std::ranges::none_of(table.rows, is_other)
                                    : std::ranges::any_of(table.rows, is_other);
}

/// Returns the schema that the value of a condition's key must match for the condition to hold.
Json met_value(const Condition& condition) {
  using Is = Condition::Is;
  if (condition.is == Is::given) return Json::object();
  if (condition.is == Is::absent) return false;
  Json words = {{"enum", condition.words}};
  return condition.is == Is::one_of ? words : Json{{"not", std::move(words)}};
}

/// Returns the schema that a table must match for a condition on one of its keys to hold. The key may be in a table
/// within this table. Returns null if there is no such key.
Json met_json(const Table& table, const Condition& condition, std::string_view key) {
  const std::string_view first = key.substr(0, key.find('.'));
  const auto inner = std::ranges::find(table.tables, first, &Table::name);
  Json value;
  bool by_default = true;
  if (first == key && (std::ranges::count(table.rows, key, &Row::key) > 0 || inner != table.tables.end())) {
    value = met_value(condition);
    by_default = holds_by_default(condition, table, key);
  } else if (first != key && inner != table.tables.end()) {
    value = met_json(*inner, condition, key.substr(first.size() + 1));
    by_default = value.is_null() || !value.contains("required");
  }
  if (value.is_null()) return nullptr;
  Json json = {{"properties", {{first, std::move(value)}}}};
  if (!by_default) json["required"] = {first};
  return json;
}

/// Returns the innermost table that contains the keys of all conditions.
/// \param from table at which the search begins; the search then proceeds to the tables that contain it
/// \throw std::logic_error if there is no such table
Place& decider(When when, Place& from) {
  for (Place* place = &from; place != nullptr; place = place->around)
    if (std::ranges::none_of(when, [&](const Condition& c) { return met_json(place->table, c, c.key).is_null(); }))
      return *place;
  throw std::logic_error("no table decides the conditions on " + std::string(when.front().key));
}

/// Returns the schema that a table must match for all conditions to hold.
Json all_met(const Table& table, When when) {
  Json all = Json::array();
  for (const Condition& condition : when) all.push_back(met_json(table, condition, condition.key));
  return all.size() == 1 ? Json(std::move(all.front())) : Json{{"allOf", std::move(all)}};
}

/// Converts a schema for the table `inner` to a schema for the table `outer` that contains it.
Json as_seen_from(const Place& outer, const Place& inner, Json json) {
  for (const Place* place = &inner; place != &outer; place = place->around) {
    if (place->table.presence == Presence::list) json = {{"items", std::move(json)}};
    json = {{"properties", {{place->table.name, std::move(json)}}}};
  }
  return json;
}

/// A key or an inner table of a table.
struct Property {
  std::string_view name;
  Json json;
  bool is_required;
  When when;
  bool zero_is_none;
  std::string_view former;  ///< former name, or empty
};

Json table_json(const Table& table, Place* around);

void add_meaning(std::string_view meaning, Json& json) {
  json["description"] = fmt::format("{} {}", json["description"].get<std::string>(), meaning);
}

/// Appends all rules that involve a key to the description of this key. The rules of its table and of all outer tables
/// are considered.
void add_ties(const Place& place, std::string_view key, Json& json) {
  std::string path(key);
  for (const Place* at = &place; at != nullptr; at = at->around) {
    for (const Rule& rule : at->table.rules)
      std::visit(
          [&](const auto& each) {
            if constexpr (requires { each.meaning; })
              if (std::ranges::count(each.keys, std::string_view(path)) > 0) add_meaning(each.meaning, json);
          },
          rule);
    path = path_in(at->table.name, path);
  }
}

/// Returns the properties of a table. Rows of a key that differ only in the type of the value form one property.
std::vector<Property> properties_of(Place& place) {
  std::vector<Property> properties;
  const Row* last = nullptr;
  for (const Row& row : place.table.rows) {
    if (last != nullptr && last->key == row.key && last->when.data() == row.when.data()) {
      Json forms = Json::array({kind_json(last->kind), kind_json(row.kind)});
      properties.back().json = {{"description", properties.back().json["description"]}, {"anyOf", std::move(forms)}};
    } else {
      properties.push_back({row.key, row_json(row), std::holds_alternative<Required>(row.default_spec), row.when,
                            row.zero_is_none, row.former});
    }
    last = &row;
  }
  for (const Table& inner : place.table.tables)
    properties.push_back(
        {inner.name, table_json(inner, &place), inner.presence == Presence::always, inner.when, false, inner.former});
  for (Property& property : properties) add_ties(place, property.name, property.json);
  return properties;
}

/// Returns the schema of a table that contains a key or table under its name or its former name.
Json contains_json(std::string_view name, std::string_view former) {
  Json current = {{"required", {name}}};
  return former.empty() ? current : Json{{"anyOf", {std::move(current), {{"required", {former}}}}}};
}

/// Returns the former name of a key or table, or an empty text.
std::string_view former_name(const Table& table, std::string_view name) {
  for (const Row& row : table.rows)
    if (row.key == name) return row.former;
  for (const Table& inner : table.tables)
    if (inner.name == name) return inner.former;
  return {};
}

/// Adds the conditional schema of a key to the table that contains the keys of its conditions. The key is refused if
/// none of its rows has conditions that hold.
void add_conditions(const std::vector<Property>& all, std::string_view name, Place& place) {
  Json any = Json::array();
  Place* outer = nullptr;
  Json refusal = false;
  for (const Property& property : all) {
    if (property.name != name) continue;
    outer = &decider(property.when, place);
    any.push_back(all_met(outer->table, property.when));
    if (property.zero_is_none) refusal = {{"const", 0}};
    Json then = {{"properties", {{name, property.json}}}};
    if (property.is_required) then.update(contains_json(name, property.former));
    outer->conditions.push_back({{"if", any.back()}, {"then", as_seen_from(*outer, place, std::move(then))}});
  }
  outer->conditions.push_back({{"if", {{"anyOf", std::move(any)}}},
                               {"else", as_seen_from(*outer, place, {{"properties", {{name, refusal}}}})}});
}

void add_properties(Json& json, Place& place) {
  const std::vector<Property> properties = properties_of(place);
  for (const Property& property : properties) {
    if (json["properties"].contains(property.name)) continue;
    if (!property.former.empty())
      json["properties"][property.former] = {{"description", fmt::format("Former name of {}.", property.name)},
                                             {"deprecated", true}};
    if (property.when.empty()) {
      json["properties"][property.name] = property.json;
      if (property.is_required && property.former.empty()) json["required"].push_back(property.name);
      if (property.is_required && !property.former.empty())
        place.conditions.push_back(contains_json(property.name, property.former));
    } else {
      json["properties"][property.name] = {{"description", property.json["description"]}};
      add_conditions(properties, property.name, place);
    }
  }
}

void add_rule(const OneOf& rule, const Table& table, Json& json) {
  Json one_of = Json::array();
  for (const std::string_view key : rule.keys) one_of.push_back(contains_json(key, former_name(table, key)));
  json["oneOf"] = std::move(one_of);
}
/// Adds a rule about a whole table to the description of this table. Rules about single keys are added to the
/// descriptions of these keys instead.
void add_rule(const Check& rule, const Table&, Json& json) {
  if (rule.keys.empty()) add_meaning(rule.meaning, json);
}
void add_rule(const Precedence&, const Table&, Json&) {}

Json table_json(const Table& table, Place* around) {
  Place place = {table, around};
  Json json = {{"description", description(table.meaning, table.name)},
               {"type", "object"},
               {"additionalProperties", false},
               {"required", Json::array()},
               {"properties", Json::object()}};
  add_properties(json, place);
  for (const Rule& rule : table.rules) std::visit([&](const auto& each) { add_rule(each, table, json); }, rule);
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
  if (!format.id_is_optional) json["required"].insert(json["required"].begin(), "schema");
  return json;
}

}  // namespace retrace::schema
