#pragma once

// Polarized light at interfaces: Stokes parameters along the axes of the plane of incidence, with reflection and
// transmission by Fresnel's formulas.

#include <Eigen/Geometry>
#include <cmath>
#include <complex>

#include "geometry/vec.h"
#include "materials/fresnel.h"
#include "raytrace/light/stokes.h"

namespace retrace::raytrace {

using geometry::Vec2, geometry::Vec3;

/// Power and polarization of light with one direction: Stokes parameters along the axes s and p = direction x s.
///
/// The polarization is stored because each interface polarizes the light, and the next interface has a different plane
/// of incidence. Mean reflectances of s and p would therefore be wrong after the first interface.
struct Light {
  /// Squared sine of the angle of incidence below which s and p have equal coefficients, and the axes are not changed.
  static constexpr double kNormalIncidence = 1e-16;

  Stokes stokes = kUnpolarised;
  Vec3 s_axis = Vec3::UnitX();

  double power() const { return stokes.i; }
  void scale(double factor) { stokes = factor * stokes; }

  /// Expresses the same light with the s axis along `axis`, a unit vector perpendicular to `direction`.
  void rotate_basis_to_axis(const Vec3& direction, const Vec3& axis) {
    const double c = axis.dot(s_axis);
    const double s = axis.dot(direction.cross(s_axis));
    const double c2 = c * c - s * s;
    const double s2 = 2.0 * c * s;
    const double along = stokes.q;
    stokes.q = c2 * along + s2 * stokes.u;
    stokes.u = c2 * stokes.u - s2 * along;
    s_axis = axis;
  }

  /// Expresses the same light with the s axis perpendicular to the plane of incidence at an interface.
  void rotate_basis_to_interface(const Vec3& direction, const Vec3& normal) {
    const Vec3 across = direction.cross(normal);
    const double norm2 = across.squaredNorm();
    if (norm2 < kNormalIncidence) return;
    rotate_basis_to_axis(direction, across / std::sqrt(norm2));
  }

  Light reflected(const materials::FresnelCoefficients& f) const {
    return passed(std::norm(f.r_s), std::norm(f.r_p), f.r_coherence * f.r_s * std::conj(f.r_p));
  }
  Light transmitted(const materials::FresnelCoefficients& f) const {
    return passed(std::norm(f.t_s), std::norm(f.t_p), f.t_coherence * f.t_s * std::conj(f.t_p));
  }

 private:
  /// \param cross amplitude coefficient of s times the conjugate amplitude coefficient of p
  Light passed(double power_s, double power_p, std::complex<double> cross) const {
    const double s = 0.5 * (stokes.i + stokes.q) * power_s;
    const double p = 0.5 * (stokes.i - stokes.q) * power_p;
    const std::complex<double> uv = cross * std::complex<double>(stokes.u, stokes.v);
    return {{s + p, s - p, uv.real(), uv.imag()}, s_axis};
  }
};

}  // namespace retrace::raytrace
