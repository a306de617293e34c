#include "raytrace/faces/textured_facet.h"

#include <algorithm>
#include <cmath>

namespace retrace::raytrace {
namespace {

using surface_models::Lobe;

/// A ray in the frame of a facet. x is horizontal in the plane of the facet. z is the normal of the facet on the side
/// of the ray.
struct LocalEvent {
  Eigen::Matrix3d world_from_local;
  surface_models::ScatterEvent event;
  surface_models::Facet piece;
};

/// Returns the scattering event of light that meets a retro facet from inside or outside.
/// \param direction direction of the light in the facet's frame
surface_models::ScatterEvent event_of(const Optics& optics, bool inside, const Vec3& direction) {
  const double from = inside ? optics.index : optics.back_index;
  const double to = inside ? optics.back_index : optics.index;
  return {direction, from, to, optics.wavelength_nm, inside};
}

/// Returns the scattering event of a ray in the facet's frame. The surface patch that the ray meets (`piece`) is not
/// set.
/// \param normal unit normal of the facet, which points out of the part
LocalEvent event_at(const Optics& optics, const Vec3& normal, const Ray& ray) {
  LocalEvent local;
  const Vec3 z = ray.inside ? Vec3(-normal) : normal;
  // The facets of chamfered roots have a vertical normal. Their x axis is parallel to the roof edge of the prism.
  const Vec3 level = normal.cross(Vec3::UnitZ());
  const Vec3 x = level.norm() > 1e-9 ? level.normalized() : normal.cross(Vec3::UnitX()).normalized();
  local.world_from_local << x, z.cross(x), z;
  local.event = event_of(optics, ray.inside, local.world_from_local.transpose() * ray.direction);
  return local;
}

Vec3 at_incidence(double cos_incidence) {
  return {std::sqrt(std::max(0.0, 1.0 - cos_incidence * cos_incidence)), 0.0, -cos_incidence};
}

/// Adds a ray that leaves the facet.
/// \param ray ray that a plane facet would return
/// \param out direction and weight of the light that the texture scatters
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

/// Multiplies each Fresnel coefficient by a function of the mean number of diffractions of its light.
template <class Factor>
materials::FresnelCoefficients scaled(const materials::FresnelCoefficients& f,
                                      const surface_models::DiffractionMeans& means, const Factor& factor) {
  materials::FresnelCoefficients left = f;
  left.r_s *= factor(means.reflected[0]);
  left.r_p *= factor(means.reflected[1]);
  left.t_s *= factor(means.transmitted[0]);
  left.t_p *= factor(means.transmitted[1]);
  return left;
}

/// Returns the Fresnel coefficients of the light that is not diffracted.
materials::FresnelCoefficients kept(const materials::FresnelCoefficients& f,
                                    const surface_models::DiffractionMeans& means) {
  return scaled(f, means, [](double mean) { return std::exp(-0.5 * mean); });
}

/// Returns the Fresnel coefficients of the light that is diffracted at least two times.
materials::FresnelCoefficients diffracted_again(const materials::FresnelCoefficients& f,
                                                const surface_models::DiffractionMeans& means) {
  // The factor is the square root of 1 - exp(-x) (1 + x). For small x, a series avoids cancellation.
  return scaled(f, means, [](double x) {
    return std::sqrt(x < 1e-2 ? x * x * (0.5 - x * (1.0 / 3.0 - 0.125 * x)) : -std::expm1(-x) - x * std::exp(-x));
  });
}

/// Reduces the number of branches. As long as the smallest power is below `least`, the two smallest branches are
/// merged. One of them is chosen at random in proportion to its power and receives the power of both. The total power
/// is preserved. The remaining branches have at least the power `least`, or only one branch remains.
/// \return the new powers; 0 for removed branches
template <std::size_t N>
std::array<double, N> merged(std::array<double, N> power, double least, surface_models::RandomStream& random) {
  for (;;) {
    std::size_t smallest = N, next = N;
    for (std::size_t k = 0; k < N; ++k) {
      if (power[k] <= 0.0) continue;
      if (smallest == N || power[k] < power[smallest]) {
        next = smallest;
        smallest = k;
      } else if (next == N || power[k] < power[next]) {
        next = k;
      }
    }
    if (next == N || power[smallest] >= least) return power;
    const double both = power[smallest] + power[next];
    const bool take_smallest = random.next() * both < power[smallest];
    power[take_smallest ? smallest : next] = both;
    power[take_smallest ? next : smallest] = 0.0;
  }
}

surface_models::Polarisation2 coherency_of(const Stokes& stokes) {
  const std::complex<double> cross(stokes.u, stokes.v);
  surface_models::Polarisation2 made;
  made << stokes.i + stokes.q, cross, std::conj(cross), stokes.i - stokes.q;
  return 0.5 / stokes.i * made;
}

Stokes stokes_of(const surface_models::Polarisation2& coherency, double power) {
  const double s = power * coherency(0, 0).real(), p = power * coherency(1, 1).real();
  const std::complex<double> cross = 2.0 * power * coherency(0, 1);
  return {power, s - p, cross.real(), cross.imag()};
}

/// Light after it has met roughness between two dielectrics, by kind. The light diffracted one time (`once`) has no
/// direction yet.
struct RoughLight {
  enum Kind : std::size_t { reflected, transmitted, reflected_again, transmitted_again, once, kKinds };
  std::array<Light, kKinds> lights;
  std::array<double, kKinds> power{};
};

/// Splits the light that meets roughness between two dielectrics into kinds.
/// \param light light of the ray, along the s and p axes of the surface patch that it meets
RoughLight rough_light(const surface_models::HarveyShack& rough, const Light& light,
                       const materials::FresnelCoefficients& f, const LocalEvent& local) {
  const surface_models::DiffractionMeans means = surface_models::diffraction_means(rough, local.event, local.piece, f);
  const materials::FresnelCoefficients specular = kept(f, means), again = diffracted_again(f, means);
  RoughLight made;
  made.lights = {light.reflected(specular), light.transmitted(specular), light.reflected(again),
                 light.transmitted(again), light};
  double rest = light.power();
  for (std::size_t k = 0; k < RoughLight::once; ++k) rest -= made.power[k] = made.lights[k].power();
  // If the roughness has no effect, the difference is a rounding error.
  made.power[RoughLight::once] = rest > 1e-15 * light.power() ? rest : 0.0;
  return made;
}

/// Returns the rays that leave roughness between two dielectrics.
/// \param light light of the ray, along the s and p axes of the surface patch that it meets
/// \param to_reflect, to_transmit rays that a smooth surface would return
TexturedReturn meet_rough_dielectric(const surface_models::HarveyShack& rough, const Light& light,
                                     const materials::FresnelCoefficients& f, const LocalEvent& local,
                                     const Ray& to_reflect, const Ray& to_transmit, double split_power,
                                     surface_models::RandomStream& random) {
  auto [lights, power] = rough_light(rough, light, f, local);
  TexturedReturn result;
  result.truncated = light.power();
  power = merged(power, split_power, random);
  for (std::size_t k = 0; k < RoughLight::once; ++k) {
    if (power[k] <= 0.0) continue;
    lights[k].scale(power[k] / lights[k].power());
    const bool is_reflected = k == RoughLight::reflected || k == RoughLight::reflected_again;
    Ray ray = is_reflected ? to_reflect : to_transmit;
    ray.light = lights[k];
    const Lobe lobe = is_reflected ? Lobe::reflection : Lobe::transmission;
    if (k == RoughLight::reflected || k == RoughLight::transmitted) {
      const Vec3 direction = local.world_from_local.transpose() * ray.direction;
      if (!surface_models::is_on_side(direction, lobe)) continue;
      surface_models::ScatterSample out{direction, direction, 1.0, true};
      if (local.piece.is_tilted) out.weight = rough.unmasked_fraction(direction);
      add(ray, local, out, result);
    } else if (const auto out =
                   surface_models::sample_diffracted_again(rough, local.event, local.piece, lobe, random)) {
      add(ray, local, *out, result);
    }
  }
  if (power[RoughLight::once] <= 0.0) return result;
  const Vec3 s_axis = local.world_from_local.transpose() * light.s_axis;
  double unmasked = 1.0;
  const auto out = surface_models::sample_diffracted_once(rough, local.event, local.piece, s_axis,
                                                          coherency_of(light.stokes), random, unmasked);
  if (!out) return result;
  Ray ray = out->lobe == Lobe::reflection ? to_reflect : to_transmit;
  ray.direction = (local.world_from_local * out->direction).normalized();
  ray.light = {stokes_of(out->coherency, power[RoughLight::once] * unmasked), local.world_from_local * out->s_axis};
  ray.scattered = true;
  result.truncated -= ray.light.power();
  result.diffracted_once = result.count;
  result.rays[result.count++] = ray;
  return result;
}

}  // namespace

TexturedReturn meet_textured_facet(const Optics& optics, const Vec3& normal, const Ray& ray, double split_power,
                                   surface_models::RandomStream& random) {
  LocalEvent local = event_at(optics, normal, ray);
  local.piece = surface_models::sample_facet(optics.facet_scatter, local.event, random);
  const Vec3 against = local.world_from_local * local.piece.normal;
  const double cos_incidence = -against.dot(ray.direction);
  const materials::FresnelCoefficients f =
      fresnel_at_back(optics, geometry::FacetRole::retro_facet, ray.inside, cos_incidence);
  Light light = ray.light;
  light.rotate_basis_to_interface(ray.direction, against);
  Ray reflected{mirrored(ray.direction, against), light.reflected(f), ray.inside, ray.scattered};
  Ray transmitted{refracted(ray.direction, against, optics.ratio_at_back(ray.inside), cos_incidence, f.cos_refracted),
                  light.transmitted(f), !ray.inside, ray.scattered};
  if (const auto* rough = surface_models::first_order_model(optics.facet_scatter))
    return meet_rough_dielectric(*rough, light, f, local, reflected, transmitted, split_power, random);
  TexturedReturn result;
  result.absorbed = absorbed_by(optics.facet_layers, light, reflected.light, transmitted.light);
  const Branch branch = choose_branch(reflected.light, transmitted.light, split_power, [&] { return random.next(); });
  if (branch != Branch::reflected) scatter(transmitted, optics, local, Lobe::transmission, split_power, result, random);
  if (branch != Branch::transmitted) scatter(reflected, optics, local, Lobe::reflection, split_power, result, random);
  return result;
}

Ray diffracted_once_into(const Optics& optics, const Vec3& normal, const Ray& ray, const Vec3& direction) {
  const auto& rough = *surface_models::first_order_model(optics.facet_scatter);
  const LocalEvent local = event_at(optics, normal, ray);
  const Vec3 against = local.world_from_local.col(2);
  Light light = ray.light;
  light.rotate_basis_to_interface(ray.direction, against);
  const Vec3 s_axis = local.world_from_local.transpose() * light.s_axis;
  const Vec3 leaving = local.world_from_local.transpose() * direction;
  const surface_models::DiffractedOnce into =
      rough.diffracted_once_into(local.event, local.piece, s_axis, coherency_of(light.stokes), leaving);
  const double density = into.coherency.trace().real();
  Ray made{direction, {{}, local.world_from_local * into.s_axis}, (into.lobe == Lobe::reflection) == ray.inside, true};
  if (!(density > 0.0)) return made;
  const materials::FresnelCoefficients f =
      fresnel_at_back(optics, geometry::FacetRole::retro_facet, ray.inside, -against.dot(ray.direction));
  const double power = rough_light(rough, light, f, local).power[RoughLight::once];
  made.light.stokes = stokes_of(into.coherency / density, power * density * std::abs(leaving.z()));
  return made;
}

void TexturedReturn::mirror_to_side(const Vec3& plane_normal) {
  for (std::size_t k = 0; k < count; ++k) {
    Ray& ray = rays[k];
    const double out = plane_normal.dot(ray.direction);
    if (ray.inside == (out < 0.0)) continue;
    const Vec3 direction = mirrored(ray.direction, plane_normal);
    ray.light.s_axis = Eigen::Quaterniond::FromTwoVectors(ray.direction, direction) * ray.light.s_axis;
    ray.direction = direction;
  }
}

double mean_field_fraction(const Optics& optics, bool inside, double cos_incidence, Lobe lobe) {
  if (surface_models::first_order_model(optics.facet_scatter) != nullptr) return 1.0;
  return surface_models::mean_field_fraction(optics.facet_scatter,
                                             event_of(optics, inside, at_incidence(cos_incidence)), lobe);
}

materials::FresnelCoefficients mean_field(const Optics& optics, bool inside, double cos_incidence,
                                          const materials::FresnelCoefficients& fresnel) {
  const auto* rough = surface_models::first_order_model(optics.facet_scatter);
  if (rough == nullptr) return fresnel;
  const surface_models::ScatterEvent event = event_of(optics, inside, at_incidence(cos_incidence));
  return kept(fresnel, surface_models::diffraction_means(*rough, event, {}, fresnel));
}

surface_models::PhaseTexture phase_texture(const Optics& optics, bool inside, double cos_incidence, Lobe lobe) {
  const surface_models::ScatterEvent event = event_of(optics, inside, at_incidence(cos_incidence));
  return surface_models::phase_texture(optics.facet_scatter, event, lobe);
}

}  // namespace retrace::raytrace
