#pragma once

#include <string>
#include <vector>

#include "core/error.h"
#include "fabrication/turning/jet.h"
#include "fabrication/turning/second_order.h"

namespace retrace::fabrication::turning {

/// A formula of the file as a list of elementary steps, so that it can be evaluated on numbers and on jets alike.
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
  std::vector<Node> nodes;  ///< operands stand before what uses them
  int result = 0;           ///< index of the node that is the value

  /// The value for those values of the variables. Not finite where the formula is not.
  template <class T>
  T evaluate(const T* variables) const;

  bool uses(int variable) const;
};

/// Longest formula that is read, in characters.
inline constexpr std::size_t kLongestFormula = 2000;

/// Reads a formula: numbers, pi, the variables, + - * / ^, brackets and sqrt exp log sin cos tan asin acos atan atan2
/// sinh cosh tanh abs. Angles are in radians.
/// \throw InputError at `where` with the place in the formula where it does not parse
Formula parse_formula(const std::string& text, const std::vector<std::string>& variables, const InputLocation& where);

}  // namespace retrace::fabrication::turning
