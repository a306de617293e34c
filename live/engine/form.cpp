#include "live/engine/form.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "core/error.h"
#include "core/number_format.h"
#include "core/overloaded.h"
#include "core/schema/json.h"
#include "core/toml_file.h"
#include "design/io/design_format.h"

namespace retrace::live {
namespace {

using namespace schema;

void add_range(Json& json, const NumberRange& range) {
  if (std::isfinite(range.low)) {
    json["low"] = range.low;
    json["low_included"] = range.low_included;
  }
  if (std::isfinite(range.high)) {
    json["high"] = range.high;
    json["high_included"] = range.high_included;
  }
}

bool is_bounded(const NumberRange& range) {
  return std::isfinite(range.low) || std::isfinite(range.high);
}

Json list_of(std::string_view kind, const NumberRange& range, std::size_t count = 0) {
  Json json = {{"kind", kind}};
  add_range(json, range);
  if (count > 0) json["count"] = count;
  return json;
}

Json kind_json(const Kind& kind) {
  return std::visit(Overloaded{[](const Number& number) {
                                 return list_of("number",
                                                is_bounded(number.plausible) ? number.plausible : number.range);
                               },
                               [](const Integer& whole) { return list_of("whole", whole.range); },
                               [](const Flag&) {
                                 return Json{{"kind", "flag"}};
                               },
                               [](const Word& word) {
                                 return Json{{"kind", "word"}, {"words", word.words}};
                               },
                               [](const Text&) {
                                 return Json{{"kind", "text"}};
                               },
                               [](const File& file) {
                                 return Json{{"kind", "file"}, {"what", file.what}};
                               },
                               [](const WordOrFile& either) {
                                 return Json{{"kind", "word"}, {"words", either.words}, {"or_file", either.ending}};
                               },
                               [](const NumberOrNumbers& numbers) { return list_of("numbers", numbers.range); },
                               [](const Numbers& numbers) { return list_of("numbers", numbers.range, numbers.count); },
                               [](const Terms& terms) {
                                 return Json{{"kind", "terms"}, {"count", terms.count}};
                               },
                               [](const NumberRows& rows) { return list_of("rows", rows.range, rows.columns); },
                               [](const Pairs& pairs) {
                                 return Json{{"kind", "pairs"}, {"what", pairs.shape}, {"least", pairs.min_count}};
                               },
                               [](const Texts&) {
                                 return Json{{"kind", "texts"}};
                               },
                               [](const TextOrTexts&) {
                                 return Json{{"kind", "texts"}};
                               },
                               [](const Anything&) {
                                 return Json{{"kind", "anything"}};
                               },
                               [](const ByName&) {
                                 return Json{{"kind", "table"}};
                               }},
                    kind);
}

void add_default(Json& json, const Default& otherwise) {
  std::visit(Overloaded{[&](const Required&) { json["required"] = true; }, [](const None&) {},
                        [&](const Computed& computed) { json["otherwise"] = computed.sentence; },
                        [&](std::span<const double> numbers) { json["default"] = numbers; },
                        [&](const auto& value) { json["default"] = value; }},
             otherwise);
}

/// Removes the backslashes that escape "|" in Markdown tables.
std::string plain(std::string_view sentence) {
  std::string text(sentence);
  for (std::size_t at = 0; (at = text.find("\\|", at)) != std::string::npos;) text.erase(at, 1);
  return text;
}

Json row_json(const Row& row, const std::string& around) {
  Json json = {{"path", path_in(around, row.key)}, {"name", row.key}};
  json.update(kind_json(row.kind));
  if (const std::string_view unit = unit_of(row.key); !unit.empty()) json["unit"] = unit;
  add_default(json, row.default_spec);
  json["meaning"] = plain(row.meaning);
  return json;
}

/// Appends a table and its inner tables to `groups`.
/// \param path path of the table; the path of a list ends with "[]", such as "coating.facets[]"
void add_groups(const Table& table, const std::string& path, Json& groups) {
  Json rows = Json::array();
  for (const Row& row : table.rows) rows.push_back(row_json(row, path));
  if (!rows.empty() || table.presence == Presence::list)
    groups.push_back({{"path", path},
                      {"title", table.name},
                      {"meaning", plain(table.meaning)},
                      {"list", table.presence == Presence::list},
                      {"optional", table.presence == Presence::optional || table.presence == Presence::list},
                      {"rows", std::move(rows)}});
  for (const Table& inner : table.tables)
    add_groups(inner, path_in(path, inner.name) + (inner.presence == Presence::list ? "[]" : ""), groups);
}

class Keys {
 public:
  explicit Keys(const Document& document) : document_(document) {}

  void add(const Table& table, const std::string& path) {
    for (std::size_t i = 0; i < table.rows.size(); ++i)
      if (i == 0 || table.rows[i].key != table.rows[i - 1].key) add_key(table, path_in(path, table.rows[i].key));
    for (const Table& inner : table.tables) {
      if (!document_.holds(inner.when, path)) continue;
      const std::string inner_path = path_in(path, inner.name);
      if (inner.presence != Presence::list)
        add(inner, inner_path);
      else
        add_entries(inner, inner_path);
    }
  }

  Json taken() { return std::move(keys_); }

 private:
  void add_key(const Table& table, const std::string& path) {
    const Row* const served = document_.row(path);
    if (served == nullptr) return;
    std::size_t row = 0;
    for (const Row* other = table.rows.data(); other != served; ++other) row += other->key == served->key ? 1U : 0U;
    Json key = {{"path", path}, {"row", row}, {"given", document_.has(path)}};
    if (Json value = to_json(document_.value(path)); !value.is_null()) key["value"] = std::move(value);
    keys_.push_back(std::move(key));
  }

  void add_entries(const Table& list, const std::string& path) {
    const std::size_t count = document_.count(path);
    keys_.push_back({{"path", path}, {"list", true}, {"given", document_.has(path)}, {"entries", count}});
    for (std::size_t i = 0; i < count; ++i) add(list, path_of_entry(path, i));
  }

  const Document& document_;
  Json keys_ = Json::array();
};

}  // namespace

Json form_json() {
  Json groups = Json::array();
  add_groups(design::design_format().root, "", groups);
  return groups;
}

Json keys_json(const Document& document) {
  Keys keys(document);
  keys.add(document.table(), "");
  return keys.taken();
}

std::string toml_of(const Json& value) {
  if (value.is_boolean()) return value.get<bool>() ? "true" : "false";
  if (value.is_number()) return shortest(value.get<double>());
  if (value.is_string()) return toml_text(value.get<std::string>());
  std::vector<std::string> items;
  if (value.is_array()) {
    for (const Json& item : value) items.push_back(toml_of(item));
    return fmt::format("[{}]", fmt::join(items, ", "));
  }
  if (!value.is_object())
    throw InputError("a value must be a number, a text, true, false, a list or a table, got null");
  for (const auto& [name, item] : value.items())
    items.push_back(fmt::format("{} = {}", toml_text(name), toml_of(item)));
  return fmt::format("{{ {} }}", fmt::join(items, ", "));
}

}  // namespace retrace::live
