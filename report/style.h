#pragma once

// Private to report/: what all plots share.

#include "report/canvas.h"

namespace retrace::report {

inline constexpr Colour kWhite{1.0, 1.0, 1.0};
inline constexpr Colour kAxis{0.35, 0.35, 0.35};
inline constexpr Colour kText{0.13, 0.13, 0.13};
inline constexpr Colour kFaint{0.42, 0.42, 0.42};
inline constexpr Font kTitleFont{16.0, true};
inline constexpr Font kPanelFont{12.5, true};
inline constexpr double kMargin = 22.0;

}  // namespace retrace::report
