#include "core/toml_file.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "core/atomic_file.h"
#include "core/io/toml_node.h"
#include "core/message_text.h"
#include "core/number_format.h"

namespace retrace {
namespace {

/// toml++ recurses once per level of a tree when it destroys it: dotted keys could make more of them than the stack
/// holds. No line needs as many dots.
constexpr std::size_t kMostDotsInALine = 64;

void check_nesting(std::string_view text, const std::string& file) {
  int line = 1;
  std::size_t dots = 0;
  for (const char c : text) {
    if (c == '\n') {
      ++line;
      dots = 0;
    }
    if (c == '.' && ++dots > kMostDotsInALine)
      throw InputError({file, line, ""}, fmt::format("a line may have at most {} dots", kMostDotsInALine));
  }
}

}  // namespace

std::string shown(const toml::node& node) {
  if (const auto* text = node.as_string()) return in_quotes(text->get());
  if (const auto* integer = node.as_integer()) return fmt::format("{}", integer->get());
  if (const auto* number = node.as_floating_point())
    return std::isfinite(number->get()) ? shortest(number->get()) : fmt::format("{}", number->get());
  if (const auto* flag = node.as_boolean()) return flag->get() ? "true" : "false";
  if (const auto* list = node.as_array()) return list->empty() ? "an empty list" : "a list";
  return node.is_table() ? "a table" : "a date or time";
}

/// A table that knows its file and its name. The root keeps the tree alive.
struct TomlTable::Hidden {
  std::shared_ptr<const toml::table> tree;
  const toml::table* table = nullptr;  ///< null: there is no such table
  std::string file;
  std::string name;  ///< empty at top level
  int line = 0;      ///< of the table's head; 0: not known
  std::set<std::string, std::less<>> taken;
  std::vector<TomlTable> handed_out;

  const toml::node* find(std::string_view key) const { return table != nullptr ? table->get(key) : nullptr; }
  const toml::node* take(std::string_view key) {
    taken.emplace(key);
    return find(key);
  }
  std::string full_name(std::string_view key) const {
    return name.empty() ? printable(key) : name + "." + printable(key);
  }
  InputLocation location(const toml::node& node, std::string_view key) const {
    return {file, static_cast<int>(node.source().begin.line), full_name(key)};
  }

  double checked(std::string_view key, const toml::node& node, const NumberRange& range) const {
    const auto refuse = [&](const std::string& allowed) -> InputError {
      return {location(node, key), fmt::format("must be {}, got {}", allowed, shown(node))};
    };
    if (!node.is_number()) throw refuse("a number");
    const auto* integer = node.as_integer();
    const double value = integer != nullptr ? static_cast<double>(integer->get()) : node.as_floating_point()->get();
    if (!std::isfinite(value)) throw refuse("a finite number");
    if (!range.contains(value)) throw refuse(range.text());
    return value;
  }

  TomlTable child(const toml::table* inner, std::string inner_name, int inner_line) {
    auto hidden = std::make_shared<Hidden>();
    hidden->tree = tree;
    hidden->table = inner;
    hidden->file = file;
    hidden->name = std::move(inner_name);
    hidden->line = inner_line;
    handed_out.emplace_back(std::move(hidden));
    return handed_out.back();
  }
};

TomlTable::TomlTable(std::shared_ptr<Hidden> hidden) : hidden_(std::move(hidden)) {}

bool TomlTable::exists() const {
  return hidden_->table != nullptr;
}

bool TomlTable::has(std::string_view key) const {
  return hidden_->find(key) != nullptr;
}

InputLocation TomlTable::where() const {
  return {hidden_->file, hidden_->line, hidden_->name};
}

InputLocation TomlTable::where(std::string_view key) const {
  const toml::node* const node = hidden_->find(key);
  return node != nullptr ? hidden_->location(*node, key)
                         : InputLocation{hidden_->file, hidden_->line, hidden_->full_name(key)};
}

void TomlTable::fail(std::string_view key, std::string_view text) const {
  throw InputError(where(key), text);
}

std::optional<double> TomlTable::number(std::string_view key, const NumberRange& range) {
  const toml::node* const node = hidden_->take(key);
  return node != nullptr ? std::optional(hidden_->checked(key, *node, range)) : std::nullopt;
}

double TomlTable::required_number(std::string_view key, const NumberRange& range) {
  const std::optional<double> value = number(key, range);
  if (!value) fail(key, "missing, must be " + range.text());
  return *value;
}

std::optional<std::vector<double>> TomlTable::numbers(std::string_view key, std::size_t count,
                                                      const NumberRange& range) {
  const toml::node* const node = hidden_->take(key);
  if (node == nullptr) return std::nullopt;
  const toml::array* const list = node->as_array();
  if (list == nullptr || list->size() != count)
    fail(key, fmt::format("must be a list of {} numbers, got {}", count,
                          list != nullptr ? fmt::format("{} of them", list->size()) : shown(*node)));
  std::vector<double> values;
  for (const toml::node& item : *list) values.push_back(hidden_->checked(key, item, range));
  return values;
}

std::vector<double> TomlTable::required_numbers(std::string_view key, std::size_t count, const NumberRange& range) {
  auto values = numbers(key, count, range);
  if (!values) fail(key, fmt::format("missing, must be a list of {} numbers", count));
  return *std::move(values);
}

std::optional<std::vector<std::vector<double>>> TomlTable::number_rows(std::string_view key, std::size_t columns,
                                                                       const NumberRange& range) {
  const toml::node* const node = hidden_->take(key);
  if (node == nullptr) return std::nullopt;
  const std::string allowed = fmt::format("must be a list of lists of {} numbers", columns);
  const toml::array* const list = node->as_array();
  if (list == nullptr) fail(key, allowed + ", got " + shown(*node));
  std::vector<std::vector<double>> rows;
  for (const toml::node& item : *list) {
    const toml::array* const row = item.as_array();
    if (row == nullptr || row->size() != columns)
      fail(key,
           fmt::format("{}, got {}", allowed, row != nullptr ? fmt::format("one of {}", row->size()) : shown(item)));
    rows.emplace_back();
    for (const toml::node& value : *row) rows.back().push_back(hidden_->checked(key, value, range));
  }
  return rows;
}

std::vector<std::vector<double>> TomlTable::required_number_rows(std::string_view key, std::size_t columns,
                                                                 const NumberRange& range) {
  auto rows = number_rows(key, columns, range);
  if (!rows) fail(key, fmt::format("missing, must be a list of lists of {} numbers", columns));
  return *std::move(rows);
}

std::optional<long long> TomlTable::whole(std::string_view key, const NumberRange& range) {
  const std::optional<double> value = number(key, range);
  if (!value) return std::nullopt;
  if (*value != std::floor(*value)) fail(key, "must be a whole number, got " + shortest(*value));
  return static_cast<long long>(*value);
}

std::optional<bool> TomlTable::flag(std::string_view key) {
  const toml::node* const node = hidden_->take(key);
  if (node == nullptr) return std::nullopt;
  if (!node->is_boolean()) fail(key, "must be true or false, got " + shown(*node));
  return node->as_boolean()->get();
}

std::optional<std::string> TomlTable::text(std::string_view key) {
  const toml::node* const node = hidden_->take(key);
  if (node == nullptr) return std::nullopt;
  if (!node->is_string()) fail(key, "must be a string, got " + shown(*node));
  return node->as_string()->get();
}

std::string TomlTable::required_text(std::string_view key) {
  auto value = text(key);
  if (!value) fail(key, "missing, must be a string");
  return *std::move(value);
}

std::optional<std::vector<std::string>> TomlTable::texts(std::string_view key) {
  const toml::node* const node = hidden_->take(key);
  if (node == nullptr) return std::nullopt;
  const toml::array* const list = node->as_array();
  if (list == nullptr || list->empty()) fail(key, "must be a list of one or more strings, got " + shown(*node));
  std::vector<std::string> values;
  for (const toml::node& item : *list) {
    if (!item.is_string())
      throw InputError(hidden_->location(item, key), "must be a list of strings, got " + shown(item) + " in it");
    values.push_back(item.as_string()->get());
  }
  return values;
}

std::optional<std::size_t> TomlTable::choice(std::string_view key, std::span<const std::string_view> words) {
  const std::optional<std::string> given = text(key);
  if (!given) return std::nullopt;
  const auto found = std::find(words.begin(), words.end(), *given);
  if (found != words.end()) return static_cast<std::size_t>(found - words.begin());
  std::string message = fmt::format("must be {}, got {}", alternatives(words), in_quotes(*given));
  const std::string_view meant = closest(*given, words);
  if (!meant.empty() && words.size() > 1) message += fmt::format("; did you mean {}?", in_quotes(meant));
  fail(key, message);
}

std::size_t TomlTable::required_choice(std::string_view key, std::span<const std::string_view> words) {
  const auto index = choice(key, words);
  if (!index) fail(key, "missing, must be " + alternatives(words));
  return *index;
}

TomlTable TomlTable::table(std::string_view key) {
  const toml::node* const node = hidden_->take(key);
  if (node == nullptr) return hidden_->child(nullptr, hidden_->full_name(key), hidden_->line);
  if (!node->is_table()) fail(key, "must be a table, got " + shown(*node));
  return hidden_->child(node->as_table(), hidden_->full_name(key), static_cast<int>(node->source().begin.line));
}

TomlTable TomlTable::required_table(std::string_view key) {
  if (!has(key)) fail(key, "missing, must be a table");
  return table(key);
}

std::vector<TomlTable> TomlTable::tables(std::string_view key) {
  const toml::node* const node = hidden_->take(key);
  if (node == nullptr) return {};
  const toml::array* const list = node->as_array();
  if (list == nullptr) fail(key, "must be tables, got " + shown(*node));
  std::vector<TomlTable> result;
  for (const toml::node& item : *list) {
    if (!item.is_table())
      throw InputError(hidden_->location(item, key), "must be tables, got " + shown(item) + " in it");
    result.push_back(
        hidden_->child(item.as_table(), hidden_->full_name(key), static_cast<int>(item.source().begin.line)));
  }
  return result;
}

void TomlTable::finish() const {
  if (hidden_->table != nullptr) {
    const toml::node* first = nullptr;
    std::string_view first_key;
    for (auto&& [key, node] : *hidden_->table) {
      if (hidden_->taken.contains(key.str())) continue;
      if (first != nullptr && first->source().begin.line <= node.source().begin.line) continue;
      first = &node;
      first_key = key.str();
    }
    if (first != nullptr) {
      const std::vector<std::string_view> known(hidden_->taken.begin(), hidden_->taken.end());
      const std::string_view meant = closest(first_key, known);
      fail(first_key, fmt::format("unknown {}{}", first->is_table() ? "table" : "key",
                                  meant.empty() ? " (known: " + fmt::format("{}", fmt::join(known, ", ")) + ")"
                                                : ", did you mean " + in_quotes(meant) + "?"));
    }
  }
  for (const TomlTable& table : hidden_->handed_out) table.finish();
}

TomlTable parse_toml(std::string_view text, const std::string& source_name) {
  const std::string file = printable(source_name, std::string::npos);
  require_short_text(text, file, kMostTextBytes);
  check_nesting(text, file);
  auto hidden = std::make_shared<TomlTable::Hidden>();
  try {
    hidden->tree = std::make_shared<const toml::table>(toml::parse(text, std::string_view(file)));
  } catch (const toml::parse_error& error) {
    throw InputError({file, static_cast<int>(error.source().begin.line), ""},
                     "not valid TOML: " + printable(error.description(), 300));
  }
  hidden->table = hidden->tree.get();
  hidden->file = file;
  return TomlTable(std::move(hidden));
}

std::string toml_text(std::string_view text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      result += '\\';
      result += c;
    } else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) {
      result += fmt::format("\\u{:04X}", static_cast<unsigned>(static_cast<unsigned char>(c)));
    } else {
      result += c;
    }
  }
  return result + '"';
}

}  // namespace retrace
