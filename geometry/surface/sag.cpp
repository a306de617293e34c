#include "geometry/surface/sag.h"

#include <array>
#include <cmath>

#include "core/math/formula_evaluation.h"
#include "core/math/interval.h"
#include "geometry/surface/patch_surface.h"

namespace retrace::geometry {
namespace {

using jets::binomial;
using jets::constant_like;
using jets::Gradient;
using jets::horner;
using jets::Jet2;
using jets::Series;

double factorial(int n) {
  double f = 1.0;
  for (int k = 2; k <= n; ++k) f *= k;
  return f;
}

/// Adds value * x^i y^j (x^2 + y^2)^power to a polynomial.
void add_ring(XyPolynomial& p, int i, int j, int power, double value) {
  for (int k = 0; k <= power; ++k)
    p.coefficients[p.index(i + 2 * (power - k), j + 2 * k)] += value * binomial(power, k);
}

/// Adds a Zernike term: its radial polynomial times the real or imaginary part of (x + i y)^|m|.
void add_term(XyPolynomial& p, const ZernikeTerm& term) {
  const int m = std::abs(term.m);
  const double norm = std::sqrt((term.n + 1.0) * (m == 0 ? 1.0 : 2.0));
  for (int k = 0; 2 * k <= term.n - m; ++k) {
    const double radial = (k % 2 == 0 ? 1.0 : -1.0) * factorial(term.n - k) /
                          (factorial(k) * factorial((term.n + m) / 2 - k) * factorial((term.n - m) / 2 - k));
    const int power = (term.n - m) / 2 - k;
    for (int j = term.m < 0 ? 1 : 0; j <= m; j += 2) {
      const double sign = (j / 2) % 2 == 0 ? 1.0 : -1.0;
      add_ring(p, m - j, j, power, term.coefficient_mm * norm * radial * sign * binomial(m, j));
    }
  }
}

template <class T>
T evaluate_asphere(const Asphere& a, const T& x, const T& y) {
  using std::sqrt;
  using Across = Asphere::Across;
  const T s = a.across == Across::radius ? x * x + y * y : a.across == Across::x ? x * x : y * y;
  T z = s * a.curvature_per_mm;
  if (a.curvature_per_mm != 0.0 && a.conic != -1.0)
    z = z / (sqrt(1.0 - s * ((1.0 + a.conic) * a.curvature_per_mm * a.curvature_per_mm)) + 1.0);
  else
    z = z * 0.5;
  if (!a.even.empty()) z = z + s * s * horner(a.even.data(), static_cast<int>(a.even.size()), s);
  return z;
}

template <class T>
T evaluate_biconic(const Biconic& b, const T& x, const T& y) {
  using std::sqrt;
  const auto [cx, cy] = b.curvatures_per_mm;
  const T xx = x * x;
  const T yy = y * y;
  const T under_root = 1.0 - (xx * ((1.0 + b.conics[0]) * cx * cx) + yy * ((1.0 + b.conics[1]) * cy * cy));
  return (xx * cx + yy * cy) / (sqrt(under_root) + 1.0);
}

/// Evaluates a polynomial by Horner's rule in y, nested in Horner's rule in x.
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
  // Polar variables have no derivatives at the centre. They are computed only if the formula uses them.
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
  if (polynomial && !has_asphere && !biconic) return evaluate_polynomial(*polynomial, x, y);
  T z = has_asphere ? evaluate_asphere(asphere, x, y) : constant_like(x, 0.0);
  if (biconic) z = z + evaluate_biconic(*biconic, x, y);
  return polynomial ? z + evaluate_polynomial(*polynomial, x, y) : z;
}

template <class T>
T Sag::evaluate(const T& x, const T& y) const {
  T z = evaluate_without_formula(x, y);
  if (patches) z = z + patches->evaluate(x, y);
  return formula ? z + evaluate_formula(*formula, x, y, position_mm) : z;
}

/// Types with which heights are evaluated, for lenslets, blends, extrapolations and proofs.
template <class T>
using Line = Series<T>;
template <class T>
using Upward = Series<T, 1>;
template <int N>
using Along = Series<double, N>;
template <int N>
using Blend = Series<Jet2, N>;
using Enclosure = Series<Interval, 2>;
template <int N>
using EnclosedBlend = Series<Enclosure, N>;
template double Sag::evaluate(const double&, const double&) const;
template Gradient Sag::evaluate(const Gradient&, const Gradient&) const;
template Jet Sag::evaluate(const Jet&, const Jet&) const;
template Along<1> Sag::evaluate(const Along<1>&, const Along<1>&) const;
template Along<2> Sag::evaluate(const Along<2>&, const Along<2>&) const;
template Along<3> Sag::evaluate(const Along<3>&, const Along<3>&) const;
template Along<4> Sag::evaluate(const Along<4>&, const Along<4>&) const;
template Line<double> Sag::evaluate(const Line<double>&, const Line<double>&) const;
template Line<Gradient> Sag::evaluate(const Line<Gradient>&, const Line<Gradient>&) const;
template Line<Jet2> Sag::evaluate(const Line<Jet2>&, const Line<Jet2>&) const;
template Line<Line<double>> Sag::evaluate(const Line<Line<double>>&, const Line<Line<double>>&) const;
template Line<Line<Gradient>> Sag::evaluate(const Line<Line<Gradient>>&, const Line<Line<Gradient>>&) const;
template Line<Line<Jet2>> Sag::evaluate(const Line<Line<Jet2>>&, const Line<Line<Jet2>>&) const;
template Line<Line<Line<double>>> Sag::evaluate(const Line<Line<Line<double>>>&, const Line<Line<Line<double>>>&) const;
template Upward<Gradient> Sag::evaluate(const Upward<Gradient>&, const Upward<Gradient>&) const;
template Upward<Line<double>> Sag::evaluate(const Upward<Line<double>>&, const Upward<Line<double>>&) const;
template Blend<1> Sag::evaluate(const Blend<1>&, const Blend<1>&) const;
template Blend<2> Sag::evaluate(const Blend<2>&, const Blend<2>&) const;
template Blend<3> Sag::evaluate(const Blend<3>&, const Blend<3>&) const;
template Blend<4> Sag::evaluate(const Blend<4>&, const Blend<4>&) const;
template Enclosure Sag::evaluate_without_formula(const Enclosure&, const Enclosure&) const;
template Blend<1> Sag::evaluate_without_formula(const Blend<1>&, const Blend<1>&) const;
template Blend<2> Sag::evaluate_without_formula(const Blend<2>&, const Blend<2>&) const;
template Blend<3> Sag::evaluate_without_formula(const Blend<3>&, const Blend<3>&) const;
template Blend<4> Sag::evaluate_without_formula(const Blend<4>&, const Blend<4>&) const;
template EnclosedBlend<1> Sag::evaluate_without_formula(const EnclosedBlend<1>&, const EnclosedBlend<1>&) const;
template EnclosedBlend<2> Sag::evaluate_without_formula(const EnclosedBlend<2>&, const EnclosedBlend<2>&) const;
template EnclosedBlend<3> Sag::evaluate_without_formula(const EnclosedBlend<3>&, const EnclosedBlend<3>&) const;
template EnclosedBlend<4> Sag::evaluate_without_formula(const EnclosedBlend<4>&, const EnclosedBlend<4>&) const;

std::vector<std::string> sag_variables() {
  return {"x", "y", "r", "theta", "cx", "cy"};
}

}  // namespace retrace::geometry
