#pragma once

// Automatic differentiation along a line: truncated Taylor series in one variable for the elementary functions of
// formulas (A. Griewank, A. Walther, Evaluating Derivatives, 2nd ed., SIAM 2008, tables 13.1 and 13.2). The
// coefficients are doubles, intervals for proofs, or numbers that contain derivatives themselves, so that series can be
// nested. Derivatives with respect to two variables are in partials.h.

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <utility>

namespace retrace::jets {

/// Maximum order of the derivatives of a series.
inline constexpr int kMaxOrder = 9;
/// Template argument for a series whose order is known only at run time.
inline constexpr int kAnyOrder = -1;

/// Order of a series. It is fixed by the type (N >= 0) or stored in the object (N = kAnyOrder).
template <int N>
struct Length {
  static constexpr int order = N;

  Length() = default;
  explicit Length(int) {}
};
template <>
struct Length<kAnyOrder> {
  int order = 0;

  Length() = default;
  explicit Length(int length) : order(length) {}
};

/// Truncated Taylor series c[0] + c[1] t + ... + c[order] t^order. The result of an operation has the smaller order of
/// its operands. A series whose order is fixed by its type is faster, because the compiler unrolls the loops. Tool
/// paths and proofs mostly use order 2. It is therefore implemented without loops, so that the coefficients stay in
/// registers.
template <class T, int N = kAnyOrder>
struct Series : Length<N> {
  std::array<T, static_cast<std::size_t>(N == kAnyOrder ? kMaxOrder : N) + 1> c{};  ///< coefficients up to `order`

  Series() = default;
  explicit Series(int length) : Length<N>(length) {}
  Series(const T& value, const T& first, const T& second) requires(N == 2) : c{{value, first, second}} {}
  T& operator[](int k) { return c[static_cast<std::size_t>(k)]; }
  const T& operator[](int k) const { return c[static_cast<std::size_t>(k)]; }
};

/// Height, slope and half of the second derivative of a surface along a line.
using Jet2 = Series<double, 2>;

/// Returns a constant as a series of the same order as `like`.
template <std::constructible_from<double> T>
T constant_like(const T&, double value) {
  return T(value);
}
template <class T, int N>
Series<T, N> constant_like(const Series<T, N>& like, double value) {
  Series<T, N> s(like.order);
  s[0] = constant_like(like[0], value);
  for (int k = 1; k <= like.order; ++k) s[k] = constant_like(like[0], 0.0);
  return s;
}

/// Returns the series value + slope t of the given order.
template <class T, int N = kAnyOrder>
Series<T, N> line_series(const T& value, const T& slope, int order) {
  Series<T, N> s(order);
  s[0] = value;
  if (s.order > 0) s[1] = slope;
  for (int k = 2; k <= s.order; ++k) s[k] = constant_like(value, 0.0);
  return s;
}

inline double value_of(double a) {
  return a;
}
template <class T, int N>
double value_of(const Series<T, N>& a) {
  return value_of(a[0]);
}

template <class T, int N>
Series<T, N> operator-(const Series<T, N>& a) {
  if constexpr (N == 2) return {-a[0], -a[1], -a[2]};
  Series<T, N> r(a.order);
  for (int k = 0; k <= r.order; ++k) r[k] = -a[k];
  return r;
}
template <class T, int N>
Series<T, N> operator+(const Series<T, N>& a, const Series<T, N>& b) {
  if constexpr (N == 2) return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
  Series<T, N> r(std::min(a.order, b.order));
  for (int k = 0; k <= r.order; ++k) r[k] = a[k] + b[k];
  return r;
}
template <class T, int N>
Series<T, N> operator-(const Series<T, N>& a, const Series<T, N>& b) {
  if constexpr (N == 2) return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
  Series<T, N> r(std::min(a.order, b.order));
  for (int k = 0; k <= r.order; ++k) r[k] = a[k] - b[k];
  return r;
}
template <class T, int N>
Series<T, N> operator*(const Series<T, N>& a, const Series<T, N>& b) {
  if constexpr (N == 2) return {a[0] * b[0], a[0] * b[1] + a[1] * b[0], a[0] * b[2] + a[1] * b[1] + a[2] * b[0]};
  Series<T, N> r(std::min(a.order, b.order));
  for (int k = 0; k <= r.order; ++k) {
    T sum = a[0] * b[k];
    for (int i = 1; i <= k; ++i) sum = sum + a[i] * b[k - i];
    r[k] = sum;
  }
  return r;
}
template <class T, int N>
Series<T, N> operator/(const Series<T, N>& a, const Series<T, N>& b) {
  if constexpr (N == 2) {
    const T value = a[0] / b[0];
    const T first = (a[1] - value * b[1]) / b[0];
    return {value, first, (a[2] - value * b[2] - first * b[1]) / b[0]};
  }
  Series<T, N> r(std::min(a.order, b.order));
  for (int k = 0; k <= r.order; ++k) {
    T sum = a[k];
    for (int i = 1; i <= k; ++i) sum = sum - b[i] * r[k - i];
    r[k] = sum / b[0];
  }
  return r;
}

template <class T, int N>
Series<T, N> operator+(Series<T, N> a, double b) {
  a[0] = a[0] + b;
  return a;
}
template <class T, int N>
Series<T, N> operator+(double a, Series<T, N> b) {
  return std::move(b) + a;
}
template <class T, int N>
Series<T, N> operator-(Series<T, N> a, double b) {
  return std::move(a) + (-b);
}
template <class T, int N>
Series<T, N> operator-(double a, const Series<T, N>& b) {
  return -b + a;
}
template <class T, int N>
Series<T, N> operator*(Series<T, N> a, double b) {
  if constexpr (N == 2) return {a[0] * b, a[1] * b, a[2] * b};
  for (int k = 0; k <= a.order; ++k) a[k] = a[k] * b;
  return a;
}
template <class T, int N>
Series<T, N> operator*(double a, Series<T, N> b) {
  return std::move(b) * a;
}
template <class T, int N>
Series<T, N> operator/(Series<T, N> a, double b) {
  return std::move(a) * (1.0 / b);
}
template <class T, int N>
Series<T, N> operator/(double a, const Series<T, N>& b) {
  return constant_like(b, a) / b;
}

/// Returns f(a) by the chain rule.
/// \param value f at a[0]
/// \param first first derivative of f at a[0]
/// \param second second derivative of f at a[0]
template <class T>
Series<T, 2> chained(const Series<T, 2>& a, const T& value, const T& first, const T& second) {
  return {value, first * a[1], first * a[2] + 0.5 * second * (a[1] * a[1])};
}
template <class T, int N>
Series<T, N> sqrt(const Series<T, N>& a) {
  using std::sqrt;
  if constexpr (N == 2) {
    const T root = sqrt(a[0]);
    const T first = 0.5 / root;
    return chained<T>(a, root, first, -0.5 * first / a[0]);
  }
  Series<T, N> r(a.order);
  r[0] = sqrt(a[0]);
  for (int k = 1; k <= a.order; ++k) {
    T sum = a[k];
    for (int i = 1; i < k; ++i) sum = sum - r[i] * r[k - i];
    r[k] = sum / (r[0] + r[0]);
  }
  return r;
}
template <class T, int N>
Series<T, N> exp(const Series<T, N>& a) {
  using std::exp;
  if constexpr (N == 2) {
    const T e = exp(a[0]);
    return chained<T>(a, e, e, e);
  }
  Series<T, N> r(a.order);
  r[0] = exp(a[0]);
  for (int k = 1; k <= a.order; ++k) {
    T sum = constant_like(a[0], 0.0);
    for (int i = 1; i <= k; ++i) sum = sum + static_cast<double>(i) * a[i] * r[k - i];
    r[k] = sum / static_cast<double>(k);
  }
  return r;
}
/// Returns the antiderivative of `slope` with the value `start` at t = 0. Coefficients beyond `order` are dropped.
template <class T, int N>
Series<T, N> integral(const T& start, const Series<T, N>& slope, int order) {
  Series<T, N> r(order);
  r[0] = start;
  // `last` equals r.order. The second argument of std::min is an upper bound that the compiler cannot derive itself.
  const int last = std::min(r.order, static_cast<int>(r.c.size()) - 1);
  for (int k = 1; k <= last; ++k) r[k] = slope[k - 1] / static_cast<double>(k);
  return r;
}
/// Returns the derivative. Its last coefficient is unknown and set to 0.
template <class T, int N>
Series<T, N> derivative(const Series<T, N>& a) {
  Series<T, N> r(a.order);
  for (int k = 0; k < a.order; ++k) r[k] = static_cast<double>(k + 1) * a[k + 1];
  r[a.order] = constant_like(a[0], 0.0);
  return r;
}
template <class T, int N>
Series<T, N> log(const Series<T, N>& a) {
  using std::log;
  return integral(log(a[0]), derivative(a) / a, a.order);
}
template <class T, int N>
struct SinCos {
  Series<T, N> sine, cosine;
};
/// Computes sine and cosine together, because their recurrences depend on each other.
template <class T, int N>
SinCos<T, N> sin_cos(const Series<T, N>& a) {
  using std::cos;
  using std::sin;
  if constexpr (N == 2) {
    const T value_s = sin(a[0]);
    const T value_c = cos(a[0]);
    return {chained<T>(a, value_s, value_c, -value_s), chained<T>(a, value_c, -value_s, -value_c)};
  }
  Series<T, N> s(a.order);
  Series<T, N> c(a.order);
  s[0] = sin(a[0]);
  c[0] = cos(a[0]);
  for (int k = 1; k <= a.order; ++k) {
    T sum_s = constant_like(a[0], 0.0);
    T sum_c = constant_like(a[0], 0.0);
    for (int i = 1; i <= k; ++i) {
      sum_s = sum_s + static_cast<double>(i) * a[i] * c[k - i];
      sum_c = sum_c + static_cast<double>(i) * a[i] * s[k - i];
    }
    s[k] = sum_s / static_cast<double>(k);
    c[k] = -sum_c / static_cast<double>(k);
  }
  return {s, c};
}
template <class T, int N>
Series<T, N> sin(const Series<T, N>& a) {
  return sin_cos(a).sine;
}
template <class T, int N>
Series<T, N> cos(const Series<T, N>& a) {
  return sin_cos(a).cosine;
}
template <class T, int N>
Series<T, N> atan2(const Series<T, N>& y, const Series<T, N>& x) {
  using std::atan2;
  const Series<T, N> slope = (x * derivative(y) - y * derivative(x)) / (x * x + y * y);
  return integral(atan2(y[0], x[0]), slope, std::min(x.order, y.order));
}

inline double binomial(int n, int k) {
  double b = 1.0;
  for (int i = 1; i <= k; ++i) b = b * (n - k + i) / i;
  return b;
}

/// Returns `a` raised to the power `exponent`, an integer >= 0. The derivatives are also correct if the value of `a` is
/// 0.
template <class T>
T power(const T& a, int exponent) {
  T result = constant_like(a, 1.0);
  T base = a;
  for (int e = exponent; e > 0; e >>= 1) {
    if ((e & 1) != 0) result = result * base;
    if (e > 1) base = base * base;
  }
  return result;
}

/// Evaluates a polynomial with `count` coefficients by Horner's rule.
template <class T>
T horner(const double* coefficients, int count, const T& x) {
  T sum = constant_like(x, count > 0 ? coefficients[count - 1] : 0.0);
  for (int k = count - 2; k >= 0; --k) sum = sum * x + coefficients[k];
  return sum;
}

}  // namespace retrace::jets
