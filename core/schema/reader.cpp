#include "core/schema/reader.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <utility>

#include "core/message_text.h"
#include "core/number_format.h"
#include "core/overloaded.h"

namespace retrace::schema {
namespace {

using Shape = TomlTable::Shape;

// First step of reading: class Names records the keys and tables that the file contains, and refuses unknown ones.

std::vector<std::string_view> names_in(const Table& table, bool with_keys) {
  std::vector<std::string_view> names;
  for (const Row& row : table.rows)
    if (with_keys && (names.empty() || names.back() != row.key)) names.push_back(row.key);
  for (const Table& inner : table.tables) names.push_back(inner.name);
  return names;
}

constexpr std::string_view kId = "schema";

/// Returns the message about an unknown key or table. It contains a similar name, if any, and all allowed names.
std::string unknown_name(const Table& table, std::string_view name, bool is_table, bool is_root) {
  if (is_root && !is_table)
    for (const Table& inner : table.tables)
      if (std::ranges::count(inner.rows, name, &Row::key) > 0)
        return fmt::format("unknown key at the top level; it belongs in the table [{}]", inner.name);
  std::vector<std::string_view> names = names_in(table, !is_table || table.tables.empty());
  if (is_root && !is_table) names.insert(names.begin(), kId);
  const std::string_view meant = closest_match(name, names);
  return fmt::format("unknown {}{} (allowed: {})", is_table ? "table" : "key",
                     meant.empty() ? "" : fmt::format(", did you mean {}?", in_quotes(meant)), fmt::join(names, ", "));
}

/// Returns the required type of a table as text for messages.
std::string_view shape_of(const Table& table) {
  if (!table.shape.empty()) return table.shape;
  return table.presence == Presence::list ? "a list of tables" : "a table";
}

std::vector<TomlTable> entries(const Table& table, TomlTable& around) {
  return around.tables(table.name, shape_of(table), true);
}

/// Records the names of all keys and tables of a file in a document.
class Names {
 public:
  explicit Names(Document& document) : document_(document) {}

  void take(const Table& table, TomlTable source, const std::string& path) {
    for (const std::string& name : source.names()) {
      if (path.empty() && name == kId) continue;
      const auto inner = std::ranges::find(table.tables, name, &Table::name);
      if (inner != table.tables.end()) {
        take_table(*inner, source, path_in(path, name));
      } else if (std::ranges::count(table.rows, name, &Row::key) > 0) {
        Value word;
        if (source.shape_of(name) == Shape::text) word = *source.text(name);
        document_.set(path_in(path, name), std::move(word), source.where(name), source.position(name).source);
      } else if (!table.is_open) {
        source.fail(name, unknown_name(table, name, source.shape_of(name) == Shape::table, path.empty()));
      }
    }
  }

 private:
  void take_table(const Table& table, TomlTable& around, const std::string& path) {
    const std::string name(table.name);
    document_.set(path, {}, around.where(name), around.position(name).source);
    if (table.presence != Presence::list) {
      if (around.shape_of(name) != Shape::table)
        around.fail(name, fmt::format("must be {}, got {}", shape_of(table), around.shown(name)));
      take(table, around.table(name), path);
      return;
    }
    std::size_t index = 0;
    for (const TomlTable& entry : entries(table, around)) {
      const std::string entry_path = path_of_entry(path, index++);
      document_.set(entry_path, {}, entry.where(), around.position(name).source);
      take(table, entry, entry_path);
    }
  }

  Document& document_;
};

// Second step of reading: class Values reads and checks the values of the recorded keys.

template <class Type>
Value value_of(std::optional<Type> given) {
  return given ? Value(*std::move(given)) : Value();
}
Value number_of(std::optional<double> given) {
  return value_of(given);
}

Value word_of(const Word& kind, std::string_view key, TomlTable& source) {
  const auto index = source.choice(key, kind.words, kind.further_allowed);
  return index ? Value(std::string(kind.words[*index])) : Value();
}

Value number_or_numbers(const NumberOrNumbers& kind, std::string_view key, TomlTable& source) {
  std::vector<double> numbers = *source.number_or_numbers(key, kind.range);
  const auto is_broken = [&](double number) { return kind.is_integer && number != std::floor(number); };
  if (const auto broken = std::ranges::find_if(numbers, is_broken); broken != numbers.end())
    source.fail(key, fmt::format("must be {}, got {}", allowed(kind), shortest(*broken)));
  return source.shape_of(key) == Shape::list ? Value(std::move(numbers)) : Value(numbers.front());
}

Value terms_of(const Terms& kind, std::string_view key, TomlTable& source) {
  std::optional<std::vector<double>> numbers;
  if (source.shape_of(key) == Shape::list) numbers = source.number_or_numbers(key);
  if (!numbers || numbers->size() % kind.count != 0)
    source.fail(key, fmt::format("must be {}, got {}", allowed(kind),
                                 numbers ? fmt::format("a list of length {}", numbers->size()) : source.shown(key)));
  return *std::move(numbers);
}

/// Returns true if a text can be a file name. A name with a zero byte is refused, because the operating system would
/// use only the part before this byte.
bool is_file_name(const std::string& name) {
  return !name.empty() && name.find('\0') == std::string::npos;
}

Value file_of(std::string_view key, TomlTable& source) {
  std::optional<std::string> name = source.text(key);
  if (name && !is_file_name(*name)) source.fail(key, "must be the name of a file, got " + in_quotes(*name));
  return value_of(std::move(name));
}

Value word_or_file_of(const WordOrFile& kind, std::string_view key, TomlTable& source) {
  if (source.shape_of(key) == Shape::text) {
    const std::string name = *source.text(key);
    if (std::ranges::count(kind.words, std::string_view(name)) > 0) return name;
    if (name.ends_with(kind.ending) && is_file_name(name)) return name;
  }
  source.fail(key, fmt::format("must be {}, got {}", kind.allowed, source.shown(key)));
}

std::optional<std::vector<std::vector<double>>> number_rows(const NumberRows& kind, std::string_view key,
                                                            TomlTable& source) {
  auto rows = source.number_rows(key, kind.columns, kind.range);
  if (rows && (rows->size() < kind.min_rows || rows->size() > kind.max_rows))
    source.fail(key, fmt::format("must be {} to {} {}, got {}", kind.min_rows, kind.max_rows, kind.what, rows->size()));
  return rows;
}

std::vector<std::string> texts_of(const TextOrTexts& kind, std::string_view key, TomlTable& source) {
  if (source.shape_of(key) == Shape::text) return {*source.text(key)};
  const auto items = source.items(key);
  if (!items || items->empty()) source.fail(key, fmt::format("must be {}, got {}", kind.what, source.shown(key)));
  std::vector<std::string> texts;
  for (const TomlItem& item : *items) {
    if (!item.text) source.fail(key, fmt::format("must be {}, but the list contains {}", kind.what, item.shown));
    texts.push_back(*item.text);
  }
  return texts;
}

/// Returns the TOML text of each entry of a list.
std::vector<std::string> anything_of(std::string_view key, TomlTable& source) {
  const auto items = source.items(key);
  if (!items || items->empty())
    source.fail(key, fmt::format("must be {}, got {}", allowed(Anything{}), source.shown(key)));
  std::vector<std::string> texts;
  for (const TomlItem& item : *items) {
    if (!item.text && !item.is_list && !(item.number && std::isfinite(*item.number)))
      source.fail(
          key, fmt::format("must be a list of finite numbers, strings or lists, but the list contains {}", item.shown));
    texts.push_back(item.toml);
  }
  return texts;
}

Named named_of(const ByName& kind, std::string_view key, TomlTable& source) {
  if (source.shape_of(key) != Shape::table)
    source.fail(key, fmt::format("must be {}, got {}", kind.what, source.shown(key)));
  TomlTable table = source.table(key);
  std::vector<std::string> names(kind.names.begin(), kind.names.end());
  if (names.empty()) names = table.names();
  if (names.empty()) source.fail(key, "must have at least one key, got an empty table");
  Named named;
  for (const std::string& name : names)
    std::visit(Overloaded{[&](const Number& each) { named[name] = table.required_number(name, each.range); },
                          [&](const Word& each) {
                            named[name] = std::string(each.words[table.required_choice(name, each.words)]);
                          }},
               kind.each);
  table.finish();
  return named;
}

/// Returns the value of a key after checking that it is of the kind `kind`.
Value given(const Kind& kind, std::string_view key, TomlTable& source) {
  return std::visit(
      Overloaded{
          [&](const Number& number) {
            source.number(key, number.range);
            return value_of(source.number(key, number.plausible));
          },
          [&](const Integer& whole) { return number_of(source.integer(key, whole.range)); },
          [&](const Flag&) { return value_of(source.flag(key)); },
          [&](const Word& word) { return word_of(word, key, source); },
          [&](const Text&) { return value_of(source.text(key)); }, [&](const File&) { return file_of(key, source); },
          [&](const WordOrFile& either) { return word_or_file_of(either, key, source); },
          [&](const NumberOrNumbers& list) { return number_or_numbers(list, key, source); },
          [&](const Numbers& numbers) {
            return value_of(source.numbers(key, numbers.count, numbers.range, numbers.what));
          },
          [&](const Terms& terms) { return terms_of(terms, key, source); },
          [&](const NumberRows& rows) { return value_of(number_rows(rows, key, source)); },
          [&](const Pairs& pairs) { return value_of(source.pairs(key, pairs.shape, pairs.first, pairs.second)); },
          [&](const Texts&) { return value_of(source.texts(key)); },
          [&](const TextOrTexts& texts) { return Value(texts_of(texts, key, source)); },
          [&](const Anything&) { return Value(anything_of(key, source)); },
          [&](const ByName& named) { return Value(named_of(named, key, source)); }},
      kind);
}

void check_rule(const OneOf& rule, const Document& document, const std::string& path) {
  std::string last;
  std::string_view first;
  std::size_t count = 0;
  for (const std::string_view key : rule.keys) {
    if (!document.has(path_in(path, key))) continue;
    if (count == 0) first = key;
    last = path_in(path, key);
    ++count;
  }
  if (count == 0) throw InputError(document.where(path), rule.complaint);
  if (count > 1) throw InputError(document.where(last), fmt::format("not allowed together with {}", first));
}

/// Returns the message about a key that was given although the condition for it does not hold.
std::string refusal(const Condition& condition) {
  using Is = Condition::Is;
  if (!condition.refusal.empty()) return std::string(condition.refusal);
  const std::string_view key = condition.key;
  switch (condition.is) {
    case Is::one_of: return fmt::format("only allowed for {} = {}", key, alternatives(condition.words));
    case Is::none_of: return fmt::format("not allowed for {} = {}", key, alternatives(condition.words));
    case Is::given: return fmt::format("only allowed together with {}", key);
    case Is::absent: break;
  }
  return fmt::format("not allowed together with {}", key);
}

Form form_of(Shape shape) {
  switch (shape) {
    case Shape::text: return Form::text;
    case Shape::number: return Form::number;
    case Shape::list: return Form::list;
    case Shape::table: return Form::table;
    default: return Form::other;
  }
}

/// Reads the values of all keys whose names have been recorded by class Names.
class Values {
 public:
  explicit Values(Document& document) : document_(document) {}

  void read(const Table& table, TomlTable source, const std::string& path) {
    for (const Rule& rule : table.rules)
      if (const OneOf* const one_of = std::get_if<OneOf>(&rule)) check_rule(*one_of, document_, path);
    for (std::size_t i = 0; i < table.rows.size(); ++i)
      if (i == 0 || table.rows[i].key != table.rows[i - 1].key) read_key(table, table.rows[i].key, source, path);
    for (const Table& inner : table.tables) read_inner(inner, source, path);
  }

 private:
  void read_inner(const Table& table, TomlTable& around, const std::string& around_path) {
    const std::string path = path_in(around_path, table.name);
    const Condition* const refused = document_.refused_by(table.when, around_path);
    if (!document_.has(path)) {
      if (table.presence == Presence::always && refused == nullptr)
        around.fail(table.name, fmt::format("is missing; it must be {}", shape_of(table)));
      if (table.presence == Presence::implied && refused == nullptr) read(table, around.table(table.name), path);
      return;
    }
    if (refused != nullptr) throw InputError(document_.where(path), refusal(*refused));
    if (table.presence != Presence::list) return read(table, around.table(table.name), path);
    std::size_t index = 0;
    for (const TomlTable& entry : entries(table, around)) read(table, entry, path_of_entry(path, index++));
  }

  /// Selects the row of a key that applies, and reads the value with this row.
  void read_key(const Table& table, std::string_view key, TomlTable& source, const std::string& around) {
    const std::string path = path_in(around, key);
    const Form form = form_of(source.shape_of(key));
    const Row* served = nullptr;
    const Row* refused = nullptr;
    for (const Row& row : table.rows) {
      if (row.key != key) continue;
      const bool holds = document_.holds(row.when, around);
      if (!holds && refused == nullptr) refused = &row;
      if (holds && (served == nullptr || accepts(row.kind, form))) served = &row;
    }
    if (served == nullptr) {
      if (document_.has(path)) refuse(path, *refused, source);
    } else if (document_.has(path)) {
      check_word(table, *served, path, source);
      document_.set(path, given(served->kind, key, source), document_.where(path), source.position(key).source);
    } else if (std::holds_alternative<Required>(served->default_spec)) {
      document_.fail(path, "is missing; it must be " + allowed(served->kind));
    }
  }

  void refuse(const std::string& path, const Row& row, TomlTable& source) {
    if (row.zero_is_none && source.shape_of(row.key) == Shape::number && source.number(row.key) == 0.0)
      return document_.drop(path);
    document_.fail(path, refusal(*document_.refused_by(row.when, path)));
  }

  /// Refuses a word if another row of the key allows it, but not the row `served`, which is the row that applies. The
  /// message contains the allowed words, and the key and value on which the choice of the row depends.
  /// \throw InputError if only another row of the key allows the word
  void check_word(const Table& table, const Row& served, const std::string& path, const TomlTable& source) {
    const Word* const word = std::get_if<Word>(&served.kind);
    if (word == nullptr || served.when.empty() || source.shape_of(served.key) != Shape::text) return;
    const std::string given = document_.text(path);
    if (std::ranges::count(word->words, std::string_view(given)) > 0) return;
    for (const Row& other : table.rows) {
      const Word* const others = other.key == served.key ? std::get_if<Word>(&other.kind) : nullptr;
      if (others == nullptr || std::ranges::count(others->words, std::string_view(given)) == 0) continue;
      const std::string_view key = served.when.front().key;
      document_.fail(path, fmt::format("must be {} for {} = {}, got {}", alternatives(word->words), key,
                                       in_quotes(document_.text(document_.path_of(key, path))), in_quotes(given)));
    }
  }

  Document& document_;
};

// Third step of reading: the values are stored in C++ objects, and rules on combinations of values are checked.

/// Returns the key that a message about a rule refers to: the first key of the rule that was given, or its first key.
std::string_view blamed(const Check& rule, const Document& document, const std::string& path) {
  for (const std::string_view key : rule.keys)
    if (document.has(path_in(path, key))) return key;
  return rule.keys.empty() ? std::string_view() : rule.keys.front();
}

/// Returns the value as required by Access::set(), in which a word is replaced by its index.
Value as_index(const Kind& kind, Value value) {
  const Word* const word = std::get_if<Word>(&kind);
  const std::string* const text = std::get_if<std::string>(&value);
  if (word == nullptr || text == nullptr) return value;
  return static_cast<double>(std::ranges::find(word->words, *text) - word->words.begin());
}

void add_keys(const Table& table, const std::string& path, std::vector<std::string>& keys) {
  for (const Row& row : table.rows)
    if (std::string key = path_in(path, row.key); keys.empty() || keys.back() != key) keys.push_back(std::move(key));
  for (const Table& inner : table.tables) {
    const std::string inner_path = path_in(path, inner.name);
    if (inner.presence == Presence::list)
      keys.push_back(inner_path);
    else
      add_keys(inner, inner_path, keys);
  }
}

/// Returns true if the format has this key or table and an override can address it. Overrides cannot address keys of
/// tables in a list.
bool has_key_or_table(const Table& root, std::string_view path) {
  const auto [around, name] = split_path(path);
  const Table* const table = table_at(root, around);
  if (path == kId) return true;
  if (path.starts_with('.') || name.empty() || table == nullptr) return false;
  for (std::string_view outer = around; !outer.empty(); outer = split_path(outer).around)
    if (table_at(root, outer)->presence == Presence::list) return false;
  return table_at(*table, name) != nullptr || std::ranges::count(table->rows, name, &Row::key) > 0;
}

void add_former_words(const Word& word, const std::string& table, std::string_view key,
                      std::vector<TomlRename>& names) {
  for (const FormerWord& each : word.former)
    names.push_back({table, std::string(each.former), std::string(each.current), true, std::string(key)});
}

void add_former_names(const Table& table, const std::string& path, std::vector<TomlRename>& names) {
  for (const Row& row : table.rows) {
    if (!row.former.empty()) names.push_back({path, std::string(row.former), std::string(row.key)});
    if (const Word* const word = std::get_if<Word>(&row.kind)) add_former_words(*word, path, row.key, names);
    if (const ByName* const named = std::get_if<ByName>(&row.kind))
      if (const Word* const word = std::get_if<Word>(&named->each))
        add_former_words(*word, path_in(path, row.key), "", names);
  }
  for (const Table& inner : table.tables) {
    if (!inner.former.empty()) names.push_back({path, std::string(inner.former), std::string(inner.name)});
    add_former_names(inner, path_in(path, inner.name), names);
  }
}

/// Checks overrides of the form KEY=, which remove a key. KEY must be a key of the format, but need not be in the file.
/// \throw InputError for the first override with an unknown key
void check_unset_keys(const Format& format, std::span<const std::string> overrides, std::span<const TomlRename> names) {
  for (const std::string& each : overrides)
    if (const auto key = unset_key(each); key && !has_key_or_table(format.root, current_path(*key, names)))
      throw InputError({"--set " + printable(each), 0, ""}, complaint_about_key(format, *key));
}

/// Checks the key that gives the format of the file, and returns the root table.
TomlTable checked_root(const Format& format, TomlTable root) {
  const std::string_view ids[] = {format.id};
  if (!root.choice(kId, ids) && !format.id_is_optional) root.required_choice(kId, ids);
  return root;
}

}  // namespace

Document read_document(const Format& format, std::string_view text, const std::string& source_name,
                       std::size_t max_bytes, std::span<const std::string> overrides) {
  const std::vector<TomlRename> names = former_names(format);
  check_unset_keys(format, overrides, names);
  const TomlTable root = checked_root(format, parse_toml(text, source_name, max_bytes, overrides, names));
  Document document(format.root, root.where(), std::filesystem::path(source_name).parent_path());
  Names(document).take(format.root, root, "");
  Values(document).read(format.root, root, "");
  document.set_origin({std::string(text), {overrides.begin(), overrides.end()}});
  document.set_renamed(root.renamed());
  return document;
}

Document with(const Format& format, const Document& document, std::span<const std::string> overrides) {
  std::vector<std::string> all = document.origin().overrides;
  all.insert(all.end(), overrides.begin(), overrides.end());
  return read_document(format, document.origin().text, document.source(), kMaxTextBytes, all);
}

Document unchecked_names(const Format& format, std::string_view text, const std::string& source_name,
                         std::size_t max_bytes, std::span<const std::string> overrides) {
  Document document(format.root, {source_name, 0, ""}, std::filesystem::path(source_name).parent_path());
  try {
    Names(document).take(format.root, parse_toml(text, source_name, max_bytes, overrides, former_names(format)), "");
  } catch (const Error&) {  // the error is ignored here, because read_document() reports it
  }
  return document;
}

void fill(const Document& document, const Table& table, const std::string& path, void* object) {
  for (const Row& row : table.rows) {
    const std::string key = path_in(path, row.key);
    if (document.row(key) != &row) continue;
    Value value = document.value(key);
    if (value.index() == 0) continue;
    try {
      row.access.set(object, as_index(row.kind, std::move(value)));
    } catch (const InputError& error) {
      document.fail(key, error.what());
    }
  }
  for (const Table& inner : table.tables) {
    const std::string inner_path = path_in(path, inner.name);
    for (std::size_t i = 0; i < document.count(inner_path); ++i)
      fill(document, inner, inner.presence == Presence::list ? path_of_entry(inner_path, i) : inner_path,
           inner.child.add(object));
  }
  check(document, table, path, object);
}

void check(const Document& document, const Table& table, const std::string& path, const void* object) {
  for (const Rule& rule : table.rules)
    if (const Check* const check = std::get_if<Check>(&rule))
      check->check(object, [&](std::string_view key, const std::string& complaint) {
        const std::string_view to_blame = key.empty() ? blamed(*check, document, path) : key;
        document.fail(to_blame.empty() ? path : path_in(path, to_blame), complaint);
      });
}

void check(const Table& table, const void* object, const Refuse& refuse) {
  for (const Rule& rule : table.rules)
    if (const Check* const check = std::get_if<Check>(&rule)) check->check(object, refuse);
}

namespace {

/// Returns the warning that `key` has no effect because the key `winner` takes precedence over it. Returns an empty
/// text if `key` is absent, has its default value, or was replaced on purpose.
/// \param winner path of the key that takes precedence
/// \param key path of the key that has no effect
std::string superseded_text(const Precedence& rule, const Document& document, const std::string& winner,
                            const std::string& key) {
  const Row* const row = document.row(key);
  if (row == nullptr || !document.has(key) || document.value(key) == default_value(*row)) return {};
  const std::size_t winner_source = document.source_of(winner), source = document.source_of(key);
  // If `key` is in the file and an override sets `winner`, the user intends to replace `key` and needs no warning. For
  // rules with Precedence::is_refinement, a warning is needed only if an override sets `key` later than `winner`.
  if (rule.is_refinement ? source <= winner_source : source == 0 && winner_source > 0) return {};
  const InputLocation where = document.where(winner);
  const std::string place = where.line > 0 ? fmt::format(" (line {})", where.line) : std::string();
  std::string text =
      fmt::format("has no effect {}: {}{} takes precedence; remove one of the two keys", rule.effect, where.key, place);
  if (winner.find('[') == std::string::npos) text += fmt::format(", or disable {0} with --set {0}=", winner);
  return InputError(document.where(key), text).what();
}

void add_superseded(const Document& document, const Table& table, const std::string& path, Warnings& warnings) {
  for (const Rule& rule : table.rules) {
    const Precedence* const precedence = std::get_if<Precedence>(&rule);
    if (precedence == nullptr || !document.holds({&precedence->winner, 1}, path)) continue;
    const std::string winner = document.path_of(precedence->winner.key, path);
    for (const std::string_view key : precedence->keys)
      if (std::string text = superseded_text(*precedence, document, winner, path_in(path, key)); !text.empty())
        warnings.push_back({"superseded_key", std::move(text)});
  }
  for (const Table& inner : table.tables) {
    const std::string inner_path = path_in(path, inner.name);
    for (std::size_t i = 0; i < document.count(inner_path); ++i)
      add_superseded(document, inner, inner.presence == Presence::list ? path_of_entry(inner_path, i) : inner_path,
                     warnings);
  }
}

}  // namespace

Warnings superseded_keys(const Document& document) {
  Warnings warnings;
  add_superseded(document, document.table(), "", warnings);
  return warnings;
}

Warnings renamed_keys(const Document& document) {
  Warnings warnings;
  for (const RenamedInput& each : document.renamed())
    warnings.push_back(
        {"renamed_key",
         InputError(each.where, fmt::format("{} is a former name of the format and is still accepted: write {} instead",
                                            in_quotes(each.former), in_quotes(each.current)))
             .what()});
  return warnings;
}

std::vector<TomlRename> former_names(const Format& format) {
  std::vector<TomlRename> names;
  add_former_names(format.root, "", names);
  // The rows of one key have the same former name, so the list may contain equal entries, which are next to each other.
  const auto is_same = [](const TomlRename& a, const TomlRename& b) {
    return a.table == b.table && a.former == b.former && a.key == b.key;
  };
  names.erase(std::unique(names.begin(), names.end(), is_same), names.end());
  return names;
}

Document read_object(const Format& format, std::string_view text, const std::string& source_name, void* object) {
  Document document = read_document(format, text, source_name);
  fill(document, format.root, "", object);
  return document;
}

std::vector<std::string> keys_of(const Format& format) {
  std::vector<std::string> keys;
  add_keys(format.root, "", keys);
  return keys;
}

bool is_number_key(const Format& format, std::string_view path) {
  const auto [around, name] = split_path(path);
  const Table* const table = table_at(format.root, around);
  const auto is_it = [key = name](const Row& row) { return row.key == key && accepts(row.kind, Form::number); };
  return table != nullptr && std::ranges::any_of(table->rows, is_it);
}

std::string complaint_about_key(const Format& format, std::string_view path) {
  const std::vector<std::string> keys = keys_of(format);
  if (std::ranges::count(keys, path) > 0) return {};
  const std::string_view meant = closest_match(path, std::vector<std::string_view>(keys.begin(), keys.end()));
  return fmt::format("{} is not a key of a {}{}", in_quotes(path), format.name,
                     meant.empty() ? "" : fmt::format(", did you mean {}?", in_quotes(meant)));
}

}  // namespace retrace::schema
