#pragma once

#include <Eigen/Geometry>
#include <complex>

#include "geometry/vec.h"
#include "materials/fresnel.h"

namespace retrace::raytrace {

using geometry::Vec2;
using geometry::Vec3;

/// The polarisation state of a ray of unpolarised origin: the Jones matrix from two orthogonal incoherent input fields
/// to the components along s and p = direction x s. Amplitudes are scaled so that squares are power.
///
/// Averaging reflectances of s and p at every interface would be wrong after the second one: the first interface
/// polarises, and the next has another plane of incidence.
struct Field {
  std::complex<double> s_of[2] = {1.0, 0.0};
  std::complex<double> p_of[2] = {0.0, 1.0};
  Vec3 s_axis = Vec3::UnitX();

  /// Share of the incident power: the mean over the two input fields.
  double power() const {
    return 0.5 * (std::norm(s_of[0]) + std::norm(s_of[1]) + std::norm(p_of[0]) + std::norm(p_of[1]));
  }

  void scale(double amplitude) {
    for (auto& c : s_of) c *= amplitude;
    for (auto& c : p_of) c *= amplitude;
  }

  /// Describes the same field of a ray along `direction` with the s axis normal to the plane of incidence at an
  /// interface.
  void turn_to(const Vec3& direction, const Vec3& normal) {
    const Vec3 across = direction.cross(normal);
    const double norm2 = across.squaredNorm();
    if (norm2 < 1e-16) return;  // normal incidence: s and p are alike, any axis serves
    const Vec3 axis = across / std::sqrt(norm2);
    const double c = axis.dot(s_axis);
    const double s = axis.dot(direction.cross(s_axis));
    for (int k = 0; k < 2; ++k) {
      const std::complex<double> along_s = s_of[k];
      s_of[k] = c * along_s + s * p_of[k];
      p_of[k] = c * p_of[k] - s * along_s;
    }
    s_axis = axis;
  }

  Field reflected(const materials::FresnelCoefficients& f) const {
    Field out = *this;
    for (auto& c : out.s_of) c *= f.r_s;
    for (auto& c : out.p_of) c *= f.r_p;
    return out;
  }

  Field transmitted(const materials::FresnelCoefficients& f) const {
    Field out = *this;
    for (auto& c : out.s_of) c *= f.t_s;
    for (auto& c : out.p_of) c *= f.t_p;
    return out;
  }
};

}  // namespace retrace::raytrace
