#include "core/schema/schema.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <stdexcept>
#include <utility>

#include "core/message_text.h"
#include "core/overloaded.h"

namespace retrace::schema {
namespace {

/// Suffixes of names; one that another one ends in stands after it.
constexpr std::array<std::pair<std::string_view, std::string_view>, 12> kUnits = {{{"_mm_per_min", "mm/min"},
                                                                                   {"_mm_per_s2", "mm/s^2"},
                                                                                   {"_deg_per_s2", "degrees/s^2"},
                                                                                   {"_deg_per_s", "degrees/s"},
                                                                                   {"_per_mm", "1/mm"},
                                                                                   {"_mm", "mm"},
                                                                                   {"_um", "um"},
                                                                                   {"_nm", "nm"},
                                                                                   {"_deg", "degrees"},
                                                                                   {"_arcmin", "arc minutes"},
                                                                                   {"_percent", "percent"},
                                                                                   {"_s", "s"}}};

std::size_t index_of(std::span<const std::string_view> words, std::string_view word) {
  return static_cast<std::size_t>(std::find(words.begin(), words.end(), word) - words.begin());
}

/// The word that `key` of the table itself has, or of a table in it; nothing if there is no such key.
std::optional<std::string_view> word_in(const Level& level, std::string_view key) {
  const std::size_t dot = key.find('.');
  for (const Row& row : level.table.rows)
    if (const Word* const word = std::get_if<Word>(&row.kind); word && row.key == key && holds(row.when, level))
      return word->words[static_cast<std::size_t>(std::get<double>(row.access.get(level.object)))];
  if (dot == std::string_view::npos) return std::nullopt;
  for (const Table& table : level.table.tables)
    if (table.name == key.substr(0, dot) && table.child.count(level.object) > 0)
      return word_in({table, table.child.at(level.object, 0), &level}, key.substr(dot + 1));
  return std::nullopt;
}

}  // namespace

std::string_view unit_of(std::string_view name) {
  for (const auto& [suffix, unit] : kUnits)
    if (name.ends_with(suffix)) return unit;
  return {};
}

std::string allowed(const Kind& kind) {
  return std::visit(
      Overloaded{[](const Number& number) { return number.range.text(); },
                 [](const Whole& whole) { return "a whole number " + whole.range.text(); },
                 [](const Flag&) { return std::string("true or false"); },
                 [](const Word& word) { return alternatives(word.words); },
                 [](const Text&) { return std::string("a string"); },
                 [](const Numbers& numbers) { return fmt::format("a list of {} numbers", numbers.count); },
                 [](const NumberRows& rows) { return fmt::format("a list of lists of {} numbers", rows.columns); },
                 [](const Texts&) { return std::string("a list of one or more strings"); }},
      kind);
}

Value default_value(const Row& row) {
  return std::visit(
      Overloaded{
          [](const Required&) { return Value(); }, [](const None&) { return Value(); },
          [](const Computed&) { return Value(); }, [](bool flag) { return Value(flag); },
          [](double number) { return Value(number); },
          [&](std::string_view text) {
            const Word* const word = std::get_if<Word>(&row.kind);
            return word ? Value(static_cast<double>(index_of(word->words, text))) : Value(std::string(text));
          },
          [](std::span<const double> numbers) { return Value(std::vector<double>(numbers.begin(), numbers.end())); }},
      row.otherwise);
}

bool holds(const When& when, const Level& level) {
  if (when.key.empty()) return true;
  for (const Level* place = &level; place != nullptr; place = place->around)
    if (const auto word = word_in(*place, when.key)) return index_of(when.words, *word) < when.words.size();
  throw std::logic_error("a condition names no word: " + std::string(when.key));
}

}  // namespace retrace::schema
