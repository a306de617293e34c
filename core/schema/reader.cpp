#include "core/schema/reader.h"

#include <fmt/format.h>

#include <optional>
#include <utility>

#include "core/overloaded.h"

namespace retrace::schema {
namespace {

template <class Type>
Value value_of(std::optional<Type> given) {
  return given ? Value(*std::move(given)) : Value();
}
Value number_of(std::optional<double> given) {
  return value_of(given);
}

std::optional<std::vector<std::vector<double>>> number_rows(const NumberRows& kind, std::string_view key,
                                                            TomlTable& source) {
  auto rows = source.number_rows(key, kind.columns, kind.range);
  if (rows && (rows->size() < kind.least || rows->size() > kind.most))
    source.fail(key, fmt::format("must be {} to {} {}, got {}", kind.least, kind.most, kind.what, rows->size()));
  return rows;
}

/// What was given for a key, checked; nothing if it was not given.
Value given(const Kind& kind, std::string_view key, TomlTable& source) {
  return std::visit(
      Overloaded{[&](const Number& number) { return value_of(source.number(key, number.range)); },
                 [&](const Whole& whole) { return number_of(source.whole(key, whole.range)); },
                 [&](const Flag&) { return value_of(source.flag(key)); },
                 [&](const Word& word) { return number_of(source.choice(key, word.words)); },
                 [&](const Text&) { return value_of(source.text(key)); },
                 [&](const Numbers& numbers) { return value_of(source.numbers(key, numbers.count, numbers.range)); },
                 [&](const NumberRows& rows) { return value_of(number_rows(rows, key, source)); },
                 [&](const Texts&) { return value_of(source.texts(key)); }},
      kind);
}

void read_row(const Row& row, TomlTable& source, void* object) {
  Value value = given(row.kind, row.key, source);
  if (value.index() == 0 && std::holds_alternative<Required>(row.otherwise))
    source.fail(row.key, "missing, must be " + allowed(row.kind));
  if (value.index() == 0) value = default_value(row);
  if (value.index() != 0) row.access.set(object, value);
}

void check_rule(const OneOf& rule, const TomlTable& source) {
  std::string_view last;
  std::size_t count = 0;
  for (const std::string_view key : rule.keys) {
    if (!source.has(key)) continue;
    last = key;
    ++count;
  }
  if (count != 1) throw InputError(count == 0 ? source.where() : source.where(last), rule.complaint);
}

void check_rule(const Check& rule, const TomlTable& source, const void* object) {
  const std::string complaint = rule.complaint(object);
  if (complaint.empty()) return;
  for (const std::string_view key : rule.keys)
    if (source.has(key)) source.fail(key, complaint);
  throw InputError(rule.keys.empty() ? source.where() : source.where(rule.keys.front()), complaint);
}

void read_level(const Table& table, TomlTable source, void* object, const Level* around);

void read_child(const Table& table, TomlTable& source, void* parent, const Level& around) {
  if (table.presence == Presence::list) {
    for (const TomlTable& each : source.tables(table.name)) read_level(table, each, table.child.add(parent), &around);
    return;
  }
  const TomlTable inner = source.table(table.name);
  if (inner.exists())
    read_level(table, inner, table.child.add(parent), &around);
  else if (table.presence == Presence::always)
    source.fail(table.name, fmt::format("missing, must be {}", table.shape));
}

void read_keys(const Table& table, TomlTable& source, void* object, const Level* around) {
  const Level level = {table, object, around};
  for (const Rule& rule : table.rules)
    if (const OneOf* const one_of = std::get_if<OneOf>(&rule)) check_rule(*one_of, source);
  for (const Row& row : table.rows)
    if (holds(row.when, level)) read_row(row, source, object);
  for (const Table& inner : table.tables)
    if (holds(inner.when, level)) read_child(inner, source, object, level);
}

void check_values(const Table& table, const TomlTable& source, const void* object) {
  for (const Rule& rule : table.rules)
    if (const Check* const check = std::get_if<Check>(&rule)) check_rule(*check, source, object);
}

void read_level(const Table& table, TomlTable source, void* object, const Level* around) {
  read_keys(table, source, object, around);
  check_values(table, source, object);
}

}  // namespace

void read_table(const Table& table, const TomlTable& source, void* object) {
  read_level(table, source, object, nullptr);
}

void read_document(const Format& format, std::string_view text, const std::string& source_name, void* object) {
  TomlTable root = parse_toml(text, source_name);
  const std::string_view ids[] = {format.id};
  root.required_choice("schema", ids);
  read_keys(format.root, root, object, nullptr);
  root.finish();
  check_values(format.root, root, object);
}

}  // namespace retrace::schema
