#pragma once

#include <limits>

namespace retrace {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace retrace
