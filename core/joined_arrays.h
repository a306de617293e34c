#pragma once

// Concatenation of arrays at compile time, for constant tables that share rows.

#include <array>
#include <cstddef>
#include <utility>

namespace retrace {

/// Returns an array with the elements of `a`, followed by those of `b`.
template <class T, std::size_t N, std::size_t M>
constexpr std::array<T, N + M> joined(const std::array<T, N>& a, const std::array<T, M>& b) {
  return [&]<std::size_t... I, std::size_t... J>(std::index_sequence<I...>, std::index_sequence<J...>) {
    return std::array<T, N + M>{a[I]..., b[J]...};
  }
  (std::make_index_sequence<N>(), std::make_index_sequence<M>());
}

}  // namespace retrace
