#include "fabrication/turning/sag.h"

#include <array>
#include <cmath>

#include "core/math/formula_evaluation.h"
#include "fabrication/turning/interval.h"

namespace retrace::fabrication::turning {
namespace {

double factorial(int n) {
  double f = 1.0;
  for (int k = 2; k <= n; ++k) f *= k;
  return f;
}

double ring_binomial(int n, int k) {
  return factorial(n) / (factorial(k) * factorial(n - k));
}

/// Adds value * x^i y^j (x^2 + y^2)^power.
void add_ring(XyPolynomial& p, int i, int j, int power, double value) {
  for (int k = 0; k <= power; ++k)
    p.coefficients[p.index(i + 2 * (power - k), j + 2 * k)] += value * ring_binomial(power, k);
}

/// Adds one term: its radial polynomial times the real or imaginary part of (x + i y)^|m|.
void add_term(XyPolynomial& p, const ZernikeTerm& term) {
  const int m = std::abs(term.m);
  const double norm = std::sqrt((term.n + 1.0) * (m == 0 ? 1.0 : 2.0));
  for (int k = 0; 2 * k <= term.n - m; ++k) {
    const double radial = (k % 2 == 0 ? 1.0 : -1.0) * factorial(term.n - k) /
                          (factorial(k) * factorial((term.n + m) / 2 - k) * factorial((term.n - m) / 2 - k));
    const int power = (term.n - m) / 2 - k;
    for (int j = term.m < 0 ? 1 : 0; j <= m; j += 2) {
      const double sign = (j / 2) % 2 == 0 ? 1.0 : -1.0;
      add_ring(p, m - j, j, power, term.coefficient_mm * norm * radial * sign * ring_binomial(m, j));
    }
  }
}

template <class T>
T evaluate_asphere(const Asphere& a, const T& x, const T& y) {
  using std::sqrt;
  const T s = x * x + y * y;
  T z = s * a.curvature_per_mm;
  if (a.curvature_per_mm != 0.0 && a.conic != -1.0)
    z = z / (sqrt(1.0 - s * ((1.0 + a.conic) * a.curvature_per_mm * a.curvature_per_mm)) + 1.0);
  else
    z = z * 0.5;
  if (!a.even.empty()) z = z + s * s * horner(a.even.data(), static_cast<int>(a.even.size()), s);
  return z;
}

/// Horner's rule in y within Horner's rule in x.
template <class T>
T evaluate_polynomial(const XyPolynomial& p, const T& x_mm, const T& y_mm) {
  const T x = x_mm * (1.0 / p.scale_mm);
  const T y = y_mm * (1.0 / p.scale_mm);
  T sum = constant_like(x, p.coefficients[p.index(p.degree, 0)]);
  for (int i = p.degree - 1; i >= 0; --i) sum = sum * x + horner(&p.coefficients[p.index(i, 0)], p.degree - i + 1, y);
  return sum;
}

template <class T>
T evaluate_formula(const Formula& formula, const T& x, const T& y, const std::array<double, 2>& place_mm) {
  using std::atan2;
  using std::sqrt;
  const T none = constant_like(x, 0.0);
  // Polar variables have no derivatives at the centre; there they must not spoil a formula that has none of them.
  const std::array<T, 6> variables = {x,
                                      y,
                                      formula.uses(2) ? sqrt(x * x + y * y) : none,
                                      formula.uses(3) ? atan2(y, x) : none,
                                      constant_like(x, place_mm[0]),
                                      constant_like(x, place_mm[1])};
  return formula.evaluate(variables.data());
}

}  // namespace

XyPolynomial polynomial_of(const std::vector<ZernikeTerm>& terms, double radius_mm) {
  XyPolynomial p;
  p.scale_mm = radius_mm;
  for (const ZernikeTerm& term : terms) p.degree = std::max(p.degree, term.n);
  p.coefficients.assign(XyPolynomial::count(p.degree), 0.0);
  for (const ZernikeTerm& term : terms) add_term(p, term);
  return p;
}

template <class T>
T Sag::evaluate_without_formula(const T& x, const T& y) const {
  const bool has_asphere = asphere.curvature_per_mm != 0.0 || !asphere.even.empty();
  if (polynomial && !has_asphere) return evaluate_polynomial(*polynomial, x, y);
  const T z = has_asphere ? evaluate_asphere(asphere, x, y) : constant_like(x, 0.0);
  return polynomial ? z + evaluate_polynomial(*polynomial, x, y) : z;
}

template <class T>
T Sag::evaluate(const T& x, const T& y) const {
  const T z = evaluate_without_formula(x, y);
  return formula ? z + evaluate_formula(*formula, x, y, place_mm) : z;
}

template double Sag::evaluate(const double&, const double&) const;
template Gradient Sag::evaluate(const Gradient&, const Gradient&) const;
template Jet2 Sag::evaluate(const Jet2&, const Jet2&) const;
template Series<double> Sag::evaluate(const Series<double>&, const Series<double>&) const;
template Series<Gradient> Sag::evaluate(const Series<Gradient>&, const Series<Gradient>&) const;
template Series<Jet2> Sag::evaluate(const Series<Jet2>&, const Series<Jet2>&) const;
template Series<Series<double>> Sag::evaluate(const Series<Series<double>>&, const Series<Series<double>>&) const;
template Series<double, 1> Sag::evaluate(const Series<double, 1>&, const Series<double, 1>&) const;
template Series<Gradient, 1> Sag::evaluate(const Series<Gradient, 1>&, const Series<Gradient, 1>&) const;
template Series<Series<double>, 1> Sag::evaluate(const Series<Series<double>, 1>&,
                                                 const Series<Series<double>, 1>&) const;
template Series<Jet2, 1> Sag::evaluate(const Series<Jet2, 1>&, const Series<Jet2, 1>&) const;
template Series<Jet2, 2> Sag::evaluate(const Series<Jet2, 2>&, const Series<Jet2, 2>&) const;
template Series<Jet2, 3> Sag::evaluate(const Series<Jet2, 3>&, const Series<Jet2, 3>&) const;
template Series<Jet2, 4> Sag::evaluate(const Series<Jet2, 4>&, const Series<Jet2, 4>&) const;
template Series<Interval, 2> Sag::evaluate_without_formula(const Series<Interval, 2>&,
                                                           const Series<Interval, 2>&) const;
template Series<Jet2, 1> Sag::evaluate_without_formula(const Series<Jet2, 1>&, const Series<Jet2, 1>&) const;
template Series<Jet2, 2> Sag::evaluate_without_formula(const Series<Jet2, 2>&, const Series<Jet2, 2>&) const;
template Series<Jet2, 3> Sag::evaluate_without_formula(const Series<Jet2, 3>&, const Series<Jet2, 3>&) const;
template Series<Jet2, 4> Sag::evaluate_without_formula(const Series<Jet2, 4>&, const Series<Jet2, 4>&) const;
template Series<Series<Interval, 2>, 1> Sag::evaluate_without_formula(const Series<Series<Interval, 2>, 1>&,
                                                                      const Series<Series<Interval, 2>, 1>&) const;
template Series<Series<Interval, 2>, 2> Sag::evaluate_without_formula(const Series<Series<Interval, 2>, 2>&,
                                                                      const Series<Series<Interval, 2>, 2>&) const;
template Series<Series<Interval, 2>, 3> Sag::evaluate_without_formula(const Series<Series<Interval, 2>, 3>&,
                                                                      const Series<Series<Interval, 2>, 3>&) const;
template Series<Series<Interval, 2>, 4> Sag::evaluate_without_formula(const Series<Series<Interval, 2>, 4>&,
                                                                      const Series<Series<Interval, 2>, 4>&) const;

std::vector<std::string> sag_variables() {
  return {"x", "y", "r", "theta", "cx", "cy"};
}

}  // namespace retrace::fabrication::turning
