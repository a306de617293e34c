#include "core/schema/writer.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "core/number_format.h"
#include "core/overloaded.h"
#include "core/toml_file.h"

namespace retrace::schema {
namespace {

template <class List, class Text>
std::string list_text(const List& list, Text text) {
  std::vector<std::string> items;
  for (const auto& item : list) items.push_back(text(item));
  return fmt::format("[{}]", fmt::join(items, ", "));
}

std::string numbers_text(const std::vector<double>& numbers) {
  return list_text(numbers, shortest);
}

/// One text a line.
std::string lines_text(const std::vector<std::string>& texts) {
  std::string result = "[\n";
  for (const std::string& text : texts) result += "  " + toml_text(text) + ",\n";
  return result + "]";
}

std::string value_text(const Value& value, const Kind& kind) {
  const Word* const word = std::get_if<Word>(&kind);
  return std::visit(
      Overloaded{[](std::monostate) { return std::string(); },
                 [](bool flag) { return std::string(flag ? "true" : "false"); },
                 [&](double number) {
                   return word ? toml_text(word->words[static_cast<std::size_t>(number)]) : shortest(number);
                 },
                 [](const std::string& text) { return toml_text(text); },
                 [](const std::vector<double>& numbers) { return numbers_text(numbers); },
                 [](const std::vector<std::vector<double>>& rows) { return list_text(rows, numbers_text); },
                 [](const std::vector<std::string>& texts) { return lines_text(texts); }},
      value);
}

/// An empty text or list stands for a key that is not given, if that means nothing else.
bool is_left_out(const Row& row, const Value& value) {
  if (value.index() == 0) return true;
  if (!std::holds_alternative<None>(row.otherwise)) return false;
  const auto* const text = std::get_if<std::string>(&value);
  const auto* const texts = std::get_if<std::vector<std::string>>(&value);
  return (text != nullptr && text->empty()) || (texts != nullptr && texts->empty());
}

/// The keys of a table, each `key = value`.
std::vector<std::string> key_texts(const Level& level) {
  std::vector<std::string> texts;
  for (const Row& row : level.table.rows) {
    if (!holds(row.when, level)) continue;
    const Value value = row.access.get(level.object);
    if (!is_left_out(row, value)) texts.push_back(fmt::format("{} = {}", row.key, value_text(value, row.kind)));
  }
  for (const Table& inner : level.table.tables)
    if (inner.layout == Layout::in_line && holds(inner.when, level) && inner.child.count(level.object) > 0)
      texts.push_back(fmt::format("{} = {{ {} }}", inner.name,
                                  fmt::join(key_texts({inner, inner.child.at(level.object, 0), &level}), ", ")));
  return texts;
}

std::string level_text(const Level& level, const std::string& path);

std::string children_text(const Table& table, const Level& around, const std::string& path) {
  const std::string name = path.empty() ? std::string(table.name) : fmt::format("{}.{}", path, table.name);
  const bool is_list = table.presence == Presence::list;
  std::string text;
  for (std::size_t i = 0; i < table.child.count(around.object); ++i) {
    text += is_list ? fmt::format("\n[[{}]]\n", name) : fmt::format("\n[{}]\n", name);
    text += level_text({table, table.child.at(around.object, i), &around}, name);
  }
  return text;
}

std::string level_text(const Level& level, const std::string& path) {
  std::string text;
  for (const std::string& key : key_texts(level)) text += key + "\n";
  for (const Table& inner : level.table.tables)
    if (inner.layout == Layout::headed && holds(inner.when, level)) text += children_text(inner, level, path);
  return text;
}

}  // namespace

std::string table_text(const Table& table, const void* object) {
  const std::string head = table.name.empty() ? "" : fmt::format("\n[{}]\n", table.name);
  return head + level_text({table, object}, std::string(table.name));
}

std::string document_text(const Format& format, const void* object) {
  return fmt::format("schema = {}\n", toml_text(format.id)) + table_text(format.root, object);
}

}  // namespace retrace::schema
