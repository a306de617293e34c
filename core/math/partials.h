#pragma once

// Automatic differentiation with respect to two variables: values with first, or first and second, partial derivatives
// for the elementary functions of formulas. Derivatives along a line are in jets.h.

#include <cmath>
#include <type_traits>

namespace retrace::jets {

struct NoSecondPartials {};
struct SecondPartials {
  double xx = 0.0;
  double xy = 0.0;
  double yy = 0.0;
};

/// A value with its partial derivatives with respect to x and y up to an order of 1 or 2.
template <int Order>
struct Partials : std::conditional_t<Order == 2, SecondPartials, NoSecondPartials> {
  double value = 0.0;
  double x = 0.0;
  double y = 0.0;

  Partials() = default;
  Partials(double v, double by_x = 0.0, double by_y = 0.0) : value(v), x(by_x), y(by_y) {}  // NOLINT: for constants
  Partials(double v, double by_x, double by_y, double by_xx, double by_xy, double by_yy) requires(Order == 2)
      : SecondPartials{by_xx, by_xy, by_yy}, value(v), x(by_x), y(by_y) {}

  bool is_finite() const {
    const bool is_first = std::isfinite(value) && std::isfinite(x) && std::isfinite(y);
    if constexpr (Order == 2) return is_first && std::isfinite(this->xx + this->xy + this->yy);
    return is_first;
  }
};

/// Height and slopes of a surface.
using Gradient = Partials<1>;

template <int Order>
double value_of(const Partials<Order>& a) {
  return a.value;
}

/// Applies f component-wise to both arguments.
template <int Order, class F>
Partials<Order> componentwise(const Partials<Order>& a, const Partials<Order>& b, const F& f) {
  Partials<Order> r(f(a.value, b.value), f(a.x, b.x), f(a.y, b.y));
  if constexpr (Order == 2) static_cast<SecondPartials&>(r) = {f(a.xx, b.xx), f(a.xy, b.xy), f(a.yy, b.yy)};
  return r;
}
template <int Order>
Partials<Order> operator-(const Partials<Order>& a) {
  return componentwise(a, a, [](double p, double) { return -p; });
}
template <int Order>
Partials<Order> operator+(const Partials<Order>& a, const Partials<Order>& b) {
  return componentwise(a, b, [](double p, double q) { return p + q; });
}
template <int Order>
Partials<Order> operator-(const Partials<Order>& a, const Partials<Order>& b) {
  return componentwise(a, b, [](double p, double q) { return p - q; });
}
template <int Order>
Partials<Order> operator*(const Partials<Order>& a, const Partials<Order>& b) {
  Partials<Order> r(a.value * b.value, a.x * b.value + a.value * b.x, a.y * b.value + a.value * b.y);
  if constexpr (Order == 2)
    static_cast<SecondPartials&>(r) = {a.xx * b.value + 2.0 * a.x * b.x + a.value * b.xx,
                                       a.xy * b.value + a.x * b.y + a.y * b.x + a.value * b.xy,
                                       a.yy * b.value + 2.0 * a.y * b.y + a.value * b.yy};
  return r;
}
template <int Order>
Partials<Order> operator/(const Partials<Order>& a, const Partials<Order>& b) {
  const double value = a.value / b.value;
  Partials<Order> r(value, (a.x - value * b.x) / b.value, (a.y - value * b.y) / b.value);
  if constexpr (Order == 2)
    static_cast<SecondPartials&>(r) = {(a.xx - 2.0 * r.x * b.x - value * b.xx) / b.value,
                                       (a.xy - r.x * b.y - r.y * b.x - value * b.xy) / b.value,
                                       (a.yy - 2.0 * r.y * b.y - value * b.yy) / b.value};
  return r;
}

template <int Order>
Partials<Order> operator+(Partials<Order> a, double b) {
  a.value += b;
  return a;
}
template <int Order>
Partials<Order> operator+(double a, const Partials<Order>& b) {
  return b + a;
}
template <int Order>
Partials<Order> operator-(const Partials<Order>& a, double b) {
  return a + -b;
}
template <int Order>
Partials<Order> operator-(double a, const Partials<Order>& b) {
  return -b + a;
}
template <int Order>
Partials<Order> operator*(const Partials<Order>& a, double b) {
  return componentwise(a, a, [b](double p, double) { return p * b; });
}
template <int Order>
Partials<Order> operator*(double a, const Partials<Order>& b) {
  return b * a;
}
template <int Order>
Partials<Order> operator/(const Partials<Order>& a, double b) {
  return a * (1.0 / b);
}
template <int Order>
Partials<Order> operator/(double a, const Partials<Order>& b) {
  return Partials<Order>(a) / b;
}

/// Returns f(a) by the chain rule.
/// \param f value of f at a.value
/// \param f1 first derivative of f at a.value
/// \param f2 second derivative of f at a.value
template <int Order>
Partials<Order> chained(const Partials<Order>& a, double f, double f1, double f2) {
  Partials<Order> r(f, f1 * a.x, f1 * a.y);
  if constexpr (Order == 2)
    static_cast<SecondPartials&>(r) = {f2 * a.x * a.x + f1 * a.xx, f2 * a.x * a.y + f1 * a.xy,
                                       f2 * a.y * a.y + f1 * a.yy};
  return r;
}
template <int Order>
Partials<Order> sqrt(const Partials<Order>& a) {
  const double root = std::sqrt(a.value);
  return chained(a, root, 0.5 / root, -0.25 / (a.value * root));
}
template <int Order>
Partials<Order> exp(const Partials<Order>& a) {
  const double e = std::exp(a.value);
  return chained(a, e, e, e);
}
template <int Order>
Partials<Order> log(const Partials<Order>& a) {
  return chained(a, std::log(a.value), 1.0 / a.value, -1.0 / (a.value * a.value));
}
template <int Order>
Partials<Order> sin(const Partials<Order>& a) {
  const double s = std::sin(a.value);
  return chained(a, s, std::cos(a.value), -s);
}
template <int Order>
Partials<Order> cos(const Partials<Order>& a) {
  const double c = std::cos(a.value);
  return chained(a, c, -std::sin(a.value), -c);
}
template <int Order>
Partials<Order> atan2(const Partials<Order>& y, const Partials<Order>& x) {
  // The derivative of the angle is (x y' - y x') / (x^2 + y^2). The second derivatives are derivatives of this
  // quotient.
  const double square = x.value * x.value + y.value * y.value;
  Partials<Order> r(std::atan2(y.value, x.value), (x.value * y.x - y.value * x.x) / square,
                    (x.value * y.y - y.value * x.y) / square);
  if constexpr (Order == 2) {
    const double square_x = 2.0 * (x.value * x.x + y.value * y.x);
    const double square_y = 2.0 * (x.value * x.y + y.value * y.y);
    static_cast<SecondPartials&>(r) = {
        (x.value * y.xx - y.value * x.xx - r.x * square_x) / square,
        (x.value * y.xy - y.value * x.xy + x.y * y.x - y.y * x.x - r.x * square_y) / square,
        (x.value * y.yy - y.value * x.yy - r.y * square_y) / square};
  }
  return r;
}
/// Returns a^n. At a = 0, the result has all derivatives that exist, whereas exp(n log a) is undefined there.
template <int Order>
Partials<Order> constant_power(const Partials<Order>& a, double n) {
  const auto term = [&](double factor, double exponent) {
    return factor == 0.0 ? 0.0 : factor * std::pow(a.value, exponent);
  };
  return chained(a, std::pow(a.value, n), term(n, n - 1.0), term(n * (n - 1.0), n - 2.0));
}

}  // namespace retrace::jets
