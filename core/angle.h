#pragma once

// Angles that store their value in radians and convert from and to degrees, and constants for these conversions.

#include <numbers>

namespace retrace {

inline constexpr double kTwoPi = 2.0 * std::numbers::pi;        ///< one full turn, rad
inline constexpr double kRadPerDeg = std::numbers::pi / 180.0;  ///< one degree, rad
inline constexpr double kRadPerArcsec = kRadPerDeg / 3600.0;    ///< one arc second in rad
inline constexpr double kArcsecPerRad = 3600.0 / kRadPerDeg;

/// An angle, stored in radians. Files and commands use degrees; computations use radians.
class Angle {
 public:
  constexpr Angle() = default;
  static constexpr Angle from_rad(double rad) { return Angle(rad); }
  static constexpr Angle from_deg(double deg) { return Angle(deg * (std::numbers::pi / 180.0)); }

  constexpr double rad() const { return rad_; }
  constexpr double deg() const { return rad_ * (180.0 / std::numbers::pi); }

 private:
  explicit constexpr Angle(double rad) : rad_(rad) {}
  double rad_ = 0.0;
};

}  // namespace retrace
