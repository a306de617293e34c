#pragma once

#include <string>
#include <string_view>

#include "core/math/formula.h"
#include "core/math/partials.h"

namespace retrace::geometry {

/// A value with its first and second derivatives by x and y.
using Jet = jets::Partials<2>;

/// A function of x and y as a text, as parse_formula() reads it, with exact derivatives.
class Formula {
 public:
  /// \throw InputError saying where the text is no formula
  explicit Formula(std::string_view text);

  const std::string& text() const { return formula_.text; }
  /// May be infinite or no number, as what the text says.
  Jet at(double x, double y) const;

 private:
  retrace::Formula formula_;
};

}  // namespace retrace::geometry
