#pragma once

// Heights z(x, y) as closed forms, polynomials and formulas, written once for all numbers that carry derivatives.

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/math/formula.h"
#include "core/math/partials.h"

namespace retrace::geometry {

/// Height with its first and second derivatives by x and y.
using Jet = jets::Partials<2>;

/// Conic of revolution with an even polynomial: c s / (1 + sqrt(1 - (1 + k) c^2 s)) + sum A_i s^(i + 2), s = r^2
/// (ISO 10110-12).
struct Asphere {
  double curvature_per_mm = 0.0;
  double conic = 0.0;                                          ///< k: 0 a sphere, -1 a paraboloid
  std::vector<double> even;                                    ///< A_0 of r^4 in mm^-3, A_1 of r^6, ...
  enum class Across { radius, x, y } across = Across::radius;  ///< what takes the place of r: x or y of a cylinder
};

/// sum C_ij (x / scale)^i (y / scale)^j over i + j <= degree; C in mm.
struct XyPolynomial {
  double scale_mm = 1.0;
  int degree = 0;
  std::vector<double> coefficients;  ///< rows of rising i, in them rising j

  static std::size_t count(int degree) { return static_cast<std::size_t>((degree + 1) * (degree + 2) / 2); }
  std::size_t index(int i, int j) const { return static_cast<std::size_t>(i * (degree + 1) - i * (i - 1) / 2 + j); }
};

inline constexpr int kMostPolynomialDegree = 16;

/// One Zernike term: coefficient in mm times the orthonormal polynomial of (n, m) over a disc, with cos(m theta) for
/// m >= 0 and sin(|m| theta) for m < 0 (R. J. Noll, J. Opt. Soc. Am. 66, 207, 1976; ISO 24157 signs).
struct ZernikeTerm {
  int n = 0;
  int m = 0;
  double coefficient_mm = 0.0;
};

/// The same surface as a polynomial in x / radius and y / radius: exact, as the terms are polynomials.
/// \pre 0 <= n <= kMostPolynomialDegree, |m| <= n, n - m even
XyPolynomial polynomial_of(const std::vector<ZernikeTerm>& terms, double radius_mm);

/// A sag z(x, y) in mm that holds wherever it is finite: the sum of what is given. The formula has the variables x, y,
/// r, theta, cx and cy (mm, rad).
struct Sag {
  Asphere asphere;
  std::optional<XyPolynomial> polynomial;
  std::optional<Formula> formula;
  std::array<double, 2> place_mm{};  ///< of a lenslet: cx and cy of the formula

  /// z at (x, y) with all derivatives that T carries. Not a number where the sag has no value.
  template <class T>
  T evaluate(const T& x, const T& y) const;
  /// The same less the formula: closed forms, which intervals can go through.
  template <class T>
  T evaluate_without_formula(const T& x, const T& y) const;
};

/// Names of a formula's variables, in the order in which a sag sets them.
std::vector<std::string> sag_variables();

/// Sags that are polynomials, for which lines have coefficients.
inline bool is_polynomial(const Sag& sag) {
  return !sag.formula && sag.asphere.curvature_per_mm == 0.0 && sag.asphere.across == Asphere::Across::radius;
}

}  // namespace retrace::geometry
