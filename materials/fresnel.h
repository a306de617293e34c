#pragma once

// Fresnel's formulas: reflection and transmission amplitudes of plane interfaces between dielectrics and at metals.

#include <complex>

namespace retrace::materials {

/// Amplitude coefficients of a plane interface between transparent media, for the s and p components of the field.
///
/// Basis: s = d x n normalised, p = d x s, with d the direction of the wave concerned (incident, reflected or
/// refracted); at normal incidence r_p = -r_s. Time dependence exp(-i w t). Transmission amplitudes are scaled so that
/// their squares are shares of power: |r|^2 + |t|^2 = 1 for each component. They are real but behind layers. Born and
/// Wolf, Principles of Optics, 7th ed., 1.5.
struct FresnelCoefficients {
  std::complex<double> r_s;
  std::complex<double> r_p;
  std::complex<double> t_s;
  std::complex<double> t_p;
  /// Share of the coherence between s and p that light keeps: less than 1 where parts of it without a phase between
  /// them add up by power, behind thick layers.
  double r_coherence = 1.0;
  double t_coherence = 1.0;
  double cos_refracted = 0.0;  ///< 0 under total reflection
  bool total_reflection = false;
};

/// \param index_ratio n of the side the wave comes from over n of the other side, > 0
/// \param cos_incidence 0..1 (values beyond by rounding are clamped)
FresnelCoefficients fresnel(double index_ratio, double cos_incidence);

/// Of an opaque metal: the transmission amplitudes are 0 and total_reflection is set, though |r| < 1; what is not
/// reflected is absorbed. Born and Wolf, 14.2. \param index_ratio n of the side the wave comes from over n + i k
FresnelCoefficients fresnel_metal(std::complex<double> index_ratio, double cos_incidence);

/// Share of unpolarised power that a plane interface reflects.
double reflectance(double index_ratio, double cos_incidence);

}  // namespace retrace::materials
