#pragma once

// Polarised light at interfaces: Stokes parameters in the plane of incidence, reflected and transmitted by Fresnel's
// formulas.

#include <Eigen/Geometry>
#include <cmath>
#include <complex>

#include "geometry/vec.h"
#include "materials/fresnel.h"
#include "raytrace/light/stokes.h"

namespace retrace::raytrace {

using geometry::Vec2, geometry::Vec3;

/// Power and polarisation of light of one direction: Stokes parameters along s and p = direction x s.
///
/// Averaging reflectances of s and p at every interface would be wrong after the second one: the first interface
/// polarises, and the next has another plane of incidence.
struct Light {
  /// Squared sine of the incidence below which s and p are alike and any axis serves.
  static constexpr double kNormalIncidence = 1e-16;

  Stokes stokes = kUnpolarised;
  Vec3 s_axis = Vec3::UnitX();

  double power() const { return stokes.i; }
  void scale(double factor) { stokes = factor * stokes; }

  /// Describes the same light with its s axis along `axis`, a unit vector across `direction`.
  void turn_to_axis(const Vec3& direction, const Vec3& axis) {
    const double c = axis.dot(s_axis);
    const double s = axis.dot(direction.cross(s_axis));
    const double c2 = c * c - s * s;
    const double s2 = 2.0 * c * s;
    const double along = stokes.q;
    stokes.q = c2 * along + s2 * stokes.u;
    stokes.u = c2 * stokes.u - s2 * along;
    s_axis = axis;
  }

  /// The same with the s axis normal to the plane of incidence at an interface.
  void turn_to(const Vec3& direction, const Vec3& normal) {
    const Vec3 across = direction.cross(normal);
    const double norm2 = across.squaredNorm();
    if (norm2 < kNormalIncidence) return;
    turn_to_axis(direction, across / std::sqrt(norm2));
  }

  Light reflected(const materials::FresnelCoefficients& f) const {
    return passed(std::norm(f.r_s), std::norm(f.r_p), f.r_coherence * f.r_s * std::conj(f.r_p));
  }
  Light transmitted(const materials::FresnelCoefficients& f) const {
    return passed(std::norm(f.t_s), std::norm(f.t_p), f.t_coherence * f.t_s * std::conj(f.t_p));
  }

 private:
  /// \param cross product of the amplitude factor of s with the conjugate one of p
  Light passed(double power_s, double power_p, std::complex<double> cross) const {
    const double s = 0.5 * (stokes.i + stokes.q) * power_s;
    const double p = 0.5 * (stokes.i - stokes.q) * power_p;
    const std::complex<double> uv = cross * std::complex<double>(stokes.u, stokes.v);
    return {{s + p, s - p, uv.real(), uv.imag()}, s_axis};
  }
};

}  // namespace retrace::raytrace
