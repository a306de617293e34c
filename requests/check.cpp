#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/error.h"
#include "core/message_text.h"
#include "core/number_format.h"
#include "core/overloaded.h"
#include "core/requirement_text.h"
#include "requests/row.h"

namespace retrace::requests {
namespace {

using schema::Value;

std::string numbers_text(const std::vector<double>& numbers) {
  std::vector<std::string> texts;
  for (const double number : numbers) texts.push_back(shortest(number));
  return fmt::format("[{}]", fmt::join(texts, ", "));
}

/// Converts a value to text for error messages.
std::string shown(const Value& value) {
  return std::visit(
      Overloaded{[](std::monostate) { return std::string("nothing"); },
                 [](bool flag) { return std::string(flag ? "true" : "false"); },
                 [](double number) { return shortest(number); },
                 [](const std::string& text) { return in_quotes(text); },
                 [](const std::vector<double>& numbers) { return printable(numbers_text(numbers)); },
                 [](const std::vector<std::vector<double>>& rows) {
                   std::string text;
                   for (const auto& row : rows) text += (text.empty() ? "" : ", ") + numbers_text(row);
                   return printable("[" + text + "]");
                 },
                 [](const std::vector<std::string>& texts) { return fmt::format("a list of {}", texts.size()); },
                 [](const schema::Named&) { return std::string("a table"); }},
      value);
}

bool is_in(const NumberRange& range, double number, bool is_whole = false) {
  return std::isfinite(number) && range.contains(number) && (!is_whole || number == std::floor(number));
}

/// Returns the first number that is not in the range, or nothing if all numbers are in the range.
/// \param is_whole true if numbers that are not integers count as outside of the range
std::optional<double> first_outside(const std::vector<double>& numbers, const NumberRange& range, bool is_whole) {
  for (const double number : numbers)
    if (!is_in(range, number, is_whole)) return number;
  return std::nullopt;
}

[[noreturn]] void refuse(const Row& row, const std::string& must_be, const std::string& given) {
  throw InputError(row.field(), fmt::format("must be {}, got {}", must_be, given));
}

/// Checks the value of a field. The call operator takes the kind of the field and throws an InputError that names the
/// field, if the kind does not allow the value.
class KindCheck {
 public:
  KindCheck(const Row& row, const Value& value) : row_(row), value_(value) {}

  void operator()(const schema::Number& kind) const {
    if (!is_in(kind.range, taken<double>(kind))) refuse(row_, schema::allowed(kind), shown(value_));
  }
  void operator()(const schema::Integer& kind) const {
    if (!is_in(kind.range, taken<double>(kind), true)) refuse(row_, schema::allowed(kind), shown(value_));
  }
  void operator()(const schema::Flag& kind) const { taken<bool>(kind); }
  void operator()(const schema::Word& kind) const {
    const auto& word = taken<std::string>(kind);
    if (std::ranges::count(kind.words, std::string_view(word)) > 0) return;
    const std::string_view meant = closest_match(word, kind.words);
    refuse(row_, schema::allowed(kind),
           in_quotes(word) + (meant.empty() ? "" : fmt::format("; did you mean {}?", in_quotes(meant))));
  }
  void operator()(const schema::Text& kind) const {
    if (taken<std::string>(kind).empty()) refuse(row_, schema::allowed(kind), shown(value_));
  }
  void operator()(const schema::File& kind) const { check_file(taken<std::string>(kind), kind); }
  void operator()(const schema::WordOrFile& kind) const { check_file(taken<std::string>(kind), kind); }
  void operator()(const schema::NumberOrNumbers& kind) const {
    const auto& numbers = taken<std::vector<double>>(kind);
    if (numbers.empty() && !kind.may_be_empty) refuse(row_, "at least one number", "none");
    if (numbers.size() > kind.max_count)
      refuse(row_, fmt::format("1 to {} numbers", kind.max_count), fmt::format("{} numbers", numbers.size()));
    check_numbers(numbers, kind.range, kind.is_integer);
  }
  void operator()(const schema::Numbers& kind) const {
    const auto& numbers = taken<std::vector<double>>(kind);
    if (numbers.size() != kind.count)
      refuse(row_, schema::allowed(kind), fmt::format("a list of length {}", numbers.size()));
    check_numbers(numbers, kind.range, kind.is_integer);
  }
  void operator()(const schema::NumberRows& kind) const {
    const auto& rows = taken<std::vector<std::vector<double>>>(kind);
    if (rows.size() < kind.min_rows || rows.size() > kind.max_rows)
      refuse(row_, fmt::format("{} to {} {}", kind.min_rows, kind.max_rows, kind.what), fmt::format("{}", rows.size()));
    for (const std::vector<double>& numbers : rows) {
      if (numbers.size() != kind.columns) refuse(row_, schema::allowed(kind), shown(value_));
      check_numbers(numbers, kind.range, false);
    }
  }
  void operator()(const schema::Texts& kind) const { taken<std::vector<std::string>>(kind); }
  void operator()(const auto& kind) const { refuse(row_, schema::allowed(kind), shown(value_)); }

 private:
  template <class Type>
  const Type& taken(const auto& kind) const {
    const Type* const found = std::get_if<Type>(&value_);
    if (found == nullptr) refuse(row_, schema::allowed(kind), shown(value_));
    return *found;
  }
  void check_file(const std::string& name, const auto& kind) const {
    if (name.empty() || name.find('\0') != std::string::npos) refuse(row_, schema::allowed(kind), shown(value_));
  }
  void check_numbers(const std::vector<double>& numbers, const NumberRange& range, bool is_whole) const {
    if (const auto outside = first_outside(numbers, range, is_whole))
      refuse(row_, (is_whole ? "whole numbers " : "") + range.text(), shortest(*outside));
  }

  const Row& row_;
  const Value& value_;
};

/// Converts a value to the type that the kind of a field requires. A single number is converted to a list with one
/// number, and an empty list of numbers to an empty list of rows or texts.
Value as_kind(const schema::Kind& kind, const Value& value) {
  const double* const number = std::get_if<double>(&value);
  if (number != nullptr && std::holds_alternative<schema::NumberOrNumbers>(kind)) return std::vector{*number};
  const auto* const numbers = std::get_if<std::vector<double>>(&value);
  const bool is_empty = numbers != nullptr && numbers->empty();
  if (is_empty && std::holds_alternative<schema::NumberRows>(kind)) return std::vector<std::vector<double>>();
  if (is_empty && std::holds_alternative<schema::Texts>(kind)) return std::vector<std::string>();
  return value;
}

void check_kind(const Row& row, const Value& value) {
  std::visit(KindCheck(row, value), row.kind);
}

/// Evaluates the conditions under which the fields of a request may be given.
class Conditions {
 public:
  Conditions(const Request& request, const void* object)
      : request_(request), object_(object), initial_(request.initial()) {}

  bool is_given(const Row& row) const { return row.access.get(object_) != row.access.get(initial_); }

  bool holds(const schema::Condition& condition) const {
    using Is = schema::Condition::Is;
    const Row* const other = row_of(request_, condition.key);
    // A condition can refer to an option that is not a field of the request. The command line checks such a condition.
    if (other == nullptr) return true;
    if (condition.is == Is::given) return is_given(*other);
    if (condition.is == Is::absent) return !is_given(*other);
    const Value value = other->access.get(object_);
    const std::string* const word = std::get_if<std::string>(&value);
    const bool is_listed = word != nullptr && std::ranges::count(condition.words, std::string_view(*word)) > 0;
    return condition.is == Is::one_of ? is_listed : !is_listed;
  }

  /// Returns the error message for a field whose need is not met.
  std::string complaint(Need need) const {
    std::vector<std::string> required;
    std::vector<std::string> excluded;
    for (const schema::Condition& condition : need) {
      const Row* const other = row_of(request_, condition.key);
      const std::string name = reference(other != nullptr ? other->field() : Field{condition.key});
      using Is = schema::Condition::Is;
      if (condition.is == Is::absent)
        excluded.push_back(name);
      else if (condition.is == Is::given)
        required.push_back(name);
      else
        required.push_back(fmt::format("{} {}", name, fmt::join(condition.words, " or ")));
    }
    return requirement_text(required, excluded) + given(need);
  }

  /// Returns the text ", got VALUE", with the value of the field to which the first condition refers. Returns an empty
  /// text if the first condition does not restrict the value of that field to a list of words.
  std::string given(Need need) const {
    const schema::Condition& first = need.front();
    const Row* const other = row_of(request_, first.key);
    const bool is_of_value = first.is == schema::Condition::Is::one_of || first.is == schema::Condition::Is::none_of;
    return other != nullptr && is_of_value ? ", got " + requests::text_of(*other, object_) : "";
  }

 private:
  const Request& request_;
  const void* object_;
  const void* initial_;
};

}  // namespace

void set(const Row& row, void* object, const Value& value) {
  const Value taken = as_kind(row.kind, value);
  check_kind(row, taken);
  row.access.set(object, taken);
}

void reset(const Request& request, const Row& row, void* object) {
  row.access.set(object, row.access.get(request.initial()));
}

void check(const Request& request, const void* object) {
  const Conditions conditions(request, object);
  for (const Row& row : request.rows) {
    const Value value = row.access.get(object);
    if (row.is_required && !conditions.is_given(row)) throw InputError(row.field(), "is required");
    if (!conditions.is_given(row)) continue;
    check_kind(row, value);
    for (const Need need : row.needs)
      if (std::ranges::none_of(need, [&](const auto& condition) { return conditions.holds(condition); }))
        throw InputError(row.field(), conditions.complaint(need));
  }
  if (request.check != nullptr) request.check(object);
}

}  // namespace retrace::requests
