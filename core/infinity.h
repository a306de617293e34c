#pragma once

// Defines a short name for infinity as a double.

#include <limits>

namespace retrace {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace retrace
