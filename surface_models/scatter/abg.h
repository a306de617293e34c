#pragma once

// ABG model of scatter: a BSDF that is fitted to measured scatter. It is used if the heights of the surface are not
// known.

#include "core/warning.h"
#include "surface_models/scatter/random_stream.h"
#include "surface_models/scatter/scatter_event.h"

namespace retrace::surface_models {

/// Fit of measured scatter with three parameters: BSDF = A / (B + |dbeta|^g) per sr. dbeta is the difference of
/// direction cosines from the specular direction (Pfisterer, Optics and Photonics News 22(10), 16 (2011)). The BSDF is
/// relative to the Fresnel power of the lobe. It is the same function in reflection and transmission.
///
/// Light that is not scattered is specular. Scatter into evanescent directions is added to the specular light. All
/// samples have the weight 1, and energy is conserved exactly. The model is reciprocal in reflection.
class Abg {
 public:
  /// \param a parameter A, > 0, per sr. The total scattered fraction must be at most 1. This fraction is 2 pi times the
  ///     integral of r A / (B + r^g) over r = |dbeta| from 0 to 2
  /// \param b parameter B, > 0
  /// \param g parameter g, > 0
  /// \throw InputError if a parameter is out of range
  Abg(double a, double b, double g);

  Facet sample_facet(const ScatterEvent&, RandomStream&) const { return {}; }
  /// Returns the specular fraction, computed by quadrature. This is for tests and tables; it is too slow for each ray.
  double specular_fraction(const ScatterEvent& event, const Facet&, Lobe lobe) const;
  /// Returns the minimum of specular_fraction() over all directions of incidence.
  double min_specular_fraction() const { return 1.0 - total_; }
  /// Draws the direction of scattered light. Returns nothing if the light is specular.
  std::optional<Vec2> sample_scattered(const ScatterEvent& event, const Facet&, Lobe lobe, RandomStream& random) const;
  double scattered_density(const ScatterEvent& event, const Facet&, Lobe lobe, const Vec2& beta) const;
  double unmasked_fraction(const Vec3&) const { return 1.0; }
  Warnings warnings(double index, double wavelength_nm) const;

 private:
  double bsdf_per_sr(double shift) const { return a_ / (b_ + std::pow(shift, g_)); }
  double sample_shift(RandomStream& random) const;
  double tail_integral(double from, double to) const;

  double a_, b_, g_;
  double shoulder_;     ///< |dbeta| at which the two terms of the denominator are equal, at most 2
  double total_ = 0.0;  ///< integral of the BSDF over |dbeta| < 2
};

}  // namespace retrace::surface_models
