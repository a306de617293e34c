#pragma once

// Errors in formulas, with their position in the formula.

#include <cstddef>
#include <string_view>

#include "core/error.h"

namespace retrace {

/// Error that a text is not a formula.
class FormulaError : public InputError {
 public:
  /// \param position number of the character at which parsing failed, counted from 1
  FormulaError(const InputLocation& where, std::string_view text, std::size_t position)
      : InputError(where, text), position_(position) {}

  /// Returns the number of the character at which parsing failed, counted from 1.
  std::size_t position() const noexcept { return position_; }

 private:
  std::size_t position_;
};

}  // namespace retrace
