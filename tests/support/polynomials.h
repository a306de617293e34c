#pragma once

#include <vector>

#include "geometry/surface/sag.h"

namespace retrace::testing {

/// Term coefficient * x^i * y^j of a polynomial.
struct PolynomialTerm {
  int i;
  int j;
  double coefficient;
};

/// Returns the sum of the terms, where x and y are divided by `scale_mm`.
inline geometry::XyPolynomial polynomial_of(double scale_mm, int degree, const std::vector<PolynomialTerm>& terms) {
  geometry::XyPolynomial p{scale_mm, degree, std::vector<double>(geometry::XyPolynomial::count(degree), 0.0)};
  for (const PolynomialTerm& term : terms) p.coefficients[p.index(term.i, term.j)] = term.coefficient;
  return p;
}

}  // namespace retrace::testing
