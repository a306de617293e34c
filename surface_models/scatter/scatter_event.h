#pragma once

// The terms in which tracers and scatter models speak: incident light in the local frame, the facet it meets, and the
// direction that is drawn.

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "geometry/vec.h"

namespace retrace::surface_models {

using geometry::Vec2, geometry::Vec3;

/// What becomes of light at an interface: it stays on its side or goes to the other one.
enum class Lobe { reflection, transmission };

/// Light that meets a textured interface.
///
/// Directions are unit vectors of travel in the local frame of the mean surface: z is its normal on the side that the
/// light comes from; x and y are those of the texture where it has directions (height maps), any otherwise. For light
/// inside the material, where z is against the texture's own, x is the texture's and y its reverse.
struct ScatterEvent {
  Vec3 direction_in = -Vec3::UnitZ();  ///< z < 0
  double index_from = 1.0;             ///< of the side the light comes from, > 0
  double index_to = 1.0;               ///< of the other side, > 0
  double wavelength_nm = 0.0;          ///< in vacuum, > 0
  bool inside_material = false;        ///< which side of the texture the light comes from

  double cos_in() const { return std::clamp(-direction_in.z(), 0.0, 1.0); }
  /// Index of the side that a lobe goes to.
  double index_of(Lobe lobe) const { return lobe == Lobe::reflection ? index_from : index_to; }
};

/// The piece of the surface that the light meets. Fresnel's formulas hold at its normal, not at the mean one.
struct Facet {
  Vec3 normal = Vec3::UnitZ();  ///< local frame, z > 0, and against the light
  bool is_tilted = false;       ///< drawn from slopes; else it is the mean surface
};

/// The phase that a texture's heights put on the light of a lobe: a Gaussian random function of the place on the facet,
/// with the covariance sum rms_rad^2 exp(-d^2 / length_mm^2) at the distance d. Of two lobes at one place the product
/// of their rms_rad takes the place of the square.
struct PhaseTexture {
  struct Term {
    double rms_rad = 0.0;    ///< < 0 where heights out of the material shorten the way
    double length_mm = 1.0;  ///< > 0
  };
  std::array<Term, 2> terms;  ///< of roughness and of waviness

  double variance() const {
    double sum = 0.0;
    for (const Term& term : terms) sum += term.rms_rad * term.rms_rad;
    return sum;
  }
};

/// One direction drawn from a lobe.
struct ScatterSample {
  Vec3 direction;            ///< local frame
  Vec3 specular_direction;   ///< where the facet's mean plane would send the light, same frame
  double weight = 1.0;       ///< factor on the Fresnel power of the lobe at the facet: BSDF * cosine / pdf; <= 1
  bool is_specular = false;  ///< exactly what the facet's plane does
};

/// Direction that a plane with `normal` (against the light) sends the light to; nothing under total reflection.
inline std::optional<Vec3> specular_direction(const ScatterEvent& event, const Vec3& normal, Lobe lobe) {
  const double cos_in = -event.direction_in.dot(normal);
  if (lobe == Lobe::reflection) return event.direction_in + 2.0 * cos_in * normal;
  const double ratio = event.index_from / event.index_to;
  const double cos2 = 1.0 - ratio * ratio * (1.0 - cos_in * cos_in);
  if (cos2 <= 0.0) return std::nullopt;
  return ratio * event.direction_in + (ratio * cos_in - std::sqrt(cos2)) * normal;
}

/// Whether `direction` runs to the side of the mean surface that the lobe goes to.
inline bool is_on_side(const Vec3& direction, Lobe lobe) {
  return lobe == Lobe::reflection ? direction.z() > 0.0 : direction.z() < 0.0;
}

/// Unit vector of the lobe's side with direction cosines `beta` along x and y, |beta| <= 1.
inline Vec3 direction_of(const Vec2& beta, Lobe lobe) {
  const double z = std::sqrt(std::max(0.0, 1.0 - beta.squaredNorm()));
  return {beta.x(), beta.y(), lobe == Lobe::reflection ? z : -z};
}

}  // namespace retrace::surface_models
