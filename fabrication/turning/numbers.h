#pragma once

// The numbers and formulas of core that surfaces of turning are made of.

#include <numbers>

#include "core/math/formula.h"
#include "core/math/jets.h"
#include "core/math/partials.h"

namespace retrace::fabrication::turning {

inline constexpr double kTurn = 2.0 * std::numbers::pi;      ///< rad
inline constexpr double kDegree = std::numbers::pi / 180.0;  ///< rad

using jets::constant_like;
using jets::Gradient;
using jets::horner;
using jets::Jet2;
using jets::kAnyOrder;
using jets::kMostOrder;
using jets::line_series;
using jets::power;
using jets::Series;
using jets::value_of;

}  // namespace retrace::fabrication::turning
