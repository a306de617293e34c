#pragma once

// Rays at rough facets: Fresnel's branches, each split into specular and scattered light.

#include <array>
#include <cstddef>
#include <optional>

#include "raytrace/light/light_setup.h"
#include "surface_models/scatter/random_stream.h"

namespace retrace::raytrace {

/// Light on its way in one direction.
struct Ray {
  Vec3 direction = Vec3::UnitZ();
  Light light;
  bool inside = true;      ///< in the part's material
  bool scattered = false;  ///< a non-specular event lies behind it
};

/// The branches that are followed.
enum class Branch { reflected, transmitted, both };

/// Both branches of light at an interface while each has at least `split_power`, else one by its share of the power,
/// which it gets whole: nothing is lost or made. \param uniform gives a number in [0, 1), called if there is a
/// choice
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

/// What a textured facet makes of a ray.
struct TexturedReturn {
  std::array<Ray, 5> rays;  ///< the first `count` of them
  std::size_t count = 0;
  /// Index in `rays` of the light that roughness between dielectrics has diffracted exactly one time.
  std::optional<std::size_t> once;
  /// Power by which the texture model falls short of the incident power; may be negative.
  double truncated = 0.0;
  double absorbed = 0.0;  ///< power absorbed in layers

  /// Mirrors at the facet's plane the directions that its form has turned to the wrong side of it: light that grazes
  /// the facet. \param plane_normal unit, out of the part
  void keep_sides(const Vec3& plane_normal);
};

/// Fresnel's branches at a piece of the texture, each scattered by Optics::facet_scatter. What stays specular and what
/// does not are followed both while each has at least `split_power`, as the branches are. Roughness between dielectrics
/// makes up to five kinds of light: specular and diffracted more than once in each branch, and diffracted once, to
/// either side. \param normal of the facet, unit, out of the part
TexturedReturn meet_textured_facet(const Optics& optics, const Vec3& normal, const Ray& ray, double split_power,
                                   surface_models::RandomStream& random);

/// Returns the light that the facet diffracts one time into a given direction, with its power per steradian.
/// \param direction unit vector
/// \pre surface_models::first_order_model(optics.facet_scatter) without waviness, and the ray has power
Ray diffracted_once_into(const Optics& optics, const Vec3& normal, const Ray& ray, const Vec3& direction);

/// Share of a lobe's power that the texture of a retro facet leaves in its mean field, where s and p keep the same; 1
/// where mean_field() tells them apart.
double mean_field_share(const Optics& optics, bool inside, double cos_incidence, surface_models::Lobe lobe);

/// Fresnel's amplitudes `fresnel` of a retro facet, less what roughness between dielectrics takes of each polarisation.
materials::FresnelCoefficients mean_field(const Optics& optics, bool inside, double cos_incidence,
                                          const materials::FresnelCoefficients& fresnel);

/// What the texture of a retro facet does to the phase of a lobe's light. \pre surface_models::has_phases()
surface_models::PhaseTexture phase_texture(const Optics& optics, bool inside, double cos_incidence,
                                           surface_models::Lobe lobe);

}  // namespace retrace::raytrace
