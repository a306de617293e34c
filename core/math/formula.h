#pragma once

// Formulas in files of users, such as a sag z(x, y). A formula is parsed one time. It is then evaluated for numbers, or
// for jets, which contain exact derivatives.

#include <string>
#include <vector>

#include "core/error.h"

namespace retrace {

/// A formula as a list of elementary operations, which can be evaluated for numbers and for jets.
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
  std::vector<Node> nodes;  ///< operations; operands precede the operations that use them, and the last node is the
                            ///< value of the formula

  /// Returns the value of the formula for the given values of its variables, which are numbers or jets
  /// (core/math/jets.h, core/math/partials.h). The result is not finite where the formula is undefined. The function is
  /// defined in core/math/formula_evaluation.h.
  template <class T>
  T evaluate(const T* variables) const;

  bool uses(int variable) const;
};

/// Returns true if an operation has two operands.
bool is_binary(Formula::Step step);

/// Maximum length of a formula, in characters.
inline constexpr std::size_t kMaxFormulaLength = 2000;

/// Parses a formula. It may contain numbers, pi, the variables, + - * / ^, brackets and the functions sqrt exp log sin
/// cos tan asin acos atan atan2 sinh cosh tanh abs. Powers have the highest precedence and associate to the right.
/// Signs have a lower precedence than powers: -x^2 is -(x^2). Angles are in radians. Constant subexpressions are
/// evaluated.
/// \param where position of the formula in the input, for messages
/// \throw InputError with the position in the formula at which parsing failed
Formula parse_formula(const std::string& text, const std::vector<std::string>& variables, const InputLocation& where);

}  // namespace retrace
