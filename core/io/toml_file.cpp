#include "core/toml_file.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>

#include "core/atomic_file.h"
#include "core/message_text.h"
#include "core/number_format.h"
#include "core/text.h"

namespace retrace {
namespace {

/// Maximum number of dots in a line. Decimal points are not counted. toml++ destroys a tree recursively, so very long
/// dotted keys could exceed the stack.
constexpr std::size_t kMaxDotsPerLine = 64;
constexpr std::size_t kLongestOverride = 4096;
constexpr std::string_view kBareKeyCharacters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-.";

/// Returns true if the dot at position `i` is the decimal point of a number. Between the dot and the nearest
/// delimiters, such as blanks, commas or an exponent, there may be only digits.
bool is_decimal_point(std::string_view text, std::size_t i) {
  constexpr std::string_view digits = "0123456789_";
  const std::size_t before = text.find_last_not_of(digits, i == 0 ? 0 : i - 1);
  const std::size_t after = text.find_first_not_of(digits, i + 1);
  constexpr std::string_view begins = " \t\n[,=+-";
  constexpr std::string_view ends = " \t\r\n],}#eE";
  return i > 0 && before + 1 != i && before != std::string_view::npos &&
         begins.find(text[before]) != std::string_view::npos && after != i + 1 &&
         (after == std::string_view::npos || ends.find(text[after]) != std::string_view::npos);
}

void check_nesting(std::string_view text, const std::string& file) {
  int line = 1;
  std::size_t dots = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '\n') {
      ++line;
      dots = 0;
    }
    if (text[i] == '.' && !is_decimal_point(text, i) && ++dots > kMaxDotsPerLine)
      throw InputError({file, line, ""},
                       fmt::format("a line may have at most {} dots outside of numbers", kMaxDotsPerLine));
  }
}

std::string json_text(const toml::table& table) {
  std::ostringstream text;
  text << toml::json_formatter{table};
  return text.str();
}

toml::table parse_file(std::string_view text, const std::string& file) {
  try {
    return toml::parse(text, std::string_view(file));
  } catch (const toml::parse_error& error) {
    throw InputError({file, static_cast<int>(error.source().begin.line), ""},
                     "the file is not valid TOML: " + printable(error.description(), 300));
  }
}

/// Parses an override KEY=VALUE as TOML. If VALUE is not a TOML value, it is used as a string, so that texts can be
/// given without quotes.
/// \param label name of the override in messages
toml::table parse_override(const std::string& text, const std::string& label) {
  const auto refuse = [&](std::string_view why) { return InputError(InputLocation{label, 0, ""}, why); };
  const auto is_control = [](char c) { return (static_cast<unsigned char>(c) < 0x20 && c != '\t') || c == 0x7f; };
  if (text.size() > kLongestOverride) throw refuse(fmt::format("at most {} characters are allowed", kLongestOverride));
  // Line breaks are refused, because a second line could contain a second assignment.
  if (std::any_of(text.begin(), text.end(), is_control)) throw refuse("must be one line of the form KEY=VALUE");
  try {
    toml::table table = toml::parse(text, std::string_view(label));
    if (table.size() == 1 && trimmed(text).front() != '[') return table;
  } catch (const toml::parse_error&) {
    // VALUE is not a TOML value. The code below uses it as a string.
  }
  const std::size_t equals = text.find('=');
  const std::string_view key = trimmed(std::string_view(text).substr(0, equals));
  if (equals == std::string::npos || key.empty() || key.find_first_not_of(kBareKeyCharacters) != std::string_view::npos)
    throw refuse("must be of the form KEY=VALUE, such as element.base_mm=0.5");
  const std::string_view value = trimmed(std::string_view(text).substr(equals + 1));
  try {
    return toml::parse(fmt::format("{} = {}", key, toml_text(value)), std::string_view(label));
  } catch (const toml::parse_error& error) {
    throw refuse("the override is not valid TOML: " + printable(error.description(), 300));
  }
}

/// Removes the key or table at a dotted path. Does nothing if the table has no such key.
void erase(toml::table& table, std::string_view path) {
  const std::size_t dot = path.find('.');
  if (dot == std::string_view::npos) {
    table.erase(path);
  } else if (toml::table* const inner = table.get_as<toml::table>(path.substr(0, dot))) {
    erase(*inner, path.substr(dot + 1));
  }
}

/// Moves all entries of `from` into `into`. Tables with the same name are merged; other entries are replaced.
void merge(toml::table& into, toml::table& from) {
  for (auto&& [key, node] : from) {
    toml::table* const source = node.as_table();
    toml::table* const target = source != nullptr ? into.get_as<toml::table>(key.str()) : nullptr;
    if (target != nullptr)
      merge(*target, *source);
    else
      node.visit([&, &name = key](auto& value) { into.insert_or_assign(name.str(), std::move(value)); });
  }
}

/// Returns a value as text for messages, such as -3, "text", a table or a list.
std::string shown_node(const toml::node& node) {
  if (const auto* text = node.as_string()) return in_quotes(text->get());
  if (const auto* integer = node.as_integer()) return fmt::format("{}", integer->get());
  if (const auto* number = node.as_floating_point())
    return std::isfinite(number->get()) ? shortest(number->get()) : fmt::format("{}", number->get());
  if (const auto* flag = node.as_boolean()) return flag->get() ? "true" : "false";
  if (const auto* list = node.as_array()) return list->empty() ? "an empty list" : "a list";
  return node.is_table() ? "a table" : "a date or time";
}

}  // namespace

/// Parsed text of a file with its overrides. It is shared by all tables of the file.
struct TomlSource {
  std::string file;
  toml::table root;
  /// Names that toml++ stores as the source of a value: the file name, followed by names for the overrides.
  std::vector<toml::source_path_ptr> paths;
  std::vector<RenamedInput> renamed;

  /// Returns 0 for a value from the file; otherwise the number of its override, from 1.
  std::size_t index_of(const toml::node& node) const {
    const auto found = std::find(paths.begin(), paths.end(), node.source().path);
    return found == paths.end() ? 0 : static_cast<std::size_t>(found - paths.begin());
  }
  TomlTable::Position position(const toml::node& node) const {
    return {index_of(node), node.source().begin.line, node.source().begin.column};
  }
  /// Returns the line of a value in the file, or 0 for a value from an override.
  int line(const toml::node& node) const {
    return index_of(node) == 0 ? static_cast<int>(node.source().begin.line) : 0;
  }
  /// \param path path of the value, for messages
  InputLocation location(const toml::node& node, std::string path) const {
    const std::size_t index = index_of(node);
    return {index == 0 ? file : *paths[index], line(node), std::move(path)};
  }
};

namespace {

/// Calls `act` for each table at a path. There may be several tables, because the path may contain lists of tables. The
/// arguments of `act` are the table and its path as text for messages.
template <class Act>
void visit_tables(toml::table& table, std::string_view path, const std::string& shown, const Act& act) {
  if (path.empty()) return act(table, shown);
  const std::size_t dot = path.find('.');
  const std::string_view first = path.substr(0, dot);
  const std::string_view rest = dot == std::string_view::npos ? std::string_view() : path.substr(dot + 1);
  toml::node* const node = table.get(first);
  if (node == nullptr) return;
  if (toml::table* const inner = node->as_table()) visit_tables(*inner, rest, path_in(shown, first), act);
  toml::array* const list = node->as_array();
  for (std::size_t i = 0; list != nullptr && i < list->size(); ++i)
    if (toml::table* const entry = list->get_as<toml::table>(i))
      visit_tables(*entry, rest, fmt::format("{}[{}]", path_in(shown, first), i + 1), act);
}

/// Replaces a former name in one table and records the replacement in `source`.
void replace(const TomlRename& name, toml::table& table, const std::string& shown, TomlSource& source) {
  if (name.is_word) {
    for (auto&& [key, node] : table) {
      toml::value<std::string>* const word = node.as_string();
      if (word == nullptr || word->get() != name.former || (!name.key.empty() && key.str() != name.key)) continue;
      source.renamed.push_back({source.location(node, path_in(shown, key.str())), name.former, name.current});
      word->get() = name.current;
    }
    return;
  }
  toml::node* const node = table.get(name.former);
  if (node == nullptr) return;
  const InputLocation where = source.location(*node, path_in(shown, name.former));
  if (table.contains(name.current))
    throw InputError(where, fmt::format("is the former name of the key {}, which is also given; remove the former name",
                                        name.current));
  source.renamed.push_back({where, name.former, name.current});
  node->visit([&](auto& value) { table.insert_or_assign(name.current, std::move(value)); });
  table.erase(name.former);
}

void replace_all(std::span<const TomlRename> names, toml::table& root, TomlSource& source) {
  for (const TomlRename& name : names)
    visit_tables(root, name.table, "",
                 [&](toml::table& table, const std::string& shown) { replace(name, table, shown, source); });
}

}  // namespace

std::vector<TomlRename> reversed(std::vector<TomlRename> renames) {
  for (TomlRename& rename : renames) std::swap(rename.former, rename.current);
  std::reverse(renames.begin(), renames.end());
  return renames;
}

std::string current_path(std::string_view path, std::span<const TomlRename> names) {
  std::string current(path);
  for (const TomlRename& name : names) {
    if (name.is_word) continue;
    const std::string former = path_in(name.table, name.former);
    if (current == former || current.starts_with(former + "."))
      current.replace(0, former.size(), path_in(name.table, name.current));
  }
  return current;
}

/// Data of a TomlTable.
struct TomlTable::Impl {
  std::shared_ptr<const TomlSource> source;
  const toml::table* table = nullptr;        ///< null if the file has no such table
  std::string name;                          ///< path of the table; empty for the root
  int line = 0;                              ///< line of the table's header; 0 if unknown
  std::set<std::string, std::less<>> taken;  ///< keys that have been requested
  std::vector<TomlTable> handed_out;         ///< tables within this table that have been requested

  const toml::node* find(std::string_view key) const { return table != nullptr ? table->get(key) : nullptr; }
  const toml::node* take(std::string_view key) {
    taken.emplace(key);
    return find(key);
  }
  std::string full_name(std::string_view key) const {
    return name.empty() ? printable(key) : name + "." + printable(key);
  }
  InputLocation location(const toml::node& node, std::string_view key) const {
    return source->location(node, full_name(key));
  }

  double checked(std::string_view key, const toml::node& node, const NumberRange& range) const {
    const auto refuse = [&](const std::string& allowed) -> InputError {
      return {location(node, key), fmt::format("must be {}, got {}", allowed, shown_node(node))};
    };
    if (!node.is_number()) throw refuse("a number");
    const auto* integer = node.as_integer();
    const double value = integer != nullptr ? static_cast<double>(integer->get()) : node.as_floating_point()->get();
    if (!std::isfinite(value)) throw refuse("a finite number");
    if (!range.contains(value)) throw refuse(range.text());
    return value;
  }

  TomlTable child(const toml::table* inner, std::string inner_name, int inner_line) {
    auto hidden = std::make_shared<Impl>();
    hidden->source = source;
    hidden->table = inner;
    hidden->name = std::move(inner_name);
    hidden->line = inner_line;
    handed_out.emplace_back(std::move(hidden));
    return handed_out.back();
  }
};

TomlTable::TomlTable(std::shared_ptr<Impl> hidden) : impl_(std::move(hidden)) {}

bool TomlTable::has(std::string_view key) const {
  return impl_->find(key) != nullptr;
}

InputLocation TomlTable::where() const {
  return {impl_->source->file, impl_->line, impl_->name};
}

InputLocation TomlTable::where(std::string_view key) const {
  const toml::node* const node = impl_->find(key);
  return node != nullptr ? impl_->location(*node, key)
                         : InputLocation{impl_->source->file, impl_->line, impl_->full_name(key)};
}

void TomlTable::fail(std::string_view key, std::string_view text) const {
  throw InputError(where(key), text);
}

std::optional<double> TomlTable::number(std::string_view key, const NumberRange& range) {
  const toml::node* const node = impl_->take(key);
  return node != nullptr ? std::optional(impl_->checked(key, *node, range)) : std::nullopt;
}

double TomlTable::required_number(std::string_view key, const NumberRange& range) {
  const std::optional<double> value = number(key, range);
  if (!value) fail(key, "is missing; it must be " + range.text());
  return *value;
}

std::optional<std::vector<double>> TomlTable::number_or_numbers(std::string_view key, const NumberRange& range) {
  const toml::node* const node = impl_->take(key);
  if (node == nullptr) return std::nullopt;
  const toml::array* const list = node->as_array();
  if (list == nullptr && !node->is_number())
    fail(key, "must be a number or a list of numbers, got " + shown_node(*node));
  if (list == nullptr) return std::vector<double>{impl_->checked(key, *node, range)};
  if (list->empty()) fail(key, "must be a number or a list of at least one number, got an empty list");
  std::vector<double> values;
  for (const toml::node& item : *list) values.push_back(impl_->checked(key, item, range));
  return values;
}

std::optional<std::vector<std::vector<double>>> TomlTable::pairs(std::string_view key, std::string_view shape,
                                                                 const NumberRange& first, const NumberRange& second) {
  const toml::node* const given = impl_->take(key);
  if (given == nullptr) return std::nullopt;
  const auto refuse = [&](const toml::node& node, const std::string& what) -> InputError {
    return {impl_->location(node, key), fmt::format("must be a list of {}, {}", shape, what)};
  };
  const toml::array* const list = given->as_array();
  if (list == nullptr || list->empty()) throw refuse(*given, "got " + shown_node(*given));
  std::vector<std::vector<double>> pairs;
  for (const toml::node& node : *list) {
    const toml::array* const pair = node.as_array();
    if (pair == nullptr) throw refuse(node, "but the list contains " + shown_node(node));
    if (pair->size() != 2) throw refuse(node, fmt::format("but the list contains a list of length {}", pair->size()));
    pairs.push_back({impl_->checked(key, *pair->get(0), first), impl_->checked(key, *pair->get(1), second)});
  }
  return pairs;
}

std::optional<std::vector<double>> TomlTable::numbers(std::string_view key, std::size_t count, const NumberRange& range,
                                                      std::string_view what) {
  const toml::node* const node = impl_->take(key);
  if (node == nullptr) return std::nullopt;
  const toml::array* const list = node->as_array();
  if (list == nullptr || list->size() != count)
    fail(key, fmt::format("must be a list of {} {}, got {}", count, what,
                          list != nullptr ? fmt::format("a list of length {}", list->size()) : shown_node(*node)));
  std::vector<double> values;
  for (const toml::node& item : *list) values.push_back(impl_->checked(key, item, range));
  return values;
}

std::optional<std::vector<std::vector<double>>> TomlTable::number_rows(std::string_view key, std::size_t columns,
                                                                       const NumberRange& range) {
  const toml::node* const node = impl_->take(key);
  if (node == nullptr) return std::nullopt;
  const std::string allowed = fmt::format("must be a list of lists of {} numbers", columns);
  const toml::array* const list = node->as_array();
  if (list == nullptr) fail(key, allowed + ", got " + shown_node(*node));
  std::vector<std::vector<double>> rows;
  for (const toml::node& item : *list) {
    const toml::array* const row = item.as_array();
    if (row == nullptr || row->size() != columns)
      fail(key, fmt::format("{}, but the list contains {}", allowed,
                            row != nullptr ? fmt::format("a list of length {}", row->size()) : shown_node(item)));
    rows.emplace_back();
    for (const toml::node& value : *row) rows.back().push_back(impl_->checked(key, value, range));
  }
  return rows;
}

std::optional<long long> TomlTable::integer(std::string_view key, const NumberRange& range) {
  const std::optional<double> value = number(key, range);
  if (!value) return std::nullopt;
  if (*value != std::floor(*value)) fail(key, "must be a whole number, got " + shortest(*value));
  return static_cast<long long>(*value);
}

std::optional<bool> TomlTable::flag(std::string_view key) {
  const toml::node* const node = impl_->take(key);
  if (node == nullptr) return std::nullopt;
  if (!node->is_boolean()) fail(key, "must be true or false, got " + shown_node(*node));
  return node->as_boolean()->get();
}

std::optional<std::string> TomlTable::text(std::string_view key) {
  const toml::node* const node = impl_->take(key);
  if (node == nullptr) return std::nullopt;
  if (!node->is_string()) fail(key, "must be a string, got " + shown_node(*node));
  return node->as_string()->get();
}

std::optional<std::vector<std::string>> TomlTable::texts(std::string_view key) {
  const toml::node* const node = impl_->take(key);
  if (node == nullptr) return std::nullopt;
  const toml::array* const list = node->as_array();
  if (list == nullptr || list->empty()) fail(key, "must be a list of one or more strings, got " + shown_node(*node));
  std::vector<std::string> values;
  for (const toml::node& item : *list) {
    if (!item.is_string())
      throw InputError(impl_->location(item, key),
                       "must be a list of strings, but the list contains " + shown_node(item));
    values.push_back(item.as_string()->get());
  }
  return values;
}

std::optional<std::size_t> TomlTable::choice(std::string_view key, std::span<const std::string_view> words,
                                             std::string_view or_else) {
  const toml::node* const node = impl_->take(key);
  if (node == nullptr) return std::nullopt;
  if (!node->is_string()) fail(key, fmt::format("must be a string{}, got {}", or_else, shown_node(*node)));
  const std::optional<std::string> given = node->as_string()->get();
  const auto found = std::find(words.begin(), words.end(), *given);
  if (found != words.end()) return static_cast<std::size_t>(found - words.begin());
  std::string message = fmt::format("must be {}{}, got {}", alternatives(words), or_else, in_quotes(*given));
  const std::string_view meant = closest_match(*given, words);
  if (!meant.empty() && words.size() > 1) message += fmt::format("; did you mean {}?", in_quotes(meant));
  fail(key, message);
}

std::size_t TomlTable::required_choice(std::string_view key, std::span<const std::string_view> words) {
  const auto index = choice(key, words);
  if (!index) fail(key, "is missing; it must be " + alternatives(words));
  return *index;
}

TomlTable TomlTable::table(std::string_view key) {
  const toml::node* const node = impl_->take(key);
  if (node == nullptr) return impl_->child(nullptr, impl_->full_name(key), impl_->line);
  if (!node->is_table()) fail(key, "must be a table, got " + shown_node(*node));
  return impl_->child(node->as_table(), impl_->full_name(key), impl_->source->line(*node));
}

std::vector<TomlTable> TomlTable::tables(std::string_view key, std::string_view shape, bool are_numbered) {
  const toml::node* const node = impl_->take(key);
  if (node == nullptr) return {};
  const toml::array* const list = node->as_array();
  if (list == nullptr) fail(key, fmt::format("must be {}, got {}", shape, shown_node(*node)));
  std::vector<TomlTable> result;
  for (const toml::node& item : *list) {
    if (!item.is_table())
      throw InputError(impl_->location(item, key),
                       fmt::format("must be {}, but the list contains {}", shape, shown_node(item)));
    std::string name = impl_->full_name(key);
    if (are_numbered) name += fmt::format("[{}]", result.size() + 1);
    result.push_back(impl_->child(item.as_table(), std::move(name), impl_->source->line(item)));
  }
  return result;
}

TomlTable::Shape TomlTable::shape_of(std::string_view key) const {
  const toml::node* const node = impl_->find(key);
  if (node == nullptr) return Shape::nothing;
  if (node->is_string()) return Shape::text;
  if (node->is_number()) return Shape::number;
  if (node->is_array()) return Shape::list;
  return node->is_table() ? Shape::table : Shape::other;
}

std::string TomlTable::shown(std::string_view key) const {
  return shown_node(*impl_->find(key));
}

std::optional<std::vector<TomlItem>> TomlTable::items(std::string_view key) {
  const toml::node* const node = impl_->take(key);
  if (node == nullptr || !node->is_array()) return std::nullopt;
  std::vector<TomlItem> items;
  for (const toml::node& entry : *node->as_array()) {
    TomlItem& item = items.emplace_back();
    if (entry.is_number()) item.number = entry.value<double>();
    if (entry.is_string()) item.text = entry.as_string()->get();
    item.is_list = entry.is_array();
    std::ostringstream text;
    entry.visit([&](const auto& value) { text << value; });
    item.toml = text.str();
    std::replace(item.toml.begin(), item.toml.end(), '\n', ' ');
    item.shown = shown_node(entry);
  }
  return items;
}

std::string TomlTable::as_json(std::string_view key) const {
  toml::table holder;
  if (!has(key)) return {};
  impl_->find(key)->visit([&](const auto& value) { holder.insert("value", value); });
  return json_text(holder);
}

std::string TomlTable::as_json() const {
  return json_text(*impl_->table);
}

TomlTable::Position TomlTable::position(std::string_view key) const {
  const toml::node* const node = impl_->find(key);
  return node != nullptr ? impl_->source->position(*node) : Position{};
}

const std::vector<RenamedInput>& TomlTable::renamed() const {
  return impl_->source->renamed;
}

std::vector<std::string> TomlTable::sorted_names() const {
  std::vector<std::string> names;
  if (impl_->table != nullptr)
    for (auto&& [key, node] : *impl_->table) names.emplace_back(key.str());
  return names;
}

std::vector<std::string> TomlTable::names() const {
  std::vector<std::string> names = sorted_names();
  std::ranges::sort(names, {}, [&](const std::string& name) { return position(name); });
  return names;
}

void TomlTable::finish() const {
  for (const std::string& name : names()) {
    if (impl_->taken.contains(name)) continue;
    const std::vector<std::string_view> known(impl_->taken.begin(), impl_->taken.end());
    const std::string_view meant = closest_match(name, known);
    fail(name, fmt::format("unknown {}{}", shape_of(name) == Shape::table ? "table" : "key",
                           meant.empty() ? " (allowed: " + fmt::format("{}", fmt::join(known, ", ")) + ")"
                                         : ", did you mean " + in_quotes(meant) + "?"));
  }
  for (const TomlTable& table : impl_->handed_out) table.finish();
}

std::optional<std::string_view> unset_key(std::string_view override_text) {
  const std::size_t equals = override_text.find('=');
  if (equals == std::string_view::npos || !trimmed(override_text.substr(equals + 1)).empty()) return std::nullopt;
  const std::string_view key = trimmed(override_text.substr(0, equals));
  if (key.empty() || key.find_first_not_of(kBareKeyCharacters) != std::string_view::npos) return std::nullopt;
  return key;
}

TomlTable parse_toml(std::string_view text, const std::string& source_name, std::size_t max_bytes,
                     std::span<const std::string> overrides, std::span<const TomlRename> names) {
  auto source = std::make_shared<TomlSource>();
  source->file = printable(source_name, std::string::npos);
  require_short_text(text, source->file, max_bytes);
  if (text.size() > kShortTomlBytes) check_nesting(text, source->file);
  source->root = parse_file(text, source->file);
  source->paths.push_back(source->root.source().path);
  replace_all(names, source->root, *source);
  for (const std::string& each : overrides) {
    std::string label = "--set " + printable(each);
    if (const auto key = unset_key(each)) {
      erase(source->root, current_path(*key, names));
      source->paths.push_back(std::make_shared<const std::string>(std::move(label)));
      continue;
    }
    toml::table table = parse_override(each, label);
    source->paths.push_back(table.source().path);
    replace_all(names, table, *source);
    merge(source->root, table);
  }
  auto hidden = std::make_shared<TomlTable::Impl>();
  hidden->table = &source->root;
  hidden->source = std::move(source);
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
