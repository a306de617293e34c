#pragma once

// The ABG model of scatter: a BSDF fitted to measurements, where nothing is known of the surface itself.

#include <string>
#include <vector>

#include "core/warning.h"
#include "surface_models/scatter/random_stream.h"
#include "surface_models/scatter/scatter_event.h"

namespace retrace::surface_models {

/// The three-parameter fit to measured scatter, BSDF = A / (B + |dbeta|^g) per sr, with dbeta the difference of
/// direction cosines from the specular direction (Pfisterer, Optics and Photonics News 22(10), 16 (2011)). It is taken
/// relative to the lobe's Fresnel power, alike in reflection and transmission.
///
/// The specular light is what the BSDF leaves; scatter that would go evanescent stays specular. Weights are 1 and
/// energy is conserved exactly. Reciprocal in reflection.
class Abg {
 public:
  /// \param a > 0, per sr, small enough that no more than all light scatters: pi * 2 * integral of r A / (B + r^g) over
  ///        r = |dbeta| from 0 to 2 is at most 1
  /// \param b > 0
  /// \param g > 0
  /// \throw InputError otherwise
  Abg(double a, double b, double g);

  Facet sample_facet(const ScatterEvent&, RandomStream&) const { return {}; }
  /// By quadrature: for tests and tables, not for every ray.
  double specular_share(const ScatterEvent& event, const Facet&, Lobe lobe) const;
  /// Of all directions of incidence.
  double least_specular_share() const { return 1.0 - total_; }
  /// Draws the direction of light that scatters; nothing for light that is specular.
  std::optional<Vec2> sample_scattered(const ScatterEvent& event, const Facet&, Lobe lobe, RandomStream& random) const;
  double scattered_density(const ScatterEvent& event, const Facet&, Lobe lobe, const Vec2& beta) const;
  double unmasked_share(const Vec3&) const { return 1.0; }
  Warnings warnings(double index, double wavelength_nm) const;

 private:
  double bsdf_per_sr(double shift) const { return a_ / (b_ + std::pow(shift, g_)); }
  double sample_shift(RandomStream& random) const;
  double tail_integral(double from, double to) const;

  double a_, b_, g_;
  double shoulder_;     ///< |dbeta| where both terms of the denominator are alike, at most 2
  double total_ = 0.0;  ///< integral of the BSDF over |dbeta| < 2
};

}  // namespace retrace::surface_models
