#include "geometry/formula.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "core/error.h"

// Formulas of x and y: their values, their exact derivatives, and what is none.

namespace retrace::geometry {
namespace {

TEST(Formula, BindsPowersBeforeSignsAndToTheRight) {
  EXPECT_DOUBLE_EQ(Formula("-x^2").at(3.0, 0.0).value, -9.0);
  EXPECT_DOUBLE_EQ(Formula("2^3^2").at(0.0, 0.0).value, 512.0);
  EXPECT_DOUBLE_EQ(Formula("2^-1 + 8 / 4 / 2 - 1 - 1").at(0.0, 0.0).value, -0.5);
  EXPECT_DOUBLE_EQ(Formula(" ( x + 2*y ) * 1.5e1 ").at(1.0, 2.0).value, 75.0);
  EXPECT_DOUBLE_EQ(Formula("cos(pi)").at(0.0, 0.0).value, -1.0);
}

// The sag of a conic: R - sqrt(R^2 - r^2), differentiated by hand.
TEST(Formula, DifferentiatesASphereExactly) {
  const Jet jet = Formula("10 - sqrt(10^2 - x^2 - y^2)").at(3.0, -2.0);
  const double root = std::sqrt(100.0 - 9.0 - 4.0);
  EXPECT_NEAR(jet.value, 10.0 - root, 1e-14);
  EXPECT_NEAR(jet.x, 3.0 / root, 1e-15);
  EXPECT_NEAR(jet.y, -2.0 / root, 1e-15);
  EXPECT_NEAR(jet.xx, (root * root + 9.0) / std::pow(root, 3), 1e-15);
  EXPECT_NEAR(jet.yy, (root * root + 4.0) / std::pow(root, 3), 1e-15);
  EXPECT_NEAR(jet.xy, -6.0 / std::pow(root, 3), 1e-15);
}

TEST(Formula, DerivativesAgreeWithDifferences) {
  const double h = 1e-4;
  for (const std::string text :
       {"exp(0.3*x)*sin(y)", "log(2+x)/(1+y^2)", "tan(0.2*x*y)", "asin(0.1*x)+acos(0.2*y)*x", "atan(x-y)^3",
        "sinh(x)*cosh(y)", "tanh(x+2*y)", "abs(x)*y", "(1+x^2)^y", "x^1 + y^0 + x^2*y", "sqrt(4+x)*2^(0.5*y)"}) {
    const Formula f(text);
    const double x = 0.7;
    const double y = 0.4;
    const Jet jet = f.at(x, y);
    const auto at = [&](double dx, double dy) { return f.at(x + dx * h, y + dy * h).value; };
    const double near = 1e-6;
    EXPECT_NEAR(jet.x, (at(1, 0) - at(-1, 0)) / (2.0 * h), near) << text;
    EXPECT_NEAR(jet.y, (at(0, 1) - at(0, -1)) / (2.0 * h), near) << text;
    EXPECT_NEAR(jet.xx, (at(1, 0) - 2.0 * at(0, 0) + at(-1, 0)) / (h * h), near) << text;
    EXPECT_NEAR(jet.yy, (at(0, 1) - 2.0 * at(0, 0) + at(0, -1)) / (h * h), near) << text;
    EXPECT_NEAR(jet.xy, (at(1, 1) - at(1, -1) - at(-1, 1) + at(-1, -1)) / (4.0 * h * h), near) << text;
  }
}

TEST(Formula, PowersHaveDerivativesAtZero) {
  const Jet jet = Formula("x^2 + y^1").at(0.0, 0.0);
  EXPECT_TRUE(jet.is_finite());
  EXPECT_EQ(jet.xx, 2.0);
  EXPECT_EQ(jet.y, 1.0);
  EXPECT_FALSE(Formula("1/x").at(0.0, 1.0).is_finite());
  EXPECT_FALSE(Formula("sqrt(1 - x^2)").at(2.0, 0.0).is_finite());
}

std::string complaint(const std::string& text) {
  try {
    const Formula formula(text);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Formula, SaysWhatIsMissingAndWhere) {
  EXPECT_EQ(complaint(""),
            "is no formula of x and y: a number, x, y or a function is missing at character 1, where its "
            "end stands");
  EXPECT_NE(complaint("x + * y").find("at character 5, where \"* y\" stands"), std::string::npos);
  EXPECT_NE(complaint("(x + y").find("\")\" is missing at character 7"), std::string::npos);
  EXPECT_NE(complaint("x y").find("an operator is missing at character 3"), std::string::npos);
  EXPECT_NE(complaint("z^2").find("x, y, pi or a function"), std::string::npos);
  EXPECT_NE(complaint("sqrt x").find("\"(\" is missing"), std::string::npos);
  EXPECT_NE(complaint("1e999").find("a number is missing"), std::string::npos);
  EXPECT_NE(complaint(std::string(2000, '(')).find("at most 1000 characters"), std::string::npos);
  EXPECT_NE(complaint(std::string(990, '(')), "");
  std::string nested = "x";
  for (int k = 0; k < 100; ++k) nested = "x+(" + nested + ")";
  EXPECT_NE(complaint(nested).find("too deeply nested"), std::string::npos);
}

}  // namespace
}  // namespace retrace::geometry
