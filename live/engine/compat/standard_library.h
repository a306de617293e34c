#pragma once

// Range algorithms that are missing in the standard library of emscripten 3.1.6. Only the algorithms that the engine's
// sources use are defined. The file is included before each source file (cmake/RetraceLivePage.cmake).

#include <algorithm>
#include <cstddef>
#include <functional>
#include <iterator>
#include <utility>

extern "C" double jn(int order, double x);

namespace std {

template <class To, class From>
constexpr To bit_cast(const From& from) {
  return __builtin_bit_cast(To, from);
}
/// \pre nu is a whole number
inline double cyl_bessel_j(double nu, double x) {
  return ::jn(static_cast<int>(nu), x);
}

}  // namespace std

namespace std::ranges {

template <class R>
constexpr std::ptrdiff_t ssize(R&& r) {
  return std::end(r) - std::begin(r);
}
template <class R, class T, class Of = std::identity>
constexpr auto count(R&& r, const T& value, Of of = {}) {
  return std::count_if(std::begin(r), std::end(r), [&](const auto& x) { return std::invoke(of, x) == value; });
}
template <class R, class T, class Of = std::identity>
constexpr auto find(R&& r, const T& value, Of of = {}) {
  return std::find_if(std::begin(r), std::end(r), [&](const auto& x) { return std::invoke(of, x) == value; });
}
template <class R, class Test>
constexpr auto find_if(R&& r, Test test) {
  return std::find_if(std::begin(r), std::end(r), std::move(test));
}
template <class R, class Test>
constexpr auto find_if_not(R&& r, Test test) {
  return std::find_if_not(std::begin(r), std::end(r), std::move(test));
}
template <class R>
constexpr auto adjacent_find(R&& r) {
  return std::adjacent_find(std::begin(r), std::end(r));
}
template <class R, class Test>
constexpr bool any_of(R&& r, Test test) {
  return std::any_of(std::begin(r), std::end(r), [&](const auto& x) { return std::invoke(test, x); });
}
template <class R, class Test>
constexpr bool all_of(R&& r, Test test) {
  return std::all_of(std::begin(r), std::end(r), std::move(test));
}
template <class R, class Test>
constexpr bool none_of(R&& r, Test test) {
  return std::none_of(std::begin(r), std::end(r), std::move(test));
}
template <class R, class Less = std::less<>, class Of = std::identity>
constexpr auto min_element(R&& r, Less less = {}, Of of = {}) {
  return std::min_element(std::begin(r), std::end(r),
                          [&](const auto& a, const auto& b) { return less(std::invoke(of, a), std::invoke(of, b)); });
}
template <class R, class Less = std::less<>, class Of = std::identity>
constexpr auto max_element(R&& r, Less less = {}, Of of = {}) {
  return std::max_element(std::begin(r), std::end(r),
                          [&](const auto& a, const auto& b) { return less(std::invoke(of, a), std::invoke(of, b)); });
}
template <class R, class Less = std::less<>, class Of = std::identity>
constexpr void sort(R&& r, Less less = {}, Of of = {}) {
  std::sort(std::begin(r), std::end(r),
            [&](const auto& a, const auto& b) { return less(std::invoke(of, a), std::invoke(of, b)); });
}
template <class R, class Out, class Of>
constexpr void transform(R&& r, Out out, Of of) {
  std::transform(std::begin(r), std::end(r), std::move(out), std::move(of));
}
template <class A, class B, class Equal>
constexpr bool equal(A&& a, B&& b, Equal equal) {
  return std::equal(std::begin(a), std::end(a), std::begin(b), std::end(b), std::move(equal));
}

}  // namespace std::ranges
