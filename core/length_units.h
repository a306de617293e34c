#pragma once

// Constants for the conversion of lengths between mm, um and nm.

namespace retrace {

inline constexpr double kUmPerMm = 1e3;
inline constexpr double kMmPerUm = 1e-3;
inline constexpr double kNmPerMm = 1e6;
inline constexpr double kMmPerNm = 1e-6;

}  // namespace retrace
