#pragma once

// Functions that create conditions and rows with conditions. A condition states when a key or table of a format has an
// effect. The parameter `refusal` is the message for a key that is given although its condition does not hold. If
// `refusal` is empty, the message is made from the condition.

#include <algorithm>

#include "core/schema/schema.h"

namespace retrace::schema {

using Words = std::string_view[];

/// Returns the part of a list of words from `first` to `last`. If `last` is not given, the part contains only `first`.
/// \pre the list contains these words; otherwise the code does not compile
constexpr std::span<const std::string_view> only(std::span<const std::string_view> words, std::string_view first,
                                                 std::string_view last = {}) {
  const auto begin = std::ranges::find(words, first);
  return {begin, (last.empty() ? begin : std::ranges::find(words, last)) + 1};
}

constexpr Condition is(std::string_view key, std::span<const std::string_view> words, std::string_view refusal = {}) {
  return {key, Condition::Is::one_of, words, refusal};
}
constexpr Condition is_not(std::string_view key, std::span<const std::string_view> words,
                           std::string_view refusal = {}) {
  return {key, Condition::Is::none_of, words, refusal};
}
constexpr Condition is_given(std::string_view key, std::string_view refusal = {}) {
  return {key, Condition::Is::given, {}, refusal};
}
constexpr Condition is_absent(std::string_view key, std::string_view refusal = {}) {
  return {key, Condition::Is::absent, {}, refusal};
}

/// Returns a copy of a row that several formats share, with the conditions of one format.
constexpr Row where(Row row, When when, bool may_be_zero = false) {
  row.when = when;
  row.zero_is_none = may_be_zero;
  return row;
}
/// Returns a copy of a row that several formats share, with the access functions and conditions of one format.
constexpr Row with(Row row, Access access, When when = {}) {
  row.access = access;
  row.when = when;
  return row;
}

/// Returns a copy of a row whose key had another name in former versions of the format.
constexpr Row renamed(std::string_view former, Row row) {
  row.former = former;
  return row;
}

}  // namespace retrace::schema
