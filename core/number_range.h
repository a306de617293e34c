#pragma once

// The range of values that a number of a file may have, and its words for messages.

#include <limits>
#include <string>

namespace retrace {

/// What a number of a file may be. Infinite bounds are not named in messages.
struct NumberRange {
  double low = -std::numeric_limits<double>::infinity();
  bool low_included = true;
  double high = std::numeric_limits<double>::infinity();
  bool high_included = true;

  bool contains(double value) const;
  /// "> 0", ">= 60 and <= 120"; "any number" without bounds
  std::string text() const;
};

}  // namespace retrace
