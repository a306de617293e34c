#pragma once

// Scatter from roughness and waviness with given statistics, by the generalized Harvey-Shack theory.

#include <array>
#include <memory>

#include "core/warning.h"
#include "materials/fresnel.h"
#include "surface_models/scatter/first_order.h"
#include "surface_models/scatter/phase_lobe.h"
#include "surface_models/scatter/slope_distribution.h"

namespace retrace::surface_models {

/// Heights with a Gaussian distribution and a Gaussian autocorrelation, plus longer waves. A value of 0 means smooth.
struct Roughness {
  double sq_nm = 0.0;                  ///< rms height, >= 0
  double correlation_length_um = 0.0;  ///< distance at which the autocorrelation is 1/e; > 0 unless sq_nm is 0
  double waviness_sq_nm = 0.0;         ///< rms height of the waviness, >= 0
  double waviness_length_um = 0.0;     ///< period of the waviness; > 0 unless waviness_sq_nm is 0
  /// Correlation length along y if it differs from that along x. 0: equal to that along x.
  double y_correlation_length_um = 0.0;

  bool is_isotropic() const {
    return y_correlation_length_um == 0.0 || y_correlation_length_um == correlation_length_um;
  }
};

/// Transparent media on both sides of a rough facet.
struct Dielectrics {
  double index = 1.0;       ///< index of the part's material relative to air, > 0
  double back_index = 1.0;  ///< index of the medium behind the facet relative to air, > 0
  double wavelength_nm = 0.0;
};

/// Mean number of diffractions at a facet before light leaves it. This is the mean of a Poisson distribution. For
/// correlation lengths well above the wavelength it is equal to the phase variance. Each array contains the values for
/// s and for p.
struct DiffractionMeans {
  std::array<double, 2> reflected{};
  std::array<double, 2> transmitted{};
};

/// Light that was diffracted once. It may leave to either side of the facet.
struct DiffractedOnce {
  Vec3 direction;                ///< in the frame of the event
  Vec3 s_axis;                   ///< axis of s, normal to the direction, in the same frame
  Polarisation2 coherency;       ///< for power 1, along s_axis and direction x s_axis
  Lobe lobe = Lobe::reflection;  ///< side to which the light leaves
};

/// Generalized Harvey-Shack scatter (PhaseLobe) from a Gaussian PSD (power spectral density).
///
/// Between dielectrics, light that is diffracted once follows first-order perturbation theory (first_order.h). That
/// theory includes polarisation, total reflection and both sides of the facet. The phase model below applies to light
/// that is diffracted several times, to roughness with a lay (different correlation lengths along x and y), and to
/// mirrors and metal-coated facets.
///
/// - The specular fraction is exp(-(4 pi n s cos t / w)^2) in reflection and exp(-(2 pi s (n1 cos t1 - n2 cos t2) /
/// w)^2) in transmission. s is the relevant roughness. It includes only spatial frequencies below n / w, because higher
/// ones scatter only into evanescent waves. For correlation lengths of at least 2 w / n, s equals Sq within 1e-9.
/// - The scattered light keeps its total power. If part of the lobe would be evanescent, the propagating part is scaled
/// up. Weights are 1, and both lobes conserve energy exactly.
/// - Waviness acts by its slopes (tilted facets, Gaussian) if its value of (4 pi n s cos t / w)^2 is at least
/// kSlopePhase2. Otherwise it is part of the PSD, as a Gaussian term with the same rms slope (correlation length L /
/// pi).
/// - The model is reciprocal except for the scaling of lobes. It is exactly reciprocal if the lobe is within the unit
/// disc and its shape depends only on the difference of direction cosines (docs/theory/scatter.md).
///
/// Events are in the frame of the facet. Directions are given by their cosines along its x and y.
class HarveyShack {
 public:
  /// \throw InputError if a value is out of range, or if the rms slope of the waviness is above kMaxModelledSlope, the
  ///     limit above which no scatter model is valid
  explicit HarveyShack(const Roughness& roughness);
  /// Creates a model between two dielectrics. First-order theory is used where it applies; roughness with a lay always
  /// uses the phase model.
  HarveyShack(const Roughness& roughness, const Dielectrics& media);

  const Roughness& roughness() const { return roughness_; }
  bool is_between_dielectrics() const { return media_ != nullptr; }

  /// \param fresnel coefficients of the facet's plane for this event
  /// \pre is_between_dielectrics(); the indices of the event are those of the media of the model
  DiffractionMeans diffraction_means(const ScatterEvent& event, const Facet& facet,
                                     const materials::FresnelCoefficients& fresnel) const;
  /// Draws light that is diffracted once. It may leave to either side of the facet. Returns nothing if no direction is
  /// found.
  /// \param s_axis unit vector normal to event.direction_in and to the facet's normal
  /// \param coherency coherency of the incident light along s_axis and p, with the trace 1
  /// \pre is_between_dielectrics(); the indices of the event are those of the media of the model
  std::optional<DiffractedOnce> draw_diffracted_once(const ScatterEvent& event, const Facet& facet, const Vec3& s_axis,
                                                     const Polarisation2& coherency, RandomStream& random) const;
  /// Returns the light that is diffracted once into a direction. The trace of its coherency is the probability density,
  /// per unit area of direction cosines, with which draw_diffracted_once() selects this direction.
  /// \param direction unit vector in the frame of the event, on the side of the lobe
  DiffractedOnce diffracted_once_into(const ScatterEvent& event, const Facet& facet, const Vec3& s_axis,
                                      const Polarisation2& coherency, const Vec3& direction) const;
  /// Returns the fraction of the incident power per d2beta that is scattered according to first-order theory. beta
  /// are the direction cosines on the side of the lobe.
  /// \pre is_between_dielectrics(); the indices of the event are those of the media of the model
  double diffracted_once_density(const ScatterEvent& event, const Facet& facet, Lobe lobe, const Vec3& s_axis,
                                 const Polarisation2& coherency, const Vec2& beta) const;

  /// \param event in the frame of the mean surface
  Facet sample_facet(const ScatterEvent& event, RandomStream& random) const;
  double specular_fraction(const ScatterEvent& event, const Facet& facet, Lobe lobe) const;
  /// Returns 1 - specular_fraction(), with full precision even if the result is small.
  double scattered_fraction(const ScatterEvent& event, const Facet& facet, Lobe lobe) const;
  /// Returns the random phase that the heights add to a lobe. The specular fraction is exp(-variance).
  PhaseTexture phase_texture(const ScatterEvent& event, Lobe lobe) const;
  /// Draws the direction of light, given that it is scattered. Returns nothing if no direction is found.
  /// \param min_orders minimum number of diffractions
  std::optional<Vec2> draw_scattered(const ScatterEvent& event, const Facet& facet, Lobe lobe, RandomStream& random,
                                     int min_orders = 1) const;
  /// Returns the density of scattered light over direction cosines, as a fraction of the lobe's power. This is the
  /// lobe's BSDF without its Fresnel factor, per sr. Computed by quadrature: for tests and tables, but too slow for
  /// each ray.
  double scattered_density(const ScatterEvent& event, const Facet& facet, Lobe lobe, const Vec2& beta) const;
  /// Returns the fraction of light into `direction` that the waviness does not mask. The direction is in the frame of
  /// the mean surface.
  double unmasked_fraction(const Vec3& direction) const { return slopes_.visible_fraction(direction); }
  /// Checks that a scatter model is valid for the rms slope of the roughness. The slope includes only the spatial
  /// frequencies that cause scatter.
  /// \throw InputError if this slope is above kMaxModelledSlope
  void require_in_range(double index, double wavelength_nm) const;
  /// Returns a warning for each condition of the model that is violated at this wavelength. The index is that of the
  /// denser side.
  Warnings warnings(double index, double wavelength_nm) const;

  /// Returns the density before it is scaled to the scattered fraction. In reflection, it is symmetric under exchange
  /// of the directions. In transmission, this holds for the density divided by n^2 of the side to which the light goes.
  double unscaled_density(const ScatterEvent& event, const Facet& facet, Lobe lobe, const Vec2& beta) const;

  /// Returns the distribution of waviness slopes, for tests of sample_facet().
  const SlopeDistribution& slopes() const { return slopes_; }

 private:
  /// Statistics of the spatial frequencies that scatter in an event: the rms height of roughness and waviness together,
  /// and the spread of direction cosines that each of them causes.
  struct Band {
    double sq_nm = 0.0;
    double roughness_fraction = 0.0;         ///< fraction of sq_nm^2 that is due to roughness
    Vec2 roughness_variance = Vec2::Zero();  ///< variance of the shift by one diffraction, along x and along y
    Vec2 waviness_variance = Vec2::Zero();
  };
  Band band(const ScatterEvent& event, const Facet& facet, Lobe lobe) const;
  static double shift_density(const Band& band, int order, const Vec2& shift);

  /// Tables for incident light from one side.
  struct Side;
  struct Media;
  const Side& side_of(const ScatterEvent& event) const;
  /// Gaussian part of the height spectrum.
  struct Part {
    double sq_nm = 0.0;
    double length_um = 0.0;
  };
  /// Returns roughness, and waviness if it acts by diffraction.
  std::array<Part, 2> parts(const Facet& facet) const;
  /// Returns the fractions of the power of s and of p that are scattered according to first-order theory, summed over
  /// both sides.
  std::array<double, 2> first_order_fractions(const ScatterEvent& event, const Facet& facet) const;
  /// Returns the scattered light. The trace of its coherency is the scattered fraction of the incident power, per unit
  /// area of wave vectors along the facet.
  DiffractedOnce scattered_once(const ScatterEvent& event, const Facet& facet, Lobe lobe, const Vec3& s_axis,
                                const Polarisation2& coherency, const Vec2& k_out) const;

  Roughness roughness_;
  SlopeDistribution slopes_;
  std::shared_ptr<const Media> media_;  ///< null if only the phase model is used; shared by copies
};

}  // namespace retrace::surface_models
