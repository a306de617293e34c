#pragma once

// Types that tracers and scatter models exchange: the incident light in the local frame, the facet that it hits, and
// the direction that is drawn.

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "geometry/vec.h"

namespace retrace::surface_models {

using geometry::Vec2, geometry::Vec3;

/// Lobe: the light from an interface to one side. It is either reflected to the side of the incident light or
/// transmitted to the other side.
enum class Lobe { reflection, transmission };

/// Light that is incident on a textured interface.
///
/// Directions are unit vectors of propagation in the local frame of the mean surface. z is the surface normal on the
/// side of the incident light. x and y are the axes of the texture, or arbitrary if the texture is isotropic. For light
/// inside the material, z is opposite to the texture's own z. x is then the x axis of the texture, and y is opposite to
/// its y axis.
struct ScatterEvent {
  Vec3 direction_in = -Vec3::UnitZ();  ///< z < 0
  double index_from = 1.0;             ///< index on the side of the incident light, > 0
  double index_to = 1.0;               ///< index on the other side, > 0
  double wavelength_nm = 0.0;          ///< in vacuum, > 0
  bool inside_material = false;        ///< true if the light comes from the material side of the texture

  double cos_in() const { return std::clamp(-direction_in.z(), 0.0, 1.0); }
  /// Returns the index on the side to which a lobe goes.
  double index_of(Lobe lobe) const { return lobe == Lobe::reflection ? index_from : index_to; }
};

/// Surface element that the light hits. The Fresnel equations apply at its normal, not at the mean normal.
struct Facet {
  Vec3 normal = Vec3::UnitZ();  ///< local frame, z > 0, towards the incident light
  bool is_tilted = false;       ///< true if the facet was drawn from slopes; false: the mean surface
};

/// Random phase that the heights of a texture add to the light of a lobe. It is a Gaussian random function of the
/// position on the facet. At the distance d its covariance is the sum of rms_rad^2 exp(-d^2 / length_mm^2) over all
/// terms. For the covariance between two lobes, rms_rad^2 is replaced by the product of the two values of rms_rad.
struct PhaseTexture {
  struct Term {
    /// Rms phase. It is negative if a height increase (outwards from the material) shortens the optical path.
    double rms_rad = 0.0;
    double length_mm = 1.0;  ///< > 0
  };
  std::array<Term, 2> terms;  ///< terms for roughness and for waviness

  double variance() const {
    double sum = 0.0;
    for (const Term& term : terms) sum += term.rms_rad * term.rms_rad;
    return sum;
  }
};

/// Direction that was drawn from a lobe.
struct ScatterSample {
  Vec3 direction;            ///< in the local frame
  Vec3 specular_direction;   ///< specular direction of the facet's mean plane, in the same frame
  double weight = 1.0;       ///< factor by which the Fresnel power of the lobe is multiplied: BSDF * cosine / pdf; <= 1
  bool is_specular = false;  ///< true if the direction is exactly specular
};

/// Returns the specular direction for a plane with `normal` (towards the incident light). Returns nothing in
/// transmission under total reflection.
inline std::optional<Vec3> specular_direction(const ScatterEvent& event, const Vec3& normal, Lobe lobe) {
  const double cos_in = -event.direction_in.dot(normal);
  if (lobe == Lobe::reflection) return event.direction_in + 2.0 * cos_in * normal;
  const double ratio = event.index_from / event.index_to;
  const double cos2 = 1.0 - ratio * ratio * (1.0 - cos_in * cos_in);
  if (cos2 <= 0.0) return std::nullopt;
  return ratio * event.direction_in + (ratio * cos_in - std::sqrt(cos2)) * normal;
}

/// Returns true if `direction` is on the side of the mean surface to which the lobe goes.
inline bool is_on_side(const Vec3& direction, Lobe lobe) {
  return lobe == Lobe::reflection ? direction.z() > 0.0 : direction.z() < 0.0;
}

/// Returns the unit vector on the lobe's side with the direction cosines `beta` along x and y, |beta| <= 1.
inline Vec3 direction_of(const Vec2& beta, Lobe lobe) {
  const double z = std::sqrt(std::max(0.0, 1.0 - beta.squaredNorm()));
  return {beta.x(), beta.y(), lobe == Lobe::reflection ? z : -z};
}

}  // namespace retrace::surface_models
