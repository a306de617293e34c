#pragma once

// Range of allowed values of a number in a file, and its description in messages.

#include <limits>
#include <string>

namespace retrace {

/// Range of allowed values of a number. Infinite bounds are omitted in messages.
struct NumberRange {
  double low = -std::numeric_limits<double>::infinity();
  bool low_included = true;
  double high = std::numeric_limits<double>::infinity();
  bool high_included = true;

  bool contains(double value) const;
  /// Returns the range as text, such as "> 0" or ">= 60 and <= 120". Returns "any number" for a range without bounds.
  std::string text() const;
};

}  // namespace retrace
