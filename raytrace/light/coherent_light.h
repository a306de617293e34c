#pragma once

// Light with its complex field (Jones matrix) in addition to its Stokes parameters. The field is needed for diffraction
// and interference in the far field.

#include <Eigen/Core>
#include <cmath>
#include <complex>

#include "raytrace/light/light.h"

namespace retrace::raytrace {

/// Jones matrix: amplitudes of the outgoing light for unit amplitudes of the incident light. Rows refer to the axes of
/// the outgoing light, columns to the axes of the incident light. The time dependence is exp(-i w t), as in
/// materials::FresnelCoefficients.
using JonesMatrix = Eigen::Matrix2cd;

/// Returns the coherency matrix of light that travels away from the source. Rows and columns refer to the two axes of
/// the source. The second axis points opposite to the p axis of this light.
inline Eigen::Matrix2cd coherency_of_source(const Stokes& s) {
  Eigen::Matrix2cd c;
  c << s.i + s.q, std::complex<double>(s.u, -s.v), std::complex<double>(s.u, s.v), s.i - s.q;
  return 0.5 * c;
}

/// Light with its field. Each interface changes the amplitudes together with the Stokes parameters. The rows of the
/// matrix refer to s and p, the columns to the two axes of the source.
struct CoherentLight : Light {
  JonesMatrix jones = JonesMatrix::Identity();

  void rotate_basis_to_axis(const Vec3& direction, const Vec3& axis) {
    const double c = axis.dot(s_axis);
    const double s = axis.dot(direction.cross(s_axis));
    Eigen::Matrix2d turn;
    turn << c, s, -s, c;
    jones = turn * jones;
    Light::rotate_basis_to_axis(direction, axis);
  }

  void rotate_basis_to_interface(const Vec3& direction, const Vec3& normal) {
    const Vec3 across = direction.cross(normal);
    const double norm2 = across.squaredNorm();
    if (norm2 < kNormalIncidence) return;
    rotate_basis_to_axis(direction, across / std::sqrt(norm2));
  }

  /// Reduces the power of the light.
  /// \param fraction fraction of the power that remains
  void scale(double fraction) {
    Light::scale(fraction);
    jones *= std::sqrt(fraction);
  }

  CoherentLight reflected(const materials::FresnelCoefficients& f) const {
    return passed(Light::reflected(f), f.r_s, f.r_p);
  }
  CoherentLight transmitted(const materials::FresnelCoefficients& f) const {
    return passed(Light::transmitted(f), f.t_s, f.t_p);
  }

 private:
  CoherentLight passed(const Light& light, std::complex<double> s, std::complex<double> p) const {
    CoherentLight result;
    static_cast<Light&>(result) = light;
    result.jones.row(0) = s * jones.row(0);
    result.jones.row(1) = p * jones.row(1);
    return result;
  }
};

}  // namespace retrace::raytrace
