#pragma once

// Formulas that users write into files, such as a sag z(x, y): parsed once, then evaluated on numbers or on jets with
// exact derivatives.

#include <string>
#include <vector>

#include "core/error.h"

namespace retrace {

/// A formula of a file as a list of elementary steps, so that it can be evaluated on numbers and on jets alike.
class Formula {
 public:
  enum class Step {
    constant,
    variable,  ///< index in the names given to parse_formula()
    add,
    subtract,
    multiply,
    divide,
    negate,
    power,
    sqrt,
    exp,
    log,
    sin,
    cos,
    tan,
    asin,
    acos,
    atan,
    atan2,
    sinh,
    cosh,
    tanh,
    abs
  };
  struct Node {
    Step step = Step::constant;
    int a = 0;  ///< index of the first operand, or of the variable
    int b = 0;
    double number = 0.0;
  };

  std::string text;
  std::vector<Node> nodes;  ///< operands stand before what uses them; all that are needed, the value last

  /// The value for those values of the variables, which are numbers or jets (core/math/jets.h,
  /// core/math/partials.h). Not finite where the formula is not. core/math/formula_evaluation.h defines it.
  template <class T>
  T evaluate(const T* variables) const;

  bool uses(int variable) const;
};

/// Whether a step has two operands; constants and variables have none.
bool is_binary(Formula::Step step);

/// Longest formula that is read, in characters.
inline constexpr std::size_t kLongestFormula = 2000;

/// Reads a formula: numbers, pi, the variables, + - * / ^, brackets and sqrt exp log sin cos tan asin acos atan atan2
/// sinh cosh tanh abs. Powers bind first and to the right, signs next: -x^2 is -(x^2). Angles are in radians. What is
/// constant is worked out.
/// \throw InputError at `where` with the place in the formula where it does not parse
Formula parse_formula(const std::string& text, const std::vector<std::string>& variables, const InputLocation& where);

}  // namespace retrace
