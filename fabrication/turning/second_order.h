#pragma once

#include <cmath>

namespace retrace::fabrication::turning {

/// The first three terms of a Taylor series in one variable, v + a t + b t^2: what Series does to order 2, in three
/// numbers, which are doubles for paths and intervals for proofs.
template <class C>
struct SecondOrder {
  C v = C(0.0);
  C a = C(0.0);
  C b = C(0.0);

  SecondOrder() = default;
  SecondOrder(double value) : v(value) {}  // NOLINT: constants are numbers too
  SecondOrder(const C& value, const C& first, const C& second) : v(value), a(first), b(second) {}

  friend SecondOrder operator-(const SecondOrder& x) { return {-x.v, -x.a, -x.b}; }
  friend SecondOrder operator+(const SecondOrder& x, const SecondOrder& y) { return {x.v + y.v, x.a + y.a, x.b + y.b}; }
  friend SecondOrder operator-(const SecondOrder& x, const SecondOrder& y) { return {x.v - y.v, x.a - y.a, x.b - y.b}; }
  friend SecondOrder operator*(const SecondOrder& x, const SecondOrder& y) {
    return {x.v * y.v, x.v * y.a + x.a * y.v, x.v * y.b + x.a * y.a + x.b * y.v};
  }
  friend SecondOrder operator/(const SecondOrder& x, const SecondOrder& y) {
    const C v = x.v / y.v;
    const C a = (x.a - v * y.a) / y.v;
    return {v, a, (x.b - v * y.b - a * y.a) / y.v};
  }
  friend SecondOrder operator+(const SecondOrder& x, double y) { return {x.v + y, x.a, x.b}; }
  friend SecondOrder operator+(double x, const SecondOrder& y) { return y + x; }
  friend SecondOrder operator-(const SecondOrder& x, double y) { return {x.v - y, x.a, x.b}; }
  friend SecondOrder operator-(double x, const SecondOrder& y) { return {x - y.v, -y.a, -y.b}; }
  friend SecondOrder operator*(const SecondOrder& x, double y) { return {x.v * y, x.a * y, x.b * y}; }
  friend SecondOrder operator*(double x, const SecondOrder& y) { return y * x; }
  friend SecondOrder operator/(const SecondOrder& x, double y) { return {x.v / y, x.a / y, x.b / y}; }
};

/// Number of a path's series.
using Jet2 = SecondOrder<double>;

inline double value_of(const Jet2& x) {
  return x.v;
}
template <class C>
SecondOrder<C> constant_like(const SecondOrder<C>&, double value) {
  return value;
}

/// f(x) with the first and the second derivative of f there.
template <class C>
SecondOrder<C> chained(const SecondOrder<C>& x, const C& value, const C& first, const C& second) {
  return {value, first * x.a, first * x.b + 0.5 * second * (x.a * x.a)};
}
template <class C>
SecondOrder<C> sqrt(const SecondOrder<C>& x) {
  using std::sqrt;
  const C root = sqrt(x.v);
  const C first = 0.5 / root;
  return chained<C>(x, root, first, -0.5 * first / x.v);
}
template <class C>
SecondOrder<C> exp(const SecondOrder<C>& x) {
  using std::exp;
  const C e = exp(x.v);
  return chained<C>(x, e, e, e);
}
template <class C>
SecondOrder<C> log(const SecondOrder<C>& x) {
  using std::log;
  const C first = 1.0 / x.v;
  return chained<C>(x, log(x.v), first, -first * first);
}
template <class C>
SecondOrder<C> sin(const SecondOrder<C>& x) {
  using std::cos;
  using std::sin;
  const C s = sin(x.v);
  return chained<C>(x, s, cos(x.v), -s);
}
template <class C>
SecondOrder<C> cos(const SecondOrder<C>& x) {
  using std::cos;
  using std::sin;
  const C c = cos(x.v);
  return chained<C>(x, c, -sin(x.v), -c);
}
inline Jet2 atan2(const Jet2& y, const Jet2& x) {
  // The derivative is (x y' - y x') / (x^2 + y^2), itself known to the first order.
  const double square = x.v * x.v + y.v * y.v;
  const double first = (x.v * y.a - y.v * x.a) / square;
  const double top_slope = 2.0 * (x.v * y.b - y.v * x.b);
  const double square_slope = 2.0 * (x.v * x.a + y.v * y.a);
  return {std::atan2(y.v, x.v), first, 0.5 * (top_slope - first * square_slope) / square};
}

}  // namespace retrace::fabrication::turning
