#include "core/math/formula.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>

#include "core/error.h"
#include "core/math/formula_error.h"
#include "core/math/formula_evaluation.h"
#include "tests/support/refusals.h"

// Tests of formulas: their values, their exact derivatives, and texts that are not formulas.

namespace retrace::formula_test {
namespace {

using Jet = jets::Partials<2>;
using jets::Series;

Formula formula(const std::string& text) {
  return parse_formula(text, {"x", "y"}, InputLocation{});
}

Jet at(const Formula& f, double x, double y) {
  const std::array<Jet, 2> variables = {Jet{x, 1.0}, Jet{y, 0.0, 1.0}};
  return f.evaluate(variables.data());
}

TEST(Formula, BindsPowersBeforeSignsAndToTheRight) {
  EXPECT_DOUBLE_EQ(at(formula("-x^2"), 3.0, 0.0).value, -9.0);
  EXPECT_DOUBLE_EQ(at(formula("2^3^2"), 0.0, 0.0).value, 512.0);
  EXPECT_DOUBLE_EQ(at(formula("2^-1 + 8 / 4 / 2 - 1 - 1"), 0.0, 0.0).value, -0.5);
  EXPECT_DOUBLE_EQ(at(formula(" ( x + 2*y ) * 1.5e1 "), 1.0, 2.0).value, 75.0);
  EXPECT_DOUBLE_EQ(at(formula("cos(pi)"), 0.0, 0.0).value, -1.0);
}

// The expected values come from the sag of a sphere, R - sqrt(R^2 - r^2), differentiated by hand.
TEST(Formula, DifferentiatesASphereExactly) {
  const Jet jet = at(formula("10 - sqrt(10^2 - x^2 - y^2)"), 3.0, -2.0);
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
    const Formula f = formula(text);
    const double x = 0.7;
    const double y = 0.4;
    const Jet jet = at(f, x, y);
    const auto near_by = [&](double dx, double dy) { return at(f, x + dx * h, y + dy * h).value; };
    const double near = 1e-6;
    EXPECT_NEAR(jet.x, (near_by(1, 0) - near_by(-1, 0)) / (2.0 * h), near) << text;
    EXPECT_NEAR(jet.y, (near_by(0, 1) - near_by(0, -1)) / (2.0 * h), near) << text;
    EXPECT_NEAR(jet.xx, (near_by(1, 0) - 2.0 * near_by(0, 0) + near_by(-1, 0)) / (h * h), near) << text;
    EXPECT_NEAR(jet.yy, (near_by(0, 1) - 2.0 * near_by(0, 0) + near_by(0, -1)) / (h * h), near) << text;
    EXPECT_NEAR(jet.xy, (near_by(1, 1) - near_by(1, -1) - near_by(-1, 1) + near_by(-1, -1)) / (4.0 * h * h), near)
        << text;
  }
}

TEST(Formula, PowersHaveDerivativesAtZero) {
  const Jet jet = at(formula("x^2 + y^1"), 0.0, 0.0);
  EXPECT_TRUE(jet.is_finite());
  EXPECT_EQ(jet.xx, 2.0);
  EXPECT_EQ(jet.y, 1.0);
  EXPECT_FALSE(at(formula("1/x"), 0.0, 1.0).is_finite());
  EXPECT_FALSE(at(formula("sqrt(1 - x^2)"), 2.0, 0.0).is_finite());
}

TEST(Formula, HasTheUsualRules) {
  const std::string texts[] = {
      "-x^2",        "2^3^0.5",   "1-2-3",         "x*y/2+3.5e0",       "atan2(y,x)", "sqrt(sqrt(x^2+y^2))",
      "cosh(x)-1",   "2*-x",      "x^-2",          "tanh(x)*asin(x/2)", "abs(-y)",    "acos(x/3)*pi",
      "exp(log(y))", "(x+y)^2.5", "sinh(y)+tan(x)"};
  const double x = 0.8;
  const double y = 1.7;
  const double r = std::hypot(x, y);
  const double expected[] = {-x * x,
                             std::pow(2.0, std::pow(3.0, 0.5)),
                             -4.0,
                             x * y / 2 + 3.5,
                             std::atan2(y, x),
                             std::sqrt(r),
                             std::cosh(x) - 1,
                             -2 * x,
                             1 / (x * x),
                             std::tanh(x) * std::asin(x / 2),
                             y,
                             std::acos(x / 3) * std::numbers::pi,
                             y,
                             std::pow(x + y, 2.5),
                             std::sinh(y) + std::tan(x)};
  for (std::size_t i = 0; i < std::size(texts); ++i) {
    const double value = at(formula(texts[i]), x, y).value;
    EXPECT_NEAR(value, expected[i], 1e-14 * (1 + std::abs(expected[i]))) << texts[i];
  }
}

TEST(Formula, IsTheSameByEveryNumber) {
  for (const char* const text :
       {"exp(0.3*x)*sin(y)", "x^-3 + (1+y)^2.5", "atan2(y, x)*tanh(x-y)", "abs(-x)/y", "2^x"}) {
    const Formula f = formula(text);
    const Jet whole = at(f, 0.7, 0.4);
    const std::array<double, 2> numbers = {0.7, 0.4};
    EXPECT_NEAR(f.evaluate(numbers.data()), whole.value, 1e-15 * std::abs(whole.value)) << text;
    const std::array<Series<double>, 2> line = {jets::line_series(0.7, 0.6, 5), jets::line_series(0.4, -0.8, 5)};
    const Series<double> along = f.evaluate(line.data());
    EXPECT_NEAR(along[1], 0.6 * whole.x - 0.8 * whole.y, 1e-13 * (1.0 + std::abs(along[1]))) << text;
    EXPECT_NEAR(2.0 * along[2], 0.36 * whole.xx - 0.96 * whole.xy + 0.64 * whole.yy, 1e-12 * (1.0 + std::abs(along[2])))
        << text;
    // The series with derivatives of higher order must approximate the function at a nearby point.
    const std::array<double, 2> beside = {0.7 + 0.6e-2, 0.4 - 0.8e-2};
    EXPECT_NEAR(jets::horner(along.c.data(), 6, 1e-2), f.evaluate(beside.data()), 1e-9) << text;
  }
}

TEST(Formula, WorksOutWhatIsConstant) {
  const Formula f = formula("x^(3-5) + 0*y + sin(pi/2)*4");
  // The nodes are x, -2, their power, y, 0, the product of y and 0, two sums, and 4.
  EXPECT_EQ(f.nodes.size(), 9U);
  EXPECT_DOUBLE_EQ(at(f, -2.0, 1.0).value, 4.25) << "a whole exponent, though it is not written as one number";
  EXPECT_DOUBLE_EQ(at(f, -2.0, 1.0).x, 0.25);
  EXPECT_TRUE(f.uses(0));
  EXPECT_TRUE(f.uses(1));
  EXPECT_FALSE(formula("y^2").uses(0));
  EXPECT_FALSE(formula("3").uses(0));
  EXPECT_EQ(at(formula("3"), 1.0, 1.0).value, 3.0);
}

TEST(Formula, TangentsDoNotOverflow) {
  const Jet far = at(formula("tanh(1000*x) + tanh(-1000*y)"), 1.0, 1.0);
  EXPECT_TRUE(far.is_finite());
  EXPECT_EQ(far.value, 0.0);
}

TEST(Formula, TakesLongOnes) {
  std::string nested = "x";
  for (int k = 0; k < 300; ++k) nested = "y+(" + nested + ")";
  EXPECT_DOUBLE_EQ(at(formula(nested), 1.0, 0.5).value, 151.0);
}

// A high integer power of a negative constant must not be computed with a logarithm, which is undefined there.
TEST(Formula, HighWholePowersOfNegativeConstants) {
  EXPECT_DOUBLE_EQ(at(formula("(-2)^66*x"), 1.0, 0.0).value, std::ldexp(1.0, 66));
}

TEST(Formula, SaysWhereItDoesNotParse) {
  const char* const bad[] = {"",         "x+",     "(x",   "x)",     "3x",    "z+1",       "sin()",
                             "sin(x,y)", "x,y",    "x=3",  "1..2",   "\"a\"", "x ? y : 1", "x == y",
                             "atan2(x)", "pi = 3", "x; y", "foo(x)", "1e400", "1e-400*x"};
  for (const char* const text : bad) {
    try {
      parse_formula(text, {"x", "y"}, {"part.toml", 7, "base.formula"});
      ADD_FAILURE() << text << " was taken";
    } catch (const InputError& error) {
      EXPECT_EQ(recorded_place_of(error), "part.toml:7: base.formula");
    }
  }
}

/// Returns the position of the character at which parsing a formula fails; the first character has position 1. Returns
/// nothing if the error has no position.
std::optional<std::size_t> failed_at(const std::string& text) {
  try {
    formula(text);
  } catch (const FormulaError& error) {
    EXPECT_EQ(recorded_place_of(error), "refused");
    return error.position();
  } catch (const InputError& error) {
    EXPECT_EQ(recorded_place_of(error), "refused");
    return std::nullopt;
  }
  ADD_FAILURE() << text << " was accepted";
  return std::nullopt;
}

TEST(Formula, ReportsTheCharacterAtWhichParsingFails) {
  EXPECT_EQ(failed_at("x + * y"), 5U);
  EXPECT_EQ(failed_at("(x + y"), 7U) << "behind the end";
  EXPECT_EQ(failed_at("x y"), 3U);
  EXPECT_EQ(failed_at("z^2"), 1U);
  EXPECT_EQ(failed_at("x ? y : 1"), 3U);
  EXPECT_EQ(failed_at(std::string("x\0+((", 5)), 2U);
  EXPECT_EQ(failed_at(std::string(1990, '(')), 1991U);
  EXPECT_EQ(failed_at(std::string(2001, '(')), std::nullopt) << "too long";
}

}  // namespace
}  // namespace retrace::formula_test
