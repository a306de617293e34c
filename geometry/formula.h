#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace retrace::geometry {

/// A value with its first and second derivatives by x and y.
struct Jet {
  double value = 0.0;
  double x = 0.0;
  double y = 0.0;
  double xx = 0.0;
  double xy = 0.0;
  double yy = 0.0;

  bool is_finite() const;
};

/// A function of x and y as a text: numbers, `x`, `y`, `pi`, + - * / ^, brackets, and sqrt, exp, log, sin, cos, tan,
/// asin, acos, atan, sinh, cosh, tanh, abs. Powers bind first and to the right, signs next: -x^2 is -(x^2).
///
/// Derivatives are exact: every step carries its own (forward differentiation of second order).
class Formula {
 public:
  static constexpr std::size_t kMaxLength = 1000;

  /// \throw InputError saying what stands where if the text is no formula
  explicit Formula(std::string_view text);

  const std::string& text() const { return text_; }
  /// May be infinite or no number, as what the text says.
  Jet at(double x, double y) const;

 private:
  friend class FormulaParser;
  enum class Op : std::uint8_t {
    number,
    x,
    y,
    add,
    subtract,
    multiply,
    divide,
    power,
    negate,
    sqrt,
    exp,
    log,
    sin,
    cos,
    tan,
    asin,
    acos,
    atan,
    sinh,
    cosh,
    tanh,
    abs
  };
  struct Step {
    Op op = Op::number;
    double number = 0.0;
  };
  static constexpr std::size_t kMaxDepth = 64;

  static Jet apply(Op op, const Jet& a);
  static Jet apply(Op op, const Jet& a, const Jet& b);

  std::string text_;
  std::vector<Step> steps_;  ///< in reverse Polish order
};

}  // namespace retrace::geometry
