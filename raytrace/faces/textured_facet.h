#pragma once

// Interaction of rays with rough facets. The reflected and the transmitted light are both split into specular and
// scattered light.

#include <array>
#include <cstddef>
#include <optional>

#include "raytrace/light/light_setup.h"
#include "surface_models/scatter/random_stream.h"

namespace retrace::raytrace {

/// Light that travels in one direction.
struct Ray {
  Vec3 direction = Vec3::UnitZ();
  Light light;
  bool inside = true;      ///< true if the ray is in the material of the part
  bool scattered = false;  ///< true if there was a non-specular event on the path of the ray
};

/// Branch or branches of light that are traced further at an interface.
enum class Branch { reflected, transmitted, both };

/// Chooses the branches at an interface. If both branches have at least the power `split_power`, both are traced.
/// Otherwise, one branch is chosen at random in proportion to its power and receives the power of both. The expected
/// power of each branch is preserved.
/// \param uniform returns a random number in [0, 1); it is called only if a random choice is needed
template <class Uniform>
Branch choose_branch(Light& reflected, Light& transmitted, double split_power, const Uniform& uniform) {
  const double r = reflected.power();
  const double t = transmitted.power();
  if (t <= 0.0) return Branch::reflected;
  if (r <= 0.0) return Branch::transmitted;
  if (std::min(r, t) >= split_power) return Branch::both;
  const bool take_reflected = uniform() * (r + t) < r;
  (take_reflected ? reflected : transmitted).scale((r + t) / (take_reflected ? r : t));
  return take_reflected ? Branch::reflected : Branch::transmitted;
}

/// Rays that leave a textured facet.
struct TexturedReturn {
  std::array<Ray, 5> rays;  ///< only the first `count` elements are valid
  std::size_t count = 0;
  /// Index in `rays` of the light that was diffracted exactly one time by roughness between two dielectrics.
  std::optional<std::size_t> diffracted_once;
  /// Incident power minus the power of `rays` and `absorbed`: the error of the texture model. May be negative.
  double truncated = 0.0;
  double absorbed = 0.0;  ///< power that the layers on the facet absorb

  /// Finds directions that point to the wrong side of the facet's plane, and mirrors them at this plane. The form of a
  /// facet causes such directions for light at grazing incidence.
  /// \param plane_normal unit normal of the plane, which points out of the part
  void mirror_to_side(const Vec3& plane_normal);
};

/// Returns the rays that leave a random patch of the facet's texture. The reflected and the transmitted light are
/// scattered by Optics::facet_scatter. Specular and scattered light are both traced if each has at least `split_power`.
///
/// Roughness between two dielectrics causes up to five kinds of light. In each branch, there is specular light and
/// light that is diffracted more than one time. The fifth kind is light that is diffracted one time, to either side.
/// \param normal unit normal of the facet, which points out of the part
TexturedReturn meet_textured_facet(const Optics& optics, const Vec3& normal, const Ray& ray, double split_power,
                                   surface_models::RandomStream& random);

/// Returns the light that the facet diffracts one time into a direction. Its power is per steradian.
/// \param direction unit vector
/// \pre surface_models::first_order_model(optics.facet_scatter) exists and has no waviness, and the ray has power
Ray diffracted_once_into(const Optics& optics, const Vec3& normal, const Ray& ray, const Vec3& direction);

/// Returns the fraction of a lobe's power that remains in the mean field at a textured retro facet. It returns 1 if s
/// and p polarization have different fractions, because mean_field() then contains the effect of the texture.
double mean_field_fraction(const Optics& optics, bool inside, double cos_incidence, surface_models::Lobe lobe);

/// Returns the Fresnel coefficients of a retro facet for the mean field. The coefficients `fresnel` are reduced, for
/// each polarization, by the light that roughness between two dielectrics scatters.
materials::FresnelCoefficients mean_field(const Optics& optics, bool inside, double cos_incidence,
                                          const materials::FresnelCoefficients& fresnel);

/// Returns the statistics of the phase that the texture of a retro facet adds to the light of a lobe.
/// \pre surface_models::has_phases()
surface_models::PhaseTexture phase_texture(const Optics& optics, bool inside, double cos_incidence,
                                           surface_models::Lobe lobe);

}  // namespace retrace::raytrace
