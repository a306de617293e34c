#pragma once

// Concatenation of arrays at compile time, for constant tables that share rows.

#include <array>
#include <cstddef>
#include <utility>

namespace retrace {

/// Returns an array with the elements of `a`, followed by those of `b`.
template <class T, std::size_t kFirst, std::size_t kSecond>
constexpr std::array<T, kFirst + kSecond> joined(const std::array<T, kFirst>& a, const std::array<T, kSecond>& b) {
  return [&]<std::size_t... I, std::size_t... J>(std::index_sequence<I...>, std::index_sequence<J...>) {
    return std::array<T, kFirst + kSecond>{a[I]..., b[J]...};
  }
  (std::make_index_sequence<kFirst>(), std::make_index_sequence<kSecond>());
}

}  // namespace retrace
