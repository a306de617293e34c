#pragma once

// Infinity as a double, under one short name.

#include <limits>

namespace retrace {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace retrace
