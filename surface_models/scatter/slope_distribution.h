#pragma once

// Slope distributions of rough surfaces (Beckmann, GGX) with Smith's masking, for microfacets that act as small
// mirrors.

#include "surface_models/scatter/random_stream.h"
#include "surface_models/scatter/scatter_event.h"

namespace retrace::surface_models {

enum class SlopeShape {
  beckmann,  ///< Gaussian slopes
  ggx        ///< longer tails: Trowbridge and Reitz 1975, Walter et al. 2007
};

/// Maximum rms slope without a warning. Light that hits the surface more than once is neglected. Its fraction
/// increases with the square of the slope and is about a tenth at this value.
inline constexpr double kMaxSlopeWithoutWarning = 0.3;
/// Maximum areal rms slope, 45 degrees, for which there is a model. On steeper surfaces, most light hits the surface
/// more than once.
inline constexpr double kMaxModelledSlope = 1.0;

/// Isotropic distribution of the slopes of a surface, with Smith's masking. Smith's masking assumes that heights and
/// slopes of facets are independent (Walter, Marschner, Li, Torrance, Microfacet Models for Refraction through Rough
/// Surfaces, EGSR 2007). Visible facets: Heitz and d'Eon, Computer Graphics Forum 33, 103 (2014).
class SlopeDistribution {
 public:
  /// \param rms_slope areal rms slope (Sdq of ISO 25178-2: root mean square of the gradient), >= 0. For `ggx` it is the
  ///     width parameter, because the variance is infinite
  SlopeDistribution(SlopeShape shape, double rms_slope) : shape_(shape), width_(rms_slope) {}

  double rms_slope() const { return width_; }

  /// Returns the density of facets with `normal` (z > 0), per sr and per area of the mean surface: D of Walter et al.
  double normal_density_per_sr(const Vec3& normal) const;
  /// Returns the fraction of facets that are visible along `direction`, in either sense: Smith's G1.
  double visible_fraction(const Vec3& direction) const;
  /// Draws the normal of a facet that is hit by light from `towards_light` (z > 0).
  Vec3 sample_visible_normal(const Vec3& towards_light, RandomStream& random) const;
  /// Returns the density of sample_visible_normal(), per sr of normals.
  double visible_normal_pdf_per_sr(const Vec3& towards_light, const Vec3& normal) const;

 private:
  SlopeShape shape_;
  double width_;
};

/// Checks that a slope is within the range of the models.
/// \param what name of the texture for the message, such as "roughness"
/// \throw InputError if the slope is too large
void require_slope_in_range(double rms_slope, const char* what);

/// Returns the areal rms slope of waves with one period in all directions: 2 pi Sq / L. Returns 0 if the height is 0.
double waviness_rms_slope(double waviness_sq_nm, double waviness_length_um);

/// Returns two independent standard normal variates (Box and Muller 1958).
Vec2 normal_pair(RandomStream& random);

}  // namespace retrace::surface_models
