#include "core/schema/document.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace retrace::schema {
namespace {

namespace fs = std::filesystem;

Form form_of(const Value& value) {
  if (std::holds_alternative<std::monostate>(value) || std::holds_alternative<bool>(value)) return Form::other;
  if (std::holds_alternative<double>(value)) return Form::number;
  if (std::holds_alternative<std::string>(value)) return Form::text;
  return std::holds_alternative<Named>(value) ? Form::table : Form::list;
}

/// Returns true if a row (the description of a key) allows the type of the value, or if the value has not been read
/// yet.
bool may_have(const Row& row, const Value& value) {
  return std::holds_alternative<std::monostate>(value) || accepts(row.kind, form_of(value));
}

}  // namespace

Document::Document(const Table& table, InputLocation place, fs::path folder)
    : table_(&table), location_(std::move(place)), folder_(std::move(folder)) {}

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
  return form_of(value(path)) == Form::list;
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

std::string Document::text_as_written(std::string_view path) const {
  const InputLocation place = where(path);
  for (const RenamedInput& each : renamed_)
    if (each.where.file == place.file && each.where.line == place.line && each.where.key == place.key)
      return each.former;
  return text(path);
}

std::size_t Document::index(std::string_view path) const {
  const auto words = std::get<Word>(row(path)->kind).words;
  return static_cast<std::size_t>(std::ranges::find(words, text(path)) - words.begin());
}

fs::path Document::file(std::string_view path) const {
  const Given& given = given_.find(path)->second;
  const std::string& name = std::get<std::string>(given.value);
  return given.source > 0 ? fs::path(name) : folder_ / name;
}

std::vector<fs::path> Document::files() const {
  std::vector<fs::path> files;
  for (const std::string& key : keys_of_files()) files.push_back(file(key));
  return files;
}

std::vector<std::string> Document::keys_of_files() const {
  std::vector<std::string> keys;
  for (const auto& [path, given] : given_) {
    const Row* const served = std::holds_alternative<std::string>(given.value) ? row(path) : nullptr;
    if (served == nullptr) continue;
    const auto* const either = std::get_if<WordOrFile>(&served->kind);
    const bool is_word = either != nullptr && std::ranges::count(either->words, std::get<std::string>(given.value)) > 0;
    if (std::holds_alternative<File>(served->kind) || (either != nullptr && !is_word)) keys.push_back(path);
  }
  return keys;
}

InputLocation Document::where(std::string_view path) const {
  if (const auto found = given_.find(path); found != given_.end()) return found->second.location;
  if (path.empty()) return location_;
  const std::string_view around = split_path(path).around;
  const auto table = given_.find(around);
  if (table == given_.end()) return {location_.file, around.empty() ? location_.line : 0, path_in(location_.key, path)};
  return {location_.file, table->second.location.line, path_in(table->second.location.key, split_path(path).name)};
}

const Row* Document::row(std::string_view path) const {
  const auto [around, name] = split_path(path);
  const Table* const table = table_at(*table_, around);
  if (table == nullptr) return nullptr;
  const auto given = given_.find(path);
  for (const Row& row : table->rows)
    if (row.key == name && holds(row.when, around) && (given == given_.end() || may_have(row, given->second.value)))
      return &row;
  return nullptr;
}

std::string Document::path_of(std::string_view key, std::string_view around) const {
  const auto is_key = [&](const std::string& path) {
    const auto [tables, name] = split_path(path);
    const Table* const table = table_at(*table_, tables);
    return table != nullptr &&
           (table_at(*table, name) != nullptr || std::ranges::count(table->rows, name, &Row::key) > 0);
  };
  for (std::string_view place = around;; place = split_path(place).around) {
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

void Document::set(const std::string& path, Value value, InputLocation place, std::size_t source) {
  given_[path] = {std::move(value), std::move(place), source};
}

std::size_t Document::source_of(std::string_view path) const {
  const auto found = given_.find(path);
  return found == given_.end() ? 0 : found->second.source;
}

}  // namespace retrace::schema
