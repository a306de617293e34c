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

/// Returns a TOML array with one text per line.
std::string lines_text(const std::vector<std::string>& texts) {
  std::string result = "[\n";
  for (const std::string& text : texts) result += "  " + toml_text(text) + ",\n";
  return result + "]";
}

std::string named_text(const Named& named) {
  std::vector<std::string> items;
  for (const auto& [name, value] : named) {
    const double* const number = std::get_if<double>(&value);
    items.push_back(fmt::format("{} = {}", toml_text(name),
                                number != nullptr ? shortest(*number) : toml_text(std::get<std::string>(value))));
  }
  return fmt::format("{{ {} }}", fmt::join(items, ", "));
}

std::string value_text(const Value& value) {
  return std::visit(
      Overloaded{
          [](std::monostate) { return std::string(); }, [](bool flag) { return std::string(flag ? "true" : "false"); },
          [](double number) { return shortest(number); }, [](const std::string& text) { return toml_text(text); },
          [](const std::vector<double>& numbers) { return numbers_text(numbers); },
          [](const std::vector<std::vector<double>>& rows) { return list_text(rows, numbers_text); },
          [](const std::vector<std::string>& texts) { return lines_text(texts); },
          [](const Named& named) { return named_text(named); }},
      value);
}

std::string value_text(const Kind& kind, const Value& value) {
  const auto* const texts = std::get_if<std::vector<std::string>>(&value);
  if (texts == nullptr || !std::holds_alternative<Anything>(kind)) return value_text(value);
  return fmt::format("[{}]", fmt::join(*texts, ", "));
}

/// Writes a table and its inner tables.
class Writer {
 public:
  explicit Writer(const Document& document) : document_(document) {}

  std::string table(const Table& table, const std::string& path) const {
    std::string text;
    for (const std::string& key : keys(table, path)) text += key + "\n";
    for (const Table& inner : table.tables)
      if (inner.layout == Layout::headed) text += tables(inner, path_in(path, inner.name));
    return text;
  }

  /// Returns a table, or all tables of a list, with their headers.
  std::string tables(const Table& inner, const std::string& path) const {
    const bool is_list = inner.presence == Presence::list;
    std::string text;
    for (std::size_t i = 0; i < document_.count(path); ++i) {
      text += is_list ? fmt::format("\n[[{}]]\n", path) : fmt::format("\n[{}]\n", path);
      text += table(inner, is_list ? path_of_entry(path, i) : path);
    }
    return text;
  }

 private:
  /// Returns the texts `key = value` of all given keys of a table.
  std::vector<std::string> keys(const Table& table, const std::string& path) const {
    std::vector<std::string> texts;
    for (const Row& row : table.rows)
      if (const std::string key = path_in(path, row.key); document_.has(key) && document_.row(key) == &row)
        texts.push_back(fmt::format("{} = {}", row.key, value_text(row.kind, document_.value(key))));
    for (const Table& inner : table.tables)
      if (const std::string name = path_in(path, inner.name); inner.layout == Layout::in_line && document_.has(name))
        texts.push_back(fmt::format("{} = {}", inner.name, in_line(inner, name)));
    return texts;
  }

  std::string in_line(const Table& table, const std::string& path) const {
    const auto braces = [&](const std::string& at) {
      return fmt::format("{{ {} }}", fmt::join(keys(table, at), ", "));
    };
    if (table.presence != Presence::list) return braces(path);
    std::string text = "[\n";
    for (std::size_t i = 0; i < document_.count(path); ++i)
      text += fmt::format("  {},\n", braces(path_of_entry(path, i)));
    return text + "]";
  }

  const Document& document_;
};

/// Returns true if a key need not be written because the object has no value for it. If the key has no default, an
/// empty text or list also counts as no value.
bool is_left_out(const Row& row, const Value& value) {
  if (value.index() == 0) return true;
  if (!std::holds_alternative<None>(row.default_spec)) return false;
  const auto* const text = std::get_if<std::string>(&value);
  const auto* const texts = std::get_if<std::vector<std::string>>(&value);
  return (text != nullptr && text->empty()) || (texts != nullptr && texts->empty());
}

Value as_word(const Kind& kind, const Value& value) {
  const Word* const word = std::get_if<Word>(&kind);
  const double* const index = std::get_if<double>(&value);
  if (word == nullptr || index == nullptr) return value;
  return std::string(word->words[static_cast<std::size_t>(*index)]);
}

void add_values(Document& document, const Table& table, const std::string& path, const void* object) {
  for (const Row& row : table.rows) {
    if (!document.holds(row.when, path)) continue;
    Value value = row.access.get(object);
    if (!is_left_out(row, value)) document.set(path_in(path, row.key), as_word(row.kind, value));
  }
  for (const Table& inner : table.tables) {
    const std::string inner_path = path_in(path, inner.name);
    const std::size_t count = document.holds(inner.when, path) ? inner.child.count(object) : 0;
    if (count > 0) document.set(inner_path, {});
    for (std::size_t i = 0; i < count; ++i) {
      const std::string at = inner.presence == Presence::list ? path_of_entry(inner_path, i) : inner_path;
      document.set(at, {});
      add_values(document, inner, at, inner.child.at(object, i));
    }
  }
}

}  // namespace

namespace {

/// Returns true if the value equals the default. A list equals a single default number if all its numbers are equal to
/// this number.
bool is_default(const Value& value, const Row& row) {
  const Value otherwise = default_value(row);
  const auto* const numbers = std::get_if<std::vector<double>>(&value);
  const double* const number = std::get_if<double>(&otherwise);
  if (numbers == nullptr || number == nullptr) return value == otherwise;
  return std::ranges::count(*numbers, *number) == std::ranges::ssize(*numbers);
}

/// Removes all keys of a table that have their default value.
/// \return true if the table still has content
bool drop_defaults(Document& document, const Table& table, const std::string& path) {
  bool is_left = false;
  // Iterate from the last key to the first, because the meaning of a key may depend on keys before it.
  for (auto row = table.rows.rbegin(); row != table.rows.rend(); ++row) {
    const std::string key = path_in(path, row->key);
    if (!document.has(key) || document.row(key) != &*row) continue;
    if (is_default(document.value(key), *row))
      document.drop(key);
    else
      is_left = true;
  }
  for (const Table& inner : table.tables) {
    const std::string name = path_in(path, inner.name);
    if (!document.has(name)) continue;
    const bool is_list = inner.presence == Presence::list;
    if (is_list || drop_defaults(document, inner, name) || inner.presence == Presence::optional)
      is_left = true;
    else
      document.drop(name);
  }
  return is_left;
}

}  // namespace

Document without_defaults(Document document) {
  drop_defaults(document, document.table(), "");
  return document;
}

std::string override_text(std::string_view path, const Value& value) {
  return fmt::format("{}={}", path, value_text(value));
}

std::string document_text(const Format& format, const Document& document) {
  return fmt::format("schema = {}\n", toml_text(format.id)) + Writer(document).table(format.root, "");
}

Document document_of(const Format& format, const void* object) {
  Document document(format.root);
  add_values(document, format.root, "", object);
  return document;
}

std::string object_text(const Format& format, const void* object) {
  return document_text(format, document_of(format, object));
}

}  // namespace retrace::schema
