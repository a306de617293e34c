#include "geometry/surface/sag.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/math/jets.h"
#include "tests/support/polynomials.h"

// Tests of sags: values are compared with closed forms, and derivatives with difference quotients.

namespace retrace::geometry::sag_test {
namespace {

using namespace jets;

const InputLocation kHere{"part.toml", 7, "base.formula"};

Series<double> line(double x, double slope, int order = kMaxOrder) {
  return line_series(x, slope, order);
}

/// Compares the gradient (type Gradient) and the second derivative along a line (type Series) with central differences.
void expect_derivatives(const Sag& sag, double x, double y) {
  const double h = 1e-4;
  const Gradient z = sag.evaluate(Gradient(x, 1.0, 0.0), Gradient(y, 0.0, 1.0));
  EXPECT_EQ(z.value, sag.evaluate(x, y));
  EXPECT_NEAR(z.x, (sag.evaluate(x + h, y) - sag.evaluate(x - h, y)) / (2 * h), 1e-6);
  EXPECT_NEAR(z.y, (sag.evaluate(x, y + h) - sag.evaluate(x, y - h)) / (2 * h), 1e-6);
  const double c = std::cos(0.4);
  const double s = std::sin(0.4);
  const Series<double> along = sag.evaluate(line(x, c), line(y, s));
  EXPECT_NEAR(along[1], z.x * c + z.y * s, 1e-12);
  const double second =
      (sag.evaluate(x + h * c, y + h * s) - 2 * sag.evaluate(x, y) + sag.evaluate(x - h * c, y - h * s)) / (h * h);
  EXPECT_NEAR(2.0 * along[2], second, 1e-5);
  // The complete series must approximate the sag at a nearby point.
  const double t = 1e-2;
  EXPECT_NEAR(horner(along.c.data(), along.order + 1, t), sag.evaluate(x + t * c, y + t * s), 1e-14);
}

TEST(Sag, SphereIsASphere) {
  Sag sag;
  sag.asphere.curvature_per_mm = 0.1;
  EXPECT_NEAR(sag.evaluate(3.0, 4.0), 10.0 - std::sqrt(75.0), 1e-14);
  EXPECT_TRUE(std::isnan(sag.evaluate(8.0, 7.0)));
  expect_derivatives(sag, 3.0, 4.0);
}

TEST(Sag, AsphereAndParaboloid) {
  Sag sag;
  sag.asphere = {0.2, -1.0, {1e-3, -2e-5}};
  EXPECT_NEAR(sag.evaluate(1.0, 1.0), 0.2 + 1e-3 * 4.0 - 2e-5 * 8.0, 1e-15);
  sag.asphere.conic = -0.6;
  expect_derivatives(sag, 1.1, -0.3);
}

TEST(Sag, PolynomialInXAndY) {
  Sag sag;
  sag.polynomial = testing::polynomial_of(2.0, 3, {{2, 1, 0.5}, {0, 3, -0.25}, {0, 0, 1.0}});
  EXPECT_NEAR(sag.evaluate(1.0, 3.0), 1.0 + 0.5 * 0.25 * 1.5 - 0.25 * 3.375, 1e-15);
  expect_derivatives(sag, 0.4, -1.2);
}

TEST(Sag, ZernikeTermsAreOrthonormal) {
  const std::vector<std::pair<int, int>> terms = {{0, 0}, {1, 1}, {1, -1}, {2, 0}, {2, -2}, {3, 1}, {4, 0}, {5, -3}};
  std::vector<Sag> sags;
  for (const auto& [n, m] : terms) {
    sags.emplace_back();
    sags.back().polynomial = polynomial_of({{n, m, 1.0}}, 2.0);
  }
  for (std::size_t a = 0; a < terms.size(); ++a)
    for (std::size_t b = a; b < terms.size(); ++b) {
      double sum = 0.0;
      const int radii = 400;
      const int angles = 32;
      for (int i = 0; i < radii; ++i)
        for (int k = 0; k < angles; ++k) {
          const double r = 2.0 * std::sqrt((i + 0.5) / radii);
          const double t = 2.0 * std::numbers::pi * k / angles;
          sum += sags[a].evaluate(r * std::cos(t), r * std::sin(t)) *
                 sags[b].evaluate(r * std::cos(t), r * std::sin(t)) / (radii * angles);
        }
      EXPECT_NEAR(sum, a == b ? 1.0 : 0.0, 1e-4) << a << " " << b;
    }
  EXPECT_NEAR(sags[6].evaluate(1.0, 0.0), std::sqrt(5.0) * (6.0 / 16 - 6.0 / 4 + 1.0), 1e-14);
  EXPECT_NEAR(sags[3].evaluate(0.0, 2.0), std::sqrt(3.0), 1e-14);
}

TEST(Formula, UsesPolarVariablesOnlyWhereItSaysSo) {
  Sag sag;
  sag.formula = parse_formula("0.1*x^2+0.2*y^2", sag_variables(), kHere);
  EXPECT_EQ(sag.evaluate(Gradient(0.0, 1.0, 0.0), Gradient(0.0, 0.0, 1.0)).x, 0.0);
  EXPECT_FALSE(sag.formula->uses(2));
  EXPECT_TRUE(parse_formula("r^2", sag_variables(), kHere).uses(2));
}

}  // namespace
}  // namespace retrace::geometry::sag_test
