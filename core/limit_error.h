#pragma once

// Error class for numbers beyond a limit that depends on other inputs.

#include <string_view>

#include "core/error.h"

namespace retrace {

/// Error for an input number that is above an upper limit or below a lower limit. The limit depends on other inputs.
class LimitError : public InputError {
 public:
  /// \param limit the limit, which is the largest or smallest accepted value, in the unit used in the message
  LimitError(const InputLocation& where, std::string_view text, double limit)
      : InputError(where, text), limit_(limit) {}

  /// Returns the limit, which is the largest or smallest accepted value, in the unit used in the message.
  double limit() const noexcept { return limit_; }

 private:
  double limit_;
};

}  // namespace retrace
