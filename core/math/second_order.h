#pragma once

#include <cmath>

namespace retrace::jets {

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

/// A value with its first and second derivatives by x and y.
struct SecondPartials {
  double value = 0.0;
  double x = 0.0;
  double y = 0.0;
  double xx = 0.0;
  double xy = 0.0;
  double yy = 0.0;

  bool is_finite() const {
    return std::isfinite(value) && std::isfinite(x) && std::isfinite(y) && std::isfinite(xx) && std::isfinite(xy) &&
           std::isfinite(yy);
  }
};

inline double value_of(const SecondPartials& a) {
  return a.value;
}
inline SecondPartials constant_like(const SecondPartials&, double value) {
  return {value};
}

/// f(a) with the first and the second derivative of f there.
inline SecondPartials chained(const SecondPartials& a, double f, double f1, double f2) {
  return {f, f1 * a.x, f1 * a.y, f2 * a.x * a.x + f1 * a.xx, f2 * a.x * a.y + f1 * a.xy, f2 * a.y * a.y + f1 * a.yy};
}
inline SecondPartials operator-(const SecondPartials& a) {
  return {-a.value, -a.x, -a.y, -a.xx, -a.xy, -a.yy};
}
inline SecondPartials operator+(const SecondPartials& a, const SecondPartials& b) {
  return {a.value + b.value, a.x + b.x, a.y + b.y, a.xx + b.xx, a.xy + b.xy, a.yy + b.yy};
}
inline SecondPartials operator-(const SecondPartials& a, const SecondPartials& b) {
  return {a.value - b.value, a.x - b.x, a.y - b.y, a.xx - b.xx, a.xy - b.xy, a.yy - b.yy};
}
inline SecondPartials operator*(const SecondPartials& a, const SecondPartials& b) {
  return {a.value * b.value,
          a.x * b.value + a.value * b.x,
          a.y * b.value + a.value * b.y,
          a.xx * b.value + 2.0 * a.x * b.x + a.value * b.xx,
          a.xy * b.value + a.x * b.y + a.y * b.x + a.value * b.xy,
          a.yy * b.value + 2.0 * a.y * b.y + a.value * b.yy};
}
inline SecondPartials operator+(const SecondPartials& a, double b) {
  return chained(a, a.value + b, 1.0, 0.0);
}
inline SecondPartials operator+(double a, const SecondPartials& b) {
  return b + a;
}
inline SecondPartials operator-(const SecondPartials& a, double b) {
  return a + -b;
}
inline SecondPartials operator-(double a, const SecondPartials& b) {
  return chained(b, a - b.value, -1.0, 0.0);
}
inline SecondPartials operator*(const SecondPartials& a, double b) {
  return chained(a, a.value * b, b, 0.0);
}
inline SecondPartials operator/(const SecondPartials& a, double b) {
  return chained(a, a.value / b, 1.0 / b, 0.0);
}
inline SecondPartials operator/(const SecondPartials& a, const SecondPartials& b) {
  const double inverse = 1.0 / b.value;
  return a * chained(b, inverse, -inverse * inverse, 2.0 * inverse * inverse * inverse);
}
inline SecondPartials sqrt(const SecondPartials& a) {
  const double root = std::sqrt(a.value);
  return chained(a, root, 0.5 / root, -0.25 / (a.value * root));
}
inline SecondPartials exp(const SecondPartials& a) {
  const double e = std::exp(a.value);
  return chained(a, e, e, e);
}
inline SecondPartials log(const SecondPartials& a) {
  return chained(a, std::log(a.value), 1.0 / a.value, -1.0 / (a.value * a.value));
}
inline SecondPartials sin(const SecondPartials& a) {
  return chained(a, std::sin(a.value), std::cos(a.value), -std::sin(a.value));
}
inline SecondPartials cos(const SecondPartials& a) {
  return chained(a, std::cos(a.value), -std::sin(a.value), -std::cos(a.value));
}
inline SecondPartials atan2(const SecondPartials& y, const SecondPartials& x) {
  // The slopes of the angle are x y' - y x' over the square of the radius: a quotient, differentiated once more.
  const double square = x.value * x.value + y.value * y.value;
  const double by_x = (x.value * y.x - y.value * x.x) / square;
  const double by_y = (x.value * y.y - y.value * x.y) / square;
  const double square_x = 2.0 * (x.value * x.x + y.value * y.x);
  const double square_y = 2.0 * (x.value * x.y + y.value * y.y);
  return {std::atan2(y.value, x.value),
          by_x,
          by_y,
          (x.value * y.xx - y.value * x.xx - by_x * square_x) / square,
          (x.value * y.xy - y.value * x.xy + x.y * y.x - y.y * x.x - by_x * square_y) / square,
          (x.value * y.yy - y.value * x.yy - by_y * square_y) / square};
}
/// a^n, whose derivatives exist at 0 where those of exp(n log a) do not.
inline SecondPartials constant_power(const SecondPartials& a, double n) {
  const auto term = [&](double factor, double exponent) {
    return factor == 0.0 ? 0.0 : factor * std::pow(a.value, exponent);
  };
  return chained(a, std::pow(a.value, n), term(n, n - 1.0), term(n * (n - 1.0), n - 2.0));
}

}  // namespace retrace::jets
