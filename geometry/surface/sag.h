#pragma once

// Heights z(x, y) as closed forms, polynomials and formulas. They are implemented as templates for all numeric types
// with derivatives.

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/math/formula.h"
#include "core/math/partials.h"

namespace retrace::geometry {

class PatchSurface;

/// Height with its first and second derivatives in x and y.
using Jet = jets::Partials<2>;

/// Conic of revolution plus an even polynomial: c s / (1 + sqrt(1 - (1 + k) c^2 s)) + sum A_i s^(i + 2), where s = r^2
/// (ISO 10110-12).
struct Asphere {
  double curvature_per_mm = 0.0;
  double conic = 0.0;                                          ///< k; 0 is a sphere, -1 a paraboloid
  std::vector<double> even;                                    ///< A_0 of r^4 in mm^-3, A_1 of r^6, ...
  enum class Across { radius, x, y } across = Across::radius;  ///< variable that replaces r: for cylinders x or y
};

/// Biconic surface with the height (cx x^2 + cy y^2) / (1 + sqrt(1 - (1 + kx) cx^2 x^2 - (1 + ky) cy^2 y^2)). Its
/// sections in the planes y = 0 and x = 0 are conics. If both curvatures and both conic constants are equal, the
/// surface is a conic of revolution.
struct Biconic {
  std::array<double, 2> curvatures_per_mm{};
  std::array<double, 2> conics{};
};

/// Polynomial sum C_ij (x / scale)^i (y / scale)^j over i + j <= degree. C is in mm.
struct XyPolynomial {
  double scale_mm = 1.0;
  int degree = 0;
  std::vector<double> coefficients;  ///< sorted by i, then by j

  static std::size_t count(int degree) { return static_cast<std::size_t>((degree + 1) * (degree + 2) / 2); }
  std::size_t index(int i, int j) const { return static_cast<std::size_t>(i * (degree + 1) - i * (i - 1) / 2 + j); }
};

inline constexpr int kMaxPolynomialDegree = 16;

/// Zernike term: coefficient in mm times the orthonormal polynomial (n, m) over a disc, with cos(m theta) for m >= 0
/// and sin(|m| theta) for m < 0 (R. J. Noll, J. Opt. Soc. Am. 66, 207, 1976; signs as in ISO 24157).
struct ZernikeTerm {
  int n = 0;
  int m = 0;
  double coefficient_mm = 0.0;
};

/// Returns the sum of the terms as a polynomial in x / radius and y / radius. The conversion is exact.
/// \pre 0 <= n <= kMaxPolynomialDegree, |m| <= n, n - m even
XyPolynomial polynomial_of(const std::vector<ZernikeTerm>& terms, double radius_mm);

/// Sag z(x, y) in mm: the sum of the members. The formula has the variables x, y, r, theta, cx and cy (in mm and rad).
struct Sag {
  Asphere asphere;
  std::optional<XyPolynomial> polynomial;
  std::optional<Biconic> biconic;
  std::optional<Formula> formula;
  std::shared_ptr<const PatchSurface> patches;  ///< null if there are none
  std::array<double, 2> position_mm{};          ///< position of a lenslet: cx and cy of the formula

  /// Returns z at (x, y) with all derivatives of the type T. The result is NaN where the sag is undefined.
  template <class T>
  T evaluate(const T& x, const T& y) const;
  /// Returns z without the formula and the patches. Only closed forms remain, which can be evaluated with intervals.
  template <class T>
  T evaluate_without_formula(const T& x, const T& y) const;
};

/// Returns the names of the formula's variables, in the order in which a sag sets them.
std::vector<std::string> sag_variables();

/// Returns true if the sag is a polynomial.
inline bool is_polynomial(const Sag& sag) {
  return !sag.formula && !sag.patches && !sag.biconic && sag.asphere.curvature_per_mm == 0.0 &&
         sag.asphere.across == Asphere::Across::radius;
}

}  // namespace retrace::geometry
