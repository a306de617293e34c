#pragma once

// Fresnel equations: reflection and transmission amplitudes of plane interfaces between dielectrics and at metals.

#include <complex>

namespace retrace::materials {

/// Amplitude coefficients of a plane interface between transparent media, for the s and p components of the field.
///
/// Basis: s = d x n normalised, p = d x s, where d is the direction of the incident, reflected or refracted wave. At
/// normal incidence r_p = -r_s. The time dependence is exp(-i w t).
/// Transmission amplitudes are scaled such that their squares are fractions of power: |r|^2 + |t|^2 = 1 for each
/// component. They are real unless there are layers on the interface (Born and Wolf, Principles of Optics, 7th ed.,
/// 1.5).
struct FresnelCoefficients {
  std::complex<double> r_s, r_p;
  std::complex<double> t_s, t_p;
  /// Degree of coherence between s and p after the interface. It is less than 1 behind thick layers. Reflections in
  /// thick layers have no fixed phase relation, so their powers are added instead of their amplitudes.
  double r_coherence = 1.0;
  double t_coherence = 1.0;
  double cos_refracted = 0.0;  ///< 0 under total reflection
  bool total_reflection = false;
};

/// Returns the coefficients of an interface between transparent media.
/// \param index_ratio n on the side of the incident wave over n on the other side, > 0
/// \param cos_incidence 0..1; values outside because of rounding are clamped
FresnelCoefficients fresnel(double index_ratio, double cos_incidence);

/// Returns the coefficients of an opaque metal. The transmission amplitudes are 0 and total_reflection is set, although
/// |r| < 1. The remaining power is absorbed (Born and Wolf, 14.2).
/// \param index_ratio n on the side of the incident wave over n + i k of the metal
FresnelCoefficients fresnel_metal(std::complex<double> index_ratio, double cos_incidence);

/// Returns the fraction of unpolarised power that a plane interface reflects.
double reflectance(double index_ratio, double cos_incidence);

}  // namespace retrace::materials
