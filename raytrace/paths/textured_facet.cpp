#include "raytrace/paths/textured_facet.h"

#include <algorithm>
#include <cmath>

namespace retrace::raytrace {
namespace {

using surface_models::Lobe;

/// A ray in the frame of a facet: x along it and level, z against the light.
struct LocalEvent {
  Eigen::Matrix3d world_from_local;
  surface_models::ScatterEvent event;
  surface_models::Facet piece;
};

/// Light that meets a retro facet from inside or outside, in the facet's frame.
surface_models::ScatterEvent event_of(const Optics& optics, bool inside, const Vec3& direction) {
  const double from = inside ? optics.index : optics.back_index;
  const double to = inside ? optics.back_index : optics.index;
  return {direction, from, to, optics.wavelength_nm, inside};
}

/// In the plane y = 0 of a facet's frame.
Vec3 direction_at(double cos_incidence) {
  return {std::sqrt(std::max(0.0, 1.0 - cos_incidence * cos_incidence)), 0.0, -cos_incidence};
}

LocalEvent local_event(const Optics& optics, const Vec3& normal, const Ray& ray, surface_models::RandomStream& random) {
  LocalEvent local;
  const Vec3 z = ray.inside ? Vec3(-normal) : normal;
  // Chamfered roots are level all round: there the roof edge of a prism is the axis.
  const Vec3 level = normal.cross(Vec3::UnitZ());
  const Vec3 x = level.norm() > 1e-9 ? level.normalized() : normal.cross(Vec3::UnitX()).normalized();
  local.world_from_local << x, z.cross(x), z;
  local.event = event_of(optics, ray.inside, local.world_from_local.transpose() * ray.direction);
  local.piece = surface_models::sample_facet(optics.facet_scatter, local.event, random);
  return local;
}

/// Adds a ray that has left the facet as from a plane one, turned as the texture scatters it.
void add(Ray ray, const LocalEvent& local, const surface_models::ScatterSample& out, TexturedReturn& result) {
  ray.light.scale(out.weight);
  result.truncated -= ray.light.power();
  if (!out.is_specular) {
    const Vec3 direction = (local.world_from_local * out.direction).normalized();
    ray.light.s_axis = Eigen::Quaterniond::FromTwoVectors(ray.direction, direction) * ray.light.s_axis;
    ray.direction = direction;
  }
  ray.scattered = ray.scattered || !out.is_specular || local.piece.is_tilted;
  result.rays[result.count++] = ray;
}

void scatter(const Ray& ray, const Optics& optics, const LocalEvent& local, Lobe lobe, double split_power,
             TexturedReturn& result, surface_models::RandomStream& random) {
  const double power = ray.light.power();
  result.truncated += power;
  if (power > 0.0)
    if (const auto both = surface_models::sample_split(optics.facet_scatter, local.event, local.piece, lobe,
                                                       split_power / power, random)) {
      if (both->specular) add(ray, local, *both->specular, result);
      if (both->scattered) add(ray, local, *both->scattered, result);
      return;
    }
  if (const auto out = surface_models::sample(optics.facet_scatter, local.event, local.piece, lobe, random))
    add(ray, local, *out, result);
}

}  // namespace

TexturedReturn meet_textured_facet(const Optics& optics, const Vec3& normal, const Ray& ray, double split_power,
                                   surface_models::RandomStream& random) {
  const LocalEvent local = local_event(optics, normal, ray, random);
  const Vec3 against = local.world_from_local * local.piece.normal;
  const double cos_incidence = -against.dot(ray.direction);
  const materials::FresnelCoefficients f =
      fresnel_at_back(optics, geometry::FacetRole::retro_facet, ray.inside, cos_incidence);
  Light light = ray.light;
  light.turn_to(ray.direction, against);
  Ray reflected{mirrored(ray.direction, against), light.reflected(f), ray.inside, ray.scattered};
  Ray transmitted{refracted(ray.direction, against, optics.ratio_at_back(ray.inside), cos_incidence, f.cos_refracted),
                  light.transmitted(f), !ray.inside, ray.scattered};
  TexturedReturn result;
  if (optics.coating_index) result.absorbed = light.power() - reflected.light.power();
  const Branch branch = choose_branch(reflected.light, transmitted.light, split_power, [&] { return random.next(); });
  if (branch != Branch::reflected) scatter(transmitted, optics, local, Lobe::transmission, split_power, result, random);
  if (branch != Branch::transmitted) scatter(reflected, optics, local, Lobe::reflection, split_power, result, random);
  return result;
}

double mean_field_share(const Optics& optics, bool inside, double cos_incidence, Lobe lobe) {
  const surface_models::ScatterEvent event = event_of(optics, inside, direction_at(cos_incidence));
  return surface_models::mean_field_share(optics.facet_scatter, event, lobe);
}

surface_models::PhaseTexture phase_texture(const Optics& optics, bool inside, double cos_incidence, Lobe lobe) {
  const surface_models::ScatterEvent event = event_of(optics, inside, direction_at(cos_incidence));
  return surface_models::phase_texture(optics.facet_scatter, event, lobe);
}

}  // namespace retrace::raytrace
