#include <fmt/format.h>
#include <fmt/ranges.h>

#include <charconv>
#include <cstdint>
#include <optional>

#include "core/error.h"
#include "core/leading_number.h"
#include "core/message_text.h"
#include "core/number_format.h"
#include "core/overloaded.h"
#include "core/text.h"
#include "requests/number_list.h"
#include "requests/row.h"

namespace retrace::requests {
namespace {

using schema::Value;

[[noreturn]] void refuse(const Row& row, const std::string& must_be, std::string_view text) {
  throw InputError(row.field(), fmt::format("must be {}, got {}", must_be, printable(text)));
}

double number_of(const Row& row, std::string_view text, std::string_view must_be) {
  const std::optional<LeadingNumber> number = leading_number(text);
  if (!number || number->length != text.size()) refuse(row, std::string(must_be), text);
  return number->value;
}

/// Parses a decimal integer. Leading zeros are refused because some languages use them to mark octal numbers.
double whole_of(const Row& row, std::string_view text) {
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool is_number =
      error == std::errc{} && end == text.data() + text.size() && (text.size() == 1 || text.front() != '0');
  if (!is_number) refuse(row, schema::allowed(row.kind), text);
  return static_cast<double>(value);
}

std::vector<double> separated(const Row& row, const schema::Numbers& kind, std::string_view text) {
  const char separator = row.spelling.notation == Notation::by_x ? 'x' : ',';
  const std::string must_be = fmt::format("{} numbers {}", kind.count, row.spelling.value);
  std::vector<double> numbers;
  for (const std::string_view part : split(text, separator)) numbers.push_back(number_of(row, part, must_be));
  if (numbers.size() != kind.count) refuse(row, must_be, text);
  return numbers;
}

std::vector<double> listed(const Row& row, std::string_view text) {
  if (row.spelling.notation != Notation::commas) return read_number_list(text, row.field());
  std::vector<double> numbers;
  for (const std::string_view part : split(text, ',')) {
    const std::optional<double> number = number_in(part);
    if (!number) refuse(row, "a number, or numbers separated by commas", text);
    numbers.push_back(*number);
  }
  return numbers;
}

std::string joined(const std::vector<double>& numbers, Notation notation) {
  std::vector<std::string> texts;
  for (const double number : numbers) texts.push_back(shortest(number));
  return fmt::format("{}", fmt::join(texts, notation == Notation::by_x ? "x" : ","));
}

}  // namespace

void set_text(const Row& row, void* object, std::string_view text) {
  const Value value =
      std::visit(Overloaded{[&](const schema::Number&) { return Value(number_of(row, text, "a number")); },
                            [&](const schema::Integer&) { return Value(whole_of(row, text)); },
                            [&](const schema::Numbers& kind) { return Value(separated(row, kind, text)); },
                            [&](const schema::NumberOrNumbers&) { return Value(listed(row, text)); },
                            [&](const auto&) { return Value(std::string(text)); }},
                 row.kind);
  set(row, object, value);
}

std::string text_of(const Row& row, const void* object) {
  return std::visit(
      Overloaded{
          [&](double number) {
            return std::holds_alternative<schema::Integer>(row.kind) ? fmt::format("{:.0f}", number) : shortest(number);
          },
          [](const std::string& text) { return text; },
          [&](const std::vector<double>& numbers) { return joined(numbers, row.spelling.notation); },
          [](bool flag) { return std::string(flag ? "true" : "false"); }, [](const auto&) { return std::string(); }},
      row.access.get(object));
}

std::string default_text(const Request& request, const Row& row) {
  if (!row.spelling.otherwise.empty()) return std::string(row.spelling.otherwise);
  if (!row.spelling.usual.empty()) return std::string(row.spelling.usual);
  if (row.is_required) return {};
  const Value initial = row.access.get(request.initial());
  if (const bool* const is_on = std::get_if<bool>(&initial)) return *is_on ? "on" : "off";
  return text_of(row, request.initial());
}

}  // namespace retrace::requests
