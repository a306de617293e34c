#pragma once

// Scatter from surfaces whose roughness is coarse compared with the wavelength, by geometrical optics of tilted
// microfacets.

#include "core/warning.h"
#include "surface_models/scatter/slope_distribution.h"

namespace retrace::surface_models {

/// Facets that are large compared with the wavelength and that reflect and refract like planes (Walter, Marschner, Li,
/// Torrance, EGSR 2007). Smith's masking is applied to each direction separately.
///
/// Light that is masked by other facets or leaves to the wrong side of the mean surface is lost. The weight is the
/// visible fraction for the outgoing direction, so the energy is at most 1. The model is reciprocal, with the factor
/// n^2 in transmission.
class Microfacet {
 public:
  /// \param rms_slope areal rms slope, for example from waviness_rms_slope(); >= 0
  /// \throw InputError if the slope is out of range
  Microfacet(SlopeShape shape, double rms_slope);
  /// Returns a model for waviness with this rms height and period.
  /// \throw InputError if the slope is out of range
  static Microfacet of_waviness(SlopeShape shape, double waviness_sq_nm, double waviness_length_um);

  Facet sample_facet(const ScatterEvent& event, RandomStream& random) const;
  double specular_fraction(const ScatterEvent&, const Facet&, Lobe) const { return 1.0; }
  std::optional<Vec2> sample_scattered(const ScatterEvent&, const Facet&, Lobe, RandomStream&) const { return {}; }
  double scattered_density(const ScatterEvent&, const Facet&, Lobe, const Vec2&) const { return 0.0; }
  double unmasked_fraction(const Vec3& direction) const { return slopes_.visible_fraction(direction); }
  Warnings warnings(double index, double wavelength_nm) const;

  /// Returns the normal of facets that send the event's light to `direction`, or nothing if there is none.
  std::optional<Vec3> facet_towards(const ScatterEvent& event, Lobe lobe, const Vec3& direction) const;
  /// Returns the BSDF per sr over all facets, without the Fresnel factor at facet_towards().
  double bsdf_per_sr(const ScatterEvent& event, Lobe lobe, const Vec3& direction) const;
  /// Returns the density of directions when facets are drawn by sample_facet().
  double pdf_per_sr(const ScatterEvent& event, Lobe lobe, const Vec3& direction) const;

 private:
  /// Returns the solid angle of normals divided by the solid angle of directions.
  double jacobian(const ScatterEvent& event, Lobe lobe, const Vec3& direction, const Vec3& normal) const;

  SlopeDistribution slopes_;
  /// Rms height of the waviness. If it is unknown, it is 0, and warnings() does not report waviness that is too low for
  /// this model.
  double waviness_sq_nm_ = 0.0;
};

}  // namespace retrace::surface_models
