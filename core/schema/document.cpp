#include "core/schema/document.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace retrace::schema {
namespace {

namespace fs = std::filesystem;

/// The tables around a key or table, and its own name.
struct SplitPath {
  std::string_view around;
  std::string_view name;
};

SplitPath split(std::string_view path) {
  const std::size_t dot = path.rfind('.');
  return dot == std::string_view::npos ? SplitPath{{}, path} : SplitPath{path.substr(0, dot), path.substr(dot + 1)};
}

std::string_view without_entry(std::string_view name) {
  return name.substr(0, name.find('['));
}

const Table* inner_table(const Table& table, std::string_view name) {
  const auto found = std::ranges::find(table.tables, name, &Table::name);
  return found != table.tables.end() ? &*found : nullptr;
}

/// The table of that path; null if there is none.
const Table* table_at(const Table& root, std::string_view path) {
  if (path.empty()) return &root;
  const auto [around, name] = split(path);
  const Table* const outer = table_at(root, around);
  return outer != nullptr ? inner_table(*outer, without_entry(name)) : nullptr;
}

bool is_a_list(const Value& value) {
  return value.index() >= 4;  // behind nothing, flag, number and text
}

bool has_form(const Row& row, const Value& value) {
  return row.form == Form::any || is_a_list(value) == (row.form == Form::list);
}

}  // namespace

Document::Document(const Table& table, InputLocation place, fs::path folder)
    : table_(&table), place_(std::move(place)), folder_(std::move(folder)) {}

std::size_t Document::count(std::string_view path) const {
  if (table_at(*table_, path)->presence != Presence::list) return has(path) ? 1 : 0;
  std::size_t count = 0;
  while (has(path_of_entry(path, count))) ++count;
  return count;
}

Value Document::value(std::string_view path) const {
  if (const auto found = given_.find(path); found != given_.end()) return found->second.value;
  const Row* const served = row(path);
  return served != nullptr ? default_value(*served) : Value();
}

bool Document::is_list(std::string_view path) const {
  return is_a_list(value(path));
}

std::vector<double> Document::numbers(std::string_view path) const {
  const Value given = value(path);
  const double* const number = std::get_if<double>(&given);
  return number != nullptr ? std::vector{*number} : std::get<std::vector<double>>(given);
}

std::optional<double> Document::number_if(std::string_view path) const {
  const Value given = value(path);
  const double* const number = std::get_if<double>(&given);
  return number != nullptr ? std::optional(*number) : std::nullopt;
}

std::string Document::text_if(std::string_view path) const {
  const Value given = value(path);
  const std::string* const text = std::get_if<std::string>(&given);
  return text != nullptr ? *text : std::string();
}

std::size_t Document::index(std::string_view path) const {
  const auto words = std::get<Word>(row(path)->kind).words;
  return static_cast<std::size_t>(std::ranges::find(words, text(path)) - words.begin());
}

fs::path Document::file(std::string_view path) const {
  const Given& given = given_.find(path)->second;
  const std::string& name = std::get<std::string>(given.value);
  return given.is_overridden ? fs::path(name) : folder_ / name;
}

std::vector<fs::path> Document::files() const {
  std::vector<fs::path> files;
  for (const auto& [path, given] : given_) {
    const Row* const served = std::holds_alternative<std::string>(given.value) ? row(path) : nullptr;
    if (served == nullptr) continue;
    const auto* const either = std::get_if<WordOrFile>(&served->kind);
    const bool is_word = either != nullptr && std::ranges::count(either->words, std::get<std::string>(given.value)) > 0;
    if (std::holds_alternative<File>(served->kind) || (either != nullptr && !is_word)) files.push_back(file(path));
  }
  return files;
}

InputLocation Document::where(std::string_view path) const {
  if (const auto found = given_.find(path); found != given_.end()) return found->second.place;
  if (path.empty()) return place_;
  const std::string_view around = split(path).around;
  const auto table = given_.find(around);
  if (table == given_.end()) return {place_.file, around.empty() ? place_.line : 0, path_in(place_.key, path)};
  return {place_.file, table->second.place.line, path_in(table->second.place.key, split(path).name)};
}

const Row* Document::row(std::string_view path) const {
  const auto [around, name] = split(path);
  const Table* const table = table_at(*table_, around);
  if (table == nullptr) return nullptr;
  const auto given = given_.find(path);
  for (const Row& row : table->rows)
    if (row.key == name && holds(row.when, around) && (given == given_.end() || has_form(row, given->second.value)))
      return &row;
  return nullptr;
}

std::string Document::path_of(std::string_view key, std::string_view around) const {
  const auto is_key = [&](const std::string& path) {
    const auto [tables, name] = split(path);
    const Table* const table = table_at(*table_, tables);
    return table != nullptr &&
           (inner_table(*table, name) != nullptr || std::ranges::count(table->rows, name, &Row::key) > 0);
  };
  for (std::string_view place = around;; place = split(place).around) {
    if (std::string path = path_in(place, key); is_key(path)) return path;
    if (place.empty()) throw std::logic_error("a condition names no key: " + std::string(key));
  }
}

const Condition* Document::refused_by(When when, std::string_view around) const {
  const auto holds = [&](const Condition& condition) {
    using Is = Condition::Is;
    const std::string path = path_of(condition.key, around);
    if (condition.is == Is::given || condition.is == Is::absent) return has(path) == (condition.is == Is::given);
    const Value given = value(path);
    const std::string* const word = std::get_if<std::string>(&given);
    const bool is_one = word != nullptr && std::ranges::count(condition.words, std::string_view(*word)) > 0;
    return is_one == (condition.is == Is::one_of);
  };
  const auto failed = std::ranges::find_if_not(when, holds);
  return failed != when.end() ? &*failed : nullptr;
}

void Document::set(const std::string& path, Value value, InputLocation place, bool is_overridden) {
  given_[path] = {std::move(value), std::move(place), is_overridden};
}

}  // namespace retrace::schema
