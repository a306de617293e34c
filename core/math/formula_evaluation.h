#pragma once

// Defines Formula::evaluate(). Include this header only in .cpp files that evaluate formulas for their own number
// types.

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "core/math/formula.h"
#include "core/math/jets.h"
#include "core/math/partials.h"

namespace retrace {
namespace formula_steps {

using jets::constant_like;
using jets::power;

template <class T>
T absolute(const T& a) {
  return jets::value_of(a) < 0.0 ? -a : a;
}

template <class T>
T arc_tangent(const T& y) {
  using std::atan2;
  return atan2(y, constant_like(y, 1.0));
}

template <class T>
T hyperbolic_sine(const T& a) {
  using std::exp;
  return (exp(a) - exp(-a)) * 0.5;
}
template <class T>
T hyperbolic_cosine(const T& a) {
  using std::exp;
  return (exp(a) + exp(-a)) * 0.5;
}
/// Computes the hyperbolic tangent. Uses exp(-2 |a|), which cannot overflow.
template <class T>
T hyperbolic_tangent(const T& a) {
  using std::exp;
  const bool is_negative = jets::value_of(a) < 0.0;
  const T e = exp(a * (is_negative ? 2.0 : -2.0));
  const T one = constant_like(a, 1.0);
  return (is_negative ? e - one : one - e) / (one + e);
}

/// Returns `a` to the power `exponent`, which is not an integer. Number types with a better method overload this
/// function.
template <class T>
T constant_power(const T& a, double exponent) {
  using std::exp;
  using std::log;
  return exp(log(a) * exponent);
}

inline double constant_power(double a, double exponent) {
  return std::pow(a, exponent);
}

/// Returns a^b. Integer exponents are computed as products, which are also defined if a is not positive.
template <class T>
T to_the_power(const T& a, const T& b, const Formula::Node& exponent) {
  using std::exp;
  using std::log;
  if (exponent.step != Formula::Step::constant) return exp(b * log(a));
  const double e = exponent.number;
  if (e != std::floor(e) || std::abs(e) > 64.0) return constant_power(a, e);
  const T positive = power(a, static_cast<int>(std::abs(e)));
  return e < 0.0 ? constant_like(a, 1.0) / positive : positive;
}

template <class T>
T one_step(const Formula::Node& node, const T* v, const T* variables, const std::vector<Formula::Node>& nodes) {
  using Step = Formula::Step;
  using jets::constant_like;
  using std::atan2;
  using std::cos;
  using std::exp;
  using std::log;
  using std::sin;
  using std::sqrt;
  const auto index = [](int i) { return static_cast<std::size_t>(i); };
  if (node.step == Step::constant) return constant_like(variables[0], node.number);
  if (node.step == Step::variable) return variables[node.a];
  const T& a = v[index(node.a)];
  const T& b = v[index(node.b)];
  const T one = constant_like(a, 1.0);
  switch (node.step) {
    case Step::add: return a + b;
    case Step::subtract: return a - b;
    case Step::multiply: return a * b;
    case Step::divide: return a / b;
    case Step::negate: return -a;
    case Step::power: return to_the_power(a, b, nodes[index(node.b)]);
    case Step::sqrt: return sqrt(a);
    case Step::exp: return exp(a);
    case Step::log: return log(a);
    case Step::sin: return sin(a);
    case Step::cos: return cos(a);
    case Step::tan: return sin(a) / cos(a);
    case Step::asin: return atan2(a, sqrt(one - a * a));
    case Step::acos: return atan2(sqrt(one - a * a), a);
    case Step::atan: return arc_tangent(a);
    case Step::atan2: return atan2(a, b);
    case Step::sinh: return hyperbolic_sine(a);
    case Step::cosh: return hyperbolic_cosine(a);
    case Step::tanh: return hyperbolic_tangent(a);
    case Step::abs: return absolute(a);
    case Step::constant:
    case Step::variable: break;
  }
  return one;
}

}  // namespace formula_steps

template <class T>
T Formula::evaluate(const T* variables) const {
  const auto fill = [&](T* values) {
    for (std::size_t i = 0; i < nodes.size(); ++i)
      values[i] = formula_steps::one_step(nodes[i], values, variables, nodes);
    return values[nodes.size() - 1];
  };
  // Short formulas for small number types are evaluated on the stack, without allocation.
  constexpr std::size_t kFew = 32;
  if constexpr (sizeof(T) <= 64) {
    if (nodes.size() <= kFew) {
      std::array<T, kFew> values;
      return fill(values.data());
    }
  }
  std::vector<T> values(nodes.size());
  return fill(values.data());
}

}  // namespace retrace
