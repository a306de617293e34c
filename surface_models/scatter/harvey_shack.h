#pragma once

// Scatter from roughness and waviness given by their statistics, by the generalized Harvey-Shack theory.

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "core/warning.h"
#include "materials/fresnel.h"
#include "surface_models/scatter/first_order.h"
#include "surface_models/scatter/phase_lobe.h"
#include "surface_models/scatter/slope_distribution.h"

namespace retrace::surface_models {

/// Heights with a Gaussian distribution and Gaussian autocorrelation, and longer waves on top. 0 is smooth.
struct Roughness {
  double sq_nm = 0.0;                  ///< rms height, >= 0
  double correlation_length_um = 0.0;  ///< where the autocorrelation is 1/e; > 0 unless sq_nm is 0
  double waviness_sq_nm = 0.0;         ///< rms height of the waviness, >= 0
  double waviness_length_um = 0.0;     ///< its period; > 0 unless waviness_sq_nm is 0
  /// Correlation length along y, where it is unlike the one along x; 0: the same
  double y_correlation_length_um = 0.0;

  bool is_isotropic() const {
    return y_correlation_length_um == 0.0 || y_correlation_length_um == correlation_length_um;
  }
};

/// The media on both sides of a rough facet, both transparent.
struct Dielectrics {
  double index = 1.0;       ///< of the part's material, relative to air, > 0
  double back_index = 1.0;  ///< of what lies behind the facet, likewise
  double wavelength_nm = 0.0;
};

/// How often light is diffracted at a facet, on average, before it leaves: Poisson's mean, which the phase variance is
/// where heights are long against the wavelength. By polarisation, s before p.
struct DiffractionMeans {
  std::array<double, 2> reflected{};
  std::array<double, 2> transmitted{};
};

/// Light that has been diffracted once, on either side.
struct DiffractedOnce {
  Vec3 direction;                ///< frame of the event
  Vec3 s_axis;                   ///< across it, same frame
  Polarisation2 coherency;       ///< of power 1, along s_axis and direction x s_axis
  Lobe lobe = Lobe::reflection;  ///< the side it leaves to
};

/// Generalized Harvey-Shack scatter (PhaseLobe) from a Gaussian PSD.
///
/// Between dielectrics, light that is diffracted once follows first-order perturbation theory instead, which knows
/// polarisation, total reflection and both sides at once (first_order.h); what is diffracted more than once, roughness
/// with a lay, and facets that are mirrors or coated with metal, the phase alone:
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
  /// The same between two dielectrics, as far as first order serves: roughness with a lay keeps the phase alone.
  HarveyShack(const Roughness& roughness, const Dielectrics& media);

  const Roughness& roughness() const { return roughness_; }
  bool is_between_dielectrics() const { return media_ != nullptr; }

  /// \param fresnel of the facet's plane for this event \pre is_between_dielectrics(), and the event is in its media
  DiffractionMeans diffraction_means(const ScatterEvent& event, const Facet& facet,
                                     const materials::FresnelCoefficients& fresnel) const;
  /// Draws light that is diffracted once, in both hemispheres. Nothing if no direction can be found.
  /// \param s_axis across event.direction_in and the normal, unit \param coherency of the incident light along s_axis
  /// and p, of trace 1 \pre as above
  std::optional<DiffractedOnce> draw_diffracted_once(const ScatterEvent& event, const Facet& facet, const Vec3& s_axis,
                                                     const Polarisation2& coherency, RandomStream& random) const;
  /// Light that is diffracted once into a direction: the trace of its coherency is the density over direction cosines
  /// of what draw_diffracted_once() draws. \param direction unit, frame of the event; its side is that of the lobe
  DiffractedOnce diffracted_once_into(const ScatterEvent& event, const Facet& facet, const Vec3& s_axis,
                                      const Polarisation2& coherency, const Vec3& direction) const;
  /// Share of the power of light of this coherency that first order scatters into d2beta, direction cosines on the side
  /// of the lobe. \pre as above
  double diffracted_once_density(const ScatterEvent& event, const Facet& facet, Lobe lobe, const Vec3& s_axis,
                                 const Polarisation2& coherency, const Vec2& beta) const;

  /// \param event in the frame of the mean surface
  Facet sample_facet(const ScatterEvent& event, RandomStream& random) const;
  double specular_share(const ScatterEvent& event, const Facet& facet, Lobe lobe) const;
  /// One less the same, to full precision where that is small.
  double scattered_share(const ScatterEvent& event, const Facet& facet, Lobe lobe) const;
  /// What the heights do to the phase of a lobe; the exponential of less its variance is the specular share.
  PhaseTexture phase_texture(const ScatterEvent& event, Lobe lobe) const;
  /// Draws the direction of light, given that it scatters. Nothing if no direction can be found.
  /// \param least_orders how often it has been diffracted at least
  std::optional<Vec2> draw_scattered(const ScatterEvent& event, const Facet& facet, Lobe lobe, RandomStream& random,
                                     int least_orders = 1) const;
  /// Density of scattered light per unit of direction cosines squared, as a share of the lobe's power: the lobe's BSDF
  /// without its Fresnel factor, per sr. By quadrature: for tests and tables, not for every ray.
  double scattered_density(const ScatterEvent& event, const Facet& facet, Lobe lobe, const Vec2& beta) const;
  /// Share of light into `direction` (frame of the mean surface) that the waviness does not mask.
  double unmasked_share(const Vec3& direction) const { return slopes_.visible_share(direction); }
  /// \throw InputError where the slopes of what scatters are beyond every model
  void require_in_range(double index, double wavelength_nm) const;
  /// What lies outside the model's range at this index (of the denser side) and wavelength, one sentence each.
  Warnings warnings(double index, double wavelength_nm) const;

  /// The density before scaling to the scattered share: symmetric under exchange of the directions in reflection, and
  /// over n^2 of the side it goes to in transmission.
  double unscaled_density(const ScatterEvent& event, const Facet& facet, Lobe lobe, const Vec2& beta) const;

  /// The distribution of waviness slopes, for tests of sample_facet().
  const SlopeDistribution& slopes() const { return slopes_; }

 private:
  /// What scatters in an event: Sq of both parts, and the widths of their spectra in direction cosines.
  struct Band {
    double sq_nm = 0.0;
    double roughness_share = 0.0;            ///< of sq_nm squared
    Vec2 roughness_variance = Vec2::Zero();  ///< of one shift, along x and along y
    Vec2 waviness_variance = Vec2::Zero();
  };
  Band band(const ScatterEvent& event, const Facet& facet, Lobe lobe) const;
  static double shift_density(const Band& band, int order, const Vec2& shift);

  /// Tables of one side that light comes from.
  struct Side;
  struct Media;
  const Side& side_of(const ScatterEvent& event) const;
  /// A Gaussian part of the spectrum of heights.
  struct Part {
    double sq_nm = 0.0;
    double length_um = 0.0;
  };
  /// Roughness, and waviness that diffracts.
  std::array<Part, 2> parts(const Facet& facet) const;
  /// Of the power of s and of p, what first order scatters, summed over both sides.
  std::array<double, 2> first_order_shares(const ScatterEvent& event, const Facet& facet) const;
  /// With the trace of its coherency the density over wave vectors along the facet, as a share of the incident power.
  DiffractedOnce scattered_once(const ScatterEvent& event, const Facet& facet, Lobe lobe, const Vec3& s_axis,
                                const Polarisation2& coherency, const Vec2& k_out) const;

  Roughness roughness_;
  SlopeDistribution slopes_;
  std::shared_ptr<const Media> media_;  ///< null where the phase theory stands alone; copies share it
};

}  // namespace retrace::surface_models
