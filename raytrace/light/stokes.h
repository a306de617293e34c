#pragma once

// Stokes parameters: power and polarisation of a beam.

#include <array>

namespace retrace::raytrace {

/// Stokes parameters of a beam, in units of the incident power. Between interfaces they refer to the axes (s, p) of a
/// Light; in results to the axes of source_axis(). v > 0 is right-handed: clockwise as seen against the light (Born
/// and Wolf, Principles of Optics, 7th ed., 1.4).
struct Stokes {
  double i = 0.0;  ///< power
  double q = 0.0;  ///< along the first axis less along the second
  double u = 0.0;  ///< along the first bisector less along the other
  double v = 0.0;  ///< right-handed less left-handed

  Stokes& operator+=(const Stokes& other) {
    i += other.i;
    q += other.q;
    u += other.u;
    v += other.v;
    return *this;
  }
  friend Stokes operator*(double factor, const Stokes& s) {
    return {factor * s.i, factor * s.q, factor * s.u, factor * s.v};
  }
  std::array<double, 4> values() const { return {i, q, u, v}; }
};

inline constexpr Stokes kUnpolarised{1.0, 0.0, 0.0, 0.0};

}  // namespace retrace::raytrace
