#pragma once

// Slopes of rough surfaces (Beckmann, GGX) with Smith's masking, for facets that act as small mirrors.

#include "surface_models/scatter/random_stream.h"
#include "surface_models/scatter/scatter_event.h"

namespace retrace::surface_models {

enum class SlopeShape {
  beckmann,  ///< Gaussian slopes
  ggx        ///< longer tails: Trowbridge and Reitz 1975, Walter et al. 2007
};

/// Light that meets a surface twice is left out here; its share grows with the square of the slope, about a tenth from
/// this rms slope on.
inline constexpr double kLargestSlope = 0.3;
/// No model holds for areal rms slopes above this one, 45 degrees: most light then meets the surface more than once.
inline constexpr double kSlopeOfNoModel = 1.0;

/// Isotropic distribution of the slopes of a surface with masking after Smith: facets are of different heights,
/// independent of their slopes. Walter, Marschner, Li, Torrance, Microfacet Models for Refraction through Rough
/// Surfaces, EGSR 2007; visible facets: Heitz and d'Eon, Computer Graphics Forum 33, 103 (2014).
class SlopeDistribution {
 public:
  /// \param rms_slope areal (Sdq of ISO 25178-2: root of the mean square of the gradient), >= 0; for `ggx` its width,
  ///        as the variance has no bound there
  SlopeDistribution(SlopeShape shape, double rms_slope) : shape_(shape), width_(rms_slope) {}

  double rms_slope() const { return width_; }

  /// Density of facets with `normal` (z > 0), per sr and area of the mean surface: D of Walter et al.
  double normal_density_per_sr(const Vec3& normal) const;
  /// Share of the facets turned to `direction` (either way along it) that others do not hide: Smith's G1.
  double visible_share(const Vec3& direction) const;
  /// Draws the normal of a facet that light from `towards_light` (z > 0) meets.
  Vec3 sample_visible_normal(const Vec3& towards_light, RandomStream& random) const;
  /// Its density, per sr of normals.
  double visible_normal_pdf_per_sr(const Vec3& towards_light, const Vec3& normal) const;

 private:
  SlopeShape shape_;
  double width_;
};

/// \throw InputError for a slope that is outside of every model; `what` has it, as in "roughness"
void require_modelled_slope(double rms_slope, const char* what);

/// Areal rms slope of waves of one period in any direction: 2 pi Sq / L. 0 for no height.
double waviness_rms_slope(double waviness_sq_nm, double waviness_length_um);

/// A pair of independent standard normal variates (Box and Muller 1958).
Vec2 normal_pair(RandomStream& random);

}  // namespace retrace::surface_models
