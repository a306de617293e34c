#pragma once

// Stokes parameters: power and polarization of a beam.

#include <array>

namespace retrace::raytrace {

/// Stokes parameters of a beam, in units of the incident power. During tracing, they refer to the axes (s, p) of a
/// Light. In results, their first axis is source_axis(). v > 0 is right-handed, which means clockwise as seen against
/// the light (Born and Wolf, Principles of Optics, 7th ed., 1.4).
struct Stokes {
  double i = 0.0;  ///< power
  double q = 0.0;  ///< power along the first axis minus power along the second axis
  double u = 0.0;  ///< power along the bisector of both axes minus power perpendicular to it
  double v = 0.0;  ///< right-handed minus left-handed circular power

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
