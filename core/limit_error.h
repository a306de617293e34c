#pragma once

// Errors in numbers whose limit depends on other inputs.

#include <string_view>

#include "core/error.h"

namespace retrace {

/// Error in a number of the input that is beyond a limit. The limit depends on other inputs.
class LimitError : public InputError {
 public:
  /// \param limit smallest or largest value that is accepted, in the unit of the message
  LimitError(const InputLocation& where, std::string_view text, double limit)
      : InputError(where, text), limit_(limit) {}

  /// Returns the smallest or largest value that is accepted, in the unit of the message.
  double limit() const noexcept { return limit_; }

 private:
  double limit_;
};

}  // namespace retrace
