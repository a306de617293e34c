#pragma once

// Error class for invalid formulas. An error contains the position in the formula.

#include <cstddef>
#include <string_view>

#include "core/error.h"

namespace retrace {

/// Error for a text that is not a valid formula.
class FormulaError : public InputError {
 public:
  /// \param position 1-based index of the character of the formula at which parsing failed
  FormulaError(const InputLocation& where, std::string_view text, std::size_t position)
      : InputError(where, text), position_(position) {}

  /// Returns the 1-based index of the character of the formula at which parsing failed.
  std::size_t position() const noexcept { return position_; }

 private:
  std::size_t position_;
};

}  // namespace retrace
