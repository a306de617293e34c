#pragma once

#include "core/schema/schema.h"

// Conditions under which keys and tables mean something. `refusal` is what is said of one that was given all the same,
// if that needs more than the condition does.

namespace retrace::schema {

constexpr Condition is(std::string_view key, std::span<const std::string_view> words, std::string_view refusal = {}) {
  return {key, Condition::Is::one_of, words, refusal};
}
constexpr Condition is_not(std::string_view key, std::span<const std::string_view> words,
                           std::string_view refusal = {}) {
  return {key, Condition::Is::none_of, words, refusal};
}
constexpr Condition beside(std::string_view key, std::string_view refusal = {}) {
  return {key, Condition::Is::given, {}, refusal};
}
constexpr Condition without(std::string_view key, std::string_view refusal = {}) {
  return {key, Condition::Is::absent, {}, refusal};
}

}  // namespace retrace::schema
