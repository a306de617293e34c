#pragma once

// Scatter from roughness and waviness given by their statistics, by the generalized Harvey-Shack theory.

#include <string>
#include <vector>

#include "surface_models/scatter/phase_lobe.h"
#include "surface_models/scatter/slope_distribution.h"

namespace retrace::surface_models {

/// Heights with a Gaussian distribution and Gaussian autocorrelation, and longer waves on top. 0 is smooth.
struct Roughness {
  double sq_nm = 0.0;                  ///< rms height, >= 0
  double correlation_length_um = 0.0;  ///< where the autocorrelation is 1/e; > 0 unless sq_nm is 0
  double waviness_sq_nm = 0.0;         ///< rms height of the waviness, >= 0
  double waviness_length_um = 0.0;     ///< its period; > 0 unless waviness_sq_nm is 0
};

/// Generalized Harvey-Shack scatter (PhaseLobe) from a Gaussian PSD.
///
/// - Reflection keeps exp(-(4 pi n s cos t / w)^2) specular, transmission exp(-(2 pi s (n1 cos t1 - n2 cos t2) / w)^2),
///   with s the relevant roughness: that of spatial frequencies below n / w, which alone can leave as waves. For
///   correlation lengths from 2 w / n on it is Sq to 1e-9.
/// - The scattered rest keeps its power whatever part of the lobe would go evanescent: the propagating part is scaled
///   up. Weights are 1, both lobes conserve energy exactly.
/// - Waviness acts by its slopes (tilted facets, Gaussian) where its own (4 pi n s cos t / w)^2 is at least
///   kSlopePhase2. Below, it is part of the PSD as a Gaussian one of the same rms slope (correlation length L / pi).
/// - Reciprocal up to that scaling: exactly where the lobe lies inside the unit disc and its shape depends on the
///   difference of direction cosines alone; see docs/theory/scatter.md.
///
/// Functions take events in the frame of the facet; directions by their cosines along its x and y.
class HarveyShack {
 public:
  /// \throw InputError for a value out of range, a slope of the waviness beyond every model among them
  explicit HarveyShack(const Roughness& roughness);

  const Roughness& roughness() const { return roughness_; }

  /// \param event in the frame of the mean surface
  Facet sample_facet(const ScatterEvent& event, RandomStream& random) const;
  double specular_share(const ScatterEvent& event, const Facet& facet, Lobe lobe) const;
  /// One less the same, to full precision where that is small.
  double scattered_share(const ScatterEvent& event, const Facet& facet, Lobe lobe) const;
  /// What the heights do to the phase of a lobe; the exponential of less its variance is the specular share.
  PhaseTexture phase_texture(const ScatterEvent& event, Lobe lobe) const;
  /// Draws the direction of light, given that it scatters. Nothing if no direction can be found.
  std::optional<Vec2> draw_scattered(const ScatterEvent& event, const Facet& facet, Lobe lobe,
                                     RandomStream& random) const;
  /// Density of scattered light per unit of direction cosines squared, as a share of the lobe's power: the lobe's BSDF
  /// without its Fresnel factor, per sr. By quadrature: for tests and tables, not for every ray.
  double scattered_density(const ScatterEvent& event, const Facet& facet, Lobe lobe, const Vec2& beta) const;
  /// Share of light into `direction` (frame of the mean surface) that the waviness does not mask.
  double unmasked_share(const Vec3& direction) const { return slopes_.visible_share(direction); }
  /// \throw InputError where the slopes of what scatters are beyond every model
  void require_in_range(double index, double wavelength_nm) const;
  /// What lies outside the model's range at this index (of the denser side) and wavelength, one sentence each.
  std::vector<std::string> warnings(double index, double wavelength_nm) const;

  /// The density before scaling to the scattered share: symmetric under exchange of the directions in reflection, and
  /// over n^2 of the side it goes to in transmission.
  double unscaled_density(const ScatterEvent& event, const Facet& facet, Lobe lobe, const Vec2& beta) const;

  /// The distribution of waviness slopes, for tests of sample_facet().
  const SlopeDistribution& slopes() const { return slopes_; }

 private:
  /// What scatters in an event: Sq of both parts, and the widths of their spectra in direction cosines.
  struct Band {
    double sq_nm = 0.0;
    double roughness_share = 0.0;     ///< of sq_nm squared
    double roughness_variance = 0.0;  ///< of one shift, along each axis
    double waviness_variance = 0.0;
  };
  Band band(const ScatterEvent& event, const Facet& facet, Lobe lobe) const;
  static double shift_density(const Band& band, int order, double shift2);

  Roughness roughness_;
  SlopeDistribution slopes_;
};

}  // namespace retrace::surface_models
