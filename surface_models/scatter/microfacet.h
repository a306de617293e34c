#pragma once

// Scatter from surfaces that are rough on a scale far above the wavelength, by geometrical optics of tilted
// microfacets.

#include <string>
#include <vector>

#include "core/warning.h"
#include "surface_models/scatter/slope_distribution.h"

namespace retrace::surface_models {

/// Facets that are large against the wavelength and reflect and refract like planes: Walter, Marschner, Li, Torrance,
/// EGSR 2007, with Smith's masking for each direction apart.
///
/// Light that a facet sends where other facets hide it, or to the wrong side of the mean surface, is lost: the weight
/// is the visible share of the outgoing direction, energy <= 1. Reciprocal, with n^2 in transmission.
class Microfacet {
 public:
  /// \param rms_slope areal, as waviness_rms_slope() gives it; >= 0
  /// \throw InputError
  Microfacet(SlopeShape shape, double rms_slope);
  /// Facets of waves with this rms height and period. \throw InputError
  static Microfacet of_waviness(SlopeShape shape, double waviness_sq_nm, double waviness_length_um);

  Facet sample_facet(const ScatterEvent& event, RandomStream& random) const;
  double specular_share(const ScatterEvent&, const Facet&, Lobe) const { return 1.0; }
  std::optional<Vec2> sample_scattered(const ScatterEvent&, const Facet&, Lobe, RandomStream&) const { return {}; }
  double scattered_density(const ScatterEvent&, const Facet&, Lobe, const Vec2&) const { return 0.0; }
  double unmasked_share(const Vec3& direction) const { return slopes_.visible_share(direction); }
  Warnings warnings(double index, double wavelength_nm) const;

  /// Normal of the facets that send the event's light to `direction`, if any do.
  std::optional<Vec3> facet_towards(const ScatterEvent& event, Lobe lobe, const Vec3& direction) const;
  /// BSDF per sr over all facets, without the Fresnel factor at facet_towards().
  double bsdf_per_sr(const ScatterEvent& event, Lobe lobe, const Vec3& direction) const;
  /// Density of directions that facets drawn by sample_facet() give.
  double pdf_per_sr(const ScatterEvent& event, Lobe lobe, const Vec3& direction) const;

 private:
  /// Solid angle of normals over that of directions.
  double jacobian(const ScatterEvent& event, Lobe lobe, const Vec3& direction, const Vec3& normal) const;

  SlopeDistribution slopes_;
  double waviness_sq_nm_ = 0.0;  ///< 0: not known, and no warning of waves too low for facets
};

}  // namespace retrace::surface_models
