#include "core/schema/schema.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "core/message_text.h"
#include "core/overloaded.h"

namespace retrace::schema {
namespace {

/// Suffixes of names, and the unit that each suffix denotes. If one suffix is the end of another, the longer one comes
/// first.
constexpr std::array<std::pair<std::string_view, std::string_view>, 17> kUnits = {{{"_mm_per_min", "mm/min"},
                                                                                   {"_mm_per_s2", "mm/s^2"},
                                                                                   {"_mm_per_s3", "mm/s^3"},
                                                                                   {"_mm_per_s", "mm/s"},
                                                                                   {"_deg_per_s2", "degrees/s^2"},
                                                                                   {"_deg_per_s", "degrees/s"},
                                                                                   {"_per_mm", "1/mm"},
                                                                                   {"_mm", "mm"},
                                                                                   {"_um", "um"},
                                                                                   {"_nm", "nm"},
                                                                                   {"_deg", "degrees"},
                                                                                   {"_arcmin", "arc minutes"},
                                                                                   {"_arcsec", "arc seconds"},
                                                                                   {"_km", "km"},
                                                                                   {"_percent", "percent"},
                                                                                   {"_ps", "ps"},
                                                                                   {"_s", "s"}}};

}  // namespace

std::string_view unit_of(std::string_view name) {
  for (const auto& [suffix, unit] : kUnits)
    if (name.ends_with(suffix)) return unit;
  return {};
}

std::string allowed(const Kind& kind) {
  return std::visit(
      Overloaded{[](const Number& number) { return number.range.text(); },
                 [](const Integer& whole) { return "a whole number " + whole.range.text(); },
                 [](const Flag&) { return std::string("true or false"); },
                 [](const Word& word) { return alternatives(word.words) + std::string(word.further_allowed); },
                 [](const Text& text) { return std::string(text.what); },
                 [](const File& file) { return fmt::format("the name of {}", file.what); },
                 [](const WordOrFile& either) { return std::string(either.allowed); },
                 [](const NumberOrNumbers& list) {
                   return std::string(list.is_integer ? "a whole number or a list of whole numbers"
                                                      : "a number or a list of numbers");
                 },
                 [](const Numbers& numbers) { return fmt::format("a list of {} {}", numbers.count, numbers.what); },
                 [](const Terms& terms) { return fmt::format("a list of numbers, {} for each term", terms.count); },
                 [](const NumberRows& rows) { return fmt::format("a list of lists of {} numbers", rows.columns); },
                 [](const Pairs& pairs) { return fmt::format("a list of {}", pairs.shape); },
                 [](const Texts&) { return std::string("a list of one or more strings"); },
                 [](const TextOrTexts& texts) { return std::string(texts.what); },
                 [](const Anything&) { return std::string("a list of at least one value"); },
                 [](const ByName& named) { return std::string(named.what); }},
      kind);
}

bool accepts(const Kind& kind, Form form) {
  return std::visit(
      Overloaded{[&](const Flag&) { return form == Form::other; }, [&](const Number&) { return form == Form::number; },
                 [&](const Integer&) { return form == Form::number; }, [&](const Word&) { return form == Form::text; },
                 [&](const Text&) { return form == Form::text; }, [&](const File&) { return form == Form::text; },
                 [&](const WordOrFile&) { return form == Form::text; },
                 [&](const NumberOrNumbers&) { return form == Form::number || form == Form::list; },
                 [&](const TextOrTexts&) { return form == Form::text || form == Form::list; },
                 [&](const ByName&) { return form == Form::table; }, [&](const auto&) { return form == Form::list; }},
      kind);
}

Value default_value(const Row& row) {
  return std::visit(
      Overloaded{
          [](const Required&) { return Value(); }, [](const None&) { return Value(); },
          [](const Computed&) { return Value(); }, [](bool flag) { return Value(flag); },
          [](double number) { return Value(number); }, [](std::string_view text) { return Value(std::string(text)); },
          [](std::span<const double> numbers) { return Value(std::vector<double>(numbers.begin(), numbers.end())); }},
      row.default_spec);
}

SplitPath split_path(std::string_view path) {
  const std::size_t dot = path.rfind('.');
  return dot == std::string_view::npos ? SplitPath{{}, path} : SplitPath{path.substr(0, dot), path.substr(dot + 1)};
}

const Table* table_at(const Table& root, std::string_view path) {
  if (path.empty()) return &root;
  const auto [around, name] = split_path(path);
  const Table* const outer = table_at(root, around);
  if (outer == nullptr) return nullptr;
  const auto found = std::ranges::find(outer->tables, name.substr(0, name.find('[')), &Table::name);
  return found != outer->tables.end() ? &*found : nullptr;
}

std::string path_of_entry(std::string_view list, std::size_t index) {
  return fmt::format("{}[{}]", list, index);
}

}  // namespace retrace::schema
