#include "studies/design/table_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/io/toml_node.h"
#include "core/message_text.h"
#include "core/number_format.h"

namespace retrace::studies {

TableReader::TableReader(const DesignDocument& document, std::string_view name)
    : document_(document),
      name_(name),
      table_(name.empty() ? &document.root() : document.root().get_as<toml::table>(name)) {}

TableReader::TableReader(const DesignDocument& document, std::string name, const toml::table& table)
    : document_(document), name_(std::move(name)), table_(&table) {}

const toml::node* TableReader::find(std::string_view key) const {
  return table_ != nullptr ? table_->get(key) : nullptr;
}

const toml::node* TableReader::take(std::string_view key) {
  taken_.emplace(key);
  return find(key);
}

std::string TableReader::full_name(std::string_view key) const {
  return name_.empty() ? printable(key) : name_ + "." + printable(key);
}

InputLocation TableReader::where(std::string_view key) const {
  const toml::node* const node = find(key);
  return node != nullptr ? document_.location(*node, full_name(key))
                         : document_.location_of_missing(table_, full_name(key));
}

void TableReader::fail(std::string_view key, std::string_view text) const {
  throw InputError(where(key), text);
}

void TableReader::fail_missing(std::string_view key, std::string_view allowed) const {
  fail(key, fmt::format("missing, must be {}", allowed));
}

double TableReader::checked_number(std::string_view key, const toml::node& node, const Range& range) const {
  std::optional<double> value = node.value<double>();
  // An integer of more than 53 bits is still a number, to be judged by its range.
  if (const auto* integer = node.as_integer()) value = static_cast<double>(integer->get());
  if (!node.is_number()) value.reset();
  const auto refuse = [&](const std::string& allowed) -> InputError {
    return {document_.location(node, full_name(key)), fmt::format("must be {}, got {}", allowed, shown(node))};
  };
  if (!value) throw refuse("a number");
  if (!std::isfinite(*value)) throw refuse("a finite number");
  if (!range.contains(*value)) throw refuse(range.text());
  return *value;
}

std::optional<double> TableReader::number(std::string_view key, const Range& range) {
  const toml::node* const node = take(key);
  return node != nullptr ? std::optional<double>(checked_number(key, *node, range)) : std::nullopt;
}

double TableReader::required_number(std::string_view key, const Range& range) {
  const std::optional<double> value = number(key, range);
  if (!value) fail_missing(key, range.text());
  return *value;
}

std::optional<std::vector<double>> TableReader::numbers(std::string_view key, const Range& range) {
  const toml::node* const node = take(key);
  if (node == nullptr) return std::nullopt;
  const toml::array* const list = node->as_array();
  if (list == nullptr && !node->is_number())
    fail(key, fmt::format("must be a number or a list of numbers, got {}", shown(*node)));
  if (list == nullptr) return std::vector<double>{checked_number(key, *node, range)};
  if (list->empty()) fail(key, "must be a number or a list of at least one number, got an empty list");
  std::vector<double> values;
  for (const toml::node& item : *list) values.push_back(checked_number(key, item, range));
  return values;
}

std::vector<std::array<double, 2>> TableReader::number_pairs(std::string_view key, std::string_view shape,
                                                             const Range& first, const Range& second) {
  const toml::array& list = *take(key)->as_array();
  const auto refuse = [&](const toml::node& node, const std::string& given) -> InputError {
    return {document_.location(node, full_name(key)), fmt::format("must be a list of {}, got {}", shape, given)};
  };
  if (list.empty()) throw refuse(list, shown(list));
  std::vector<std::array<double, 2>> pairs;
  for (const toml::node& node : list) {
    const toml::array* const pair = node.as_array();
    if (pair == nullptr) throw refuse(node, fmt::format("{} in it", shown(node)));
    if (pair->size() != 2) throw refuse(node, fmt::format("a list of {} in it", pair->size()));
    pairs.push_back({checked_number(key, *pair->get(0), first), checked_number(key, *pair->get(1), second)});
  }
  return pairs;
}

bool TableReader::is_text(std::string_view key) const {
  const toml::node* const node = find(key);
  return node != nullptr && node->is_string();
}

std::string TableReader::shown_value(std::string_view key) const {
  return shown(*find(key));
}

std::optional<std::size_t> TableReader::list_size(std::string_view key) const {
  const toml::node* const node = find(key);
  return node != nullptr && node->is_array() ? std::optional(node->as_array()->size()) : std::nullopt;
}

std::optional<std::string> TableReader::text(std::string_view key) {
  return text_or(key, "");
}

std::optional<std::filesystem::path> TableReader::file(std::string_view key) {
  const std::optional<std::string> given = text(key);
  if (!given) return std::nullopt;
  // A byte 0 would end the name for the system alone.
  if (given->empty() || given->find('\0') != std::string::npos)
    fail(key, fmt::format("must name a file, got {}", in_quotes(*given)));
  document_.add_file(document_.folder(*find(key)) / *given);
  return document_.files().back();
}

std::optional<std::string> TableReader::text_or(std::string_view key, std::string_view or_else) {
  const toml::node* const node = take(key);
  if (node == nullptr) return std::nullopt;
  if (!node->is_string()) fail(key, fmt::format("must be a string{}, got {}", or_else, shown(*node)));
  return node->as_string()->get();
}

std::string TableReader::choice_text(std::span<const std::string_view> names) {
  return (names.size() > 1 ? "one of " : "") + alternatives(names);
}

std::optional<std::size_t> TableReader::choice_index(std::string_view key, std::span<const std::string_view> names,
                                                     std::string_view or_else) {
  const std::optional<std::string> given = text_or(key, or_else);
  if (!given) return std::nullopt;
  const auto found = std::find(names.begin(), names.end(), *given);
  if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
  std::string message = fmt::format("must be {}{}, got {}", choice_text(names), or_else, in_quotes(*given));
  const std::string_view meant = closest(*given, names);
  if (!meant.empty() && names.size() > 1) message += fmt::format("; did you mean {}?", in_quotes(meant));
  fail(key, message);
}

void TableReader::refuse(std::initializer_list<std::string_view> keys, std::string_view why) {
  for (const std::string_view key : keys)
    if (const toml::node* const node = take(key)) fail(key, fmt::format("{}, got {}", why, shown(*node)));
}

void TableReader::refuse_unless_zero(std::initializer_list<std::string_view> keys, std::string_view why) {
  for (const std::string_view key : keys)
    if (number(key, Range{}).value_or(0.0) != 0.0) fail(key, fmt::format("{}, got {}", why, shown(*find(key))));
}

void TableReader::finish() const {
  if (table_ == nullptr) return;
  const toml::node* first = nullptr;
  std::string_view first_key;
  for (auto&& [key, node] : *table_) {
    if (taken_.contains(key.str())) continue;
    if (first != nullptr && document_.position(*first) <= document_.position(node)) continue;
    first = &node;
    first_key = key.str();
  }
  if (first != nullptr) fail(first_key, "has no meaning in this design");
}

}  // namespace retrace::studies
