#include "raytrace/light/light_setup.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "geometry/direction.h"

namespace retrace::raytrace {

using materials::StackSide;

/// Returns the direction after refraction at a plane. The unit normal `facing_normal` faces the ray.
Vec3 refracted(const Vec3& direction, const Vec3& facing_normal, double ratio, double cos_incidence,
               double cos_refracted) {
  return (ratio * direction + (ratio * cos_incidence - cos_refracted) * facing_normal).normalized();
}

Vec3 mirrored(const Vec3& direction, const Vec3& normal) {
  return (direction - 2.0 * normal.dot(direction) * normal).normalized();
}

namespace {

materials::FresnelCoefficients perfect_mirror() {
  materials::FresnelCoefficients f;
  f.r_s = -1.0;
  f.r_p = 1.0;
  f.total_reflection = true;
  return f;
}

}  // namespace

materials::FresnelCoefficients fresnel_at_back(const Optics& optics, geometry::FacetRole role, bool inside,
                                               double cos_incidence) {
  const bool is_retro = role == geometry::FacetRole::retro_facet;
  if (is_retro && optics.mirror_facets) return perfect_mirror();
  if (!is_retro || optics.facet_layers.empty())
    return materials::fresnel(ratio_at_face(optics, role, inside), cos_incidence);
  if (inside)
    return materials::fresnel_layers(optics.facet_layers, StackSide::body, optics.index, optics.back_index,
                                     cos_incidence);
  return materials::fresnel_layers(optics.facet_layers, StackSide::outside, optics.back_index, optics.index,
                                   cos_incidence);
}

namespace {

/// Returns the coefficients of the entrance face with its thin layers, but without films.
materials::FresnelCoefficients fresnel_of_face(const Optics& optics, bool inside, double cos_incidence) {
  if (inside)
    return materials::fresnel_layers(optics.entrance_layers, StackSide::body, optics.index, 1.0, cos_incidence);
  return materials::fresnel_layers(optics.entrance_layers, StackSide::outside, 1.0, optics.index, cos_incidence);
}

materials::FresnelCoefficients fresnel_behind(const Optics& optics, std::span<const materials::ThickLayer> layers,
                                              double outside_index, bool inside, double cos_incidence) {
  return inside ? materials::fresnel_thick_layers(optics.entrance_layers, layers, StackSide::body, optics.index,
                                                  outside_index, cos_incidence)
                : materials::fresnel_thick_layers(optics.entrance_layers, layers, StackSide::outside, outside_index,
                                                  optics.index, cos_incidence);
}

}  // namespace

materials::FresnelCoefficients fresnel_at_entrance(const Optics& optics, bool inside, double cos_incidence) {
  const EntranceCondition& face = optics.entrance;
  if (face.layers.empty()) return fresnel_of_face(optics, inside, cos_incidence);
  const auto met = [&](std::span<const materials::ThickLayer> layers) {
    return fresnel_behind(optics, layers, 1.0, inside, cos_incidence);
  };
  if (face.film_coverage <= 0.0 || face.film_coverage >= 1.0) return met(face.layers);
  return materials::mixed(met(face.layers_under_film()), met(face.layers), face.film_coverage);
}

materials::FresnelCoefficients fresnel_under_drop(const Optics& optics, bool inside, double cos_incidence) {
  return fresnel_behind(optics, optics.entrance.layers_under_film(), optics.entrance.water_index, inside,
                        cos_incidence);
}

materials::FresnelCoefficients fresnel_at_mirror(const Optics& optics, double from_index, double cos_incidence) {
  if (optics.mirror_facets) return perfect_mirror();
  return materials::fresnel_layers(optics.facet_layers, StackSide::body, from_index, optics.back_index, cos_incidence);
}

double absorbed_at_back(const Optics& optics, geometry::FacetRole role, const Light& met, const Light& reflected,
                        const Light& transmitted) {
  return role == geometry::FacetRole::retro_facet ? absorbed_by(optics.facet_layers, met, reflected, transmitted) : 0.0;
}

Vec3 source_axis(const Vec3& direction) {
  return direction.cross(Vec3::UnitX()).cross(direction).normalized();
}

Light light_of_beam(const Stokes& stokes, const Vec3& to_source) {
  Light light{stokes, source_axis(to_source)};
  light.stokes.u = -stokes.u;  // the p axis, direction x s, is opposite to the second axis of the source
  return light;
}

Stokes in_source_axes(Light light, const Vec3& direction) {
  light.rotate_basis_to_axis(direction, source_axis(direction));
  return light.stokes;
}

Account account_of_exit(geometry::FacetRole role) {
  const bool is_side = role == geometry::FacetRole::side || role == geometry::FacetRole::border_wall;
  return is_side ? Account::side_exit : Account::transmitted;
}

void Tally::add(const Tally& more) {
  for (std::size_t k = 0; k < returned.size(); ++k) returned[k] += more.returned[k];
  for (std::size_t k = 0; k < scattered.size(); ++k) scattered[k] += more.scattered[k];
  for (std::size_t k = 0; k < entrance_reflected.size(); ++k) entrance_reflected[k] += more.entrance_reflected[k];
  for (std::size_t k = 0; k < score.size(); ++k) score[k] += more.score[k];
  for (std::size_t k = 0; k < kAccountCount; ++k) other.power[k] += more.other.power[k];
  segments += more.segments;
  misses += more.misses;
}

void Tally::add(const ShellLosses& losses, Account missed, double factor) {
  other[Account::shell_reflected] += factor * losses.reflected;
  other[Account::absorbed] += factor * losses.absorbed;
  other[missed] += factor * losses.missed;
}

void Tally::clear() {
  for (std::vector<Stokes>* const sums : {&returned, &scattered, &entrance_reflected})
    std::fill(sums->begin(), sums->end(), Stokes{});
  std::fill(score.begin(), score.end(), 0.0);
  other = {};
  segments = misses = 0;
}

Ledger Tally::ledger(std::size_t cone) const {
  Ledger ledger = other;
  for (std::size_t k = 0; k < returned.size(); ++k) {
    ledger[k <= cone ? Account::retroreflected : Account::returned_elsewhere] += returned[k].i;
    ledger[k <= cone ? Account::retroreflected : Account::scattered_out] += scattered[k].i;
    ledger[k <= cone ? Account::retroreflected : Account::front_specular] += entrance_reflected[k].i;
  }
  return ledger;
}

Stokes Tally::retroreflected(std::size_t cone) const {
  Stokes sum;
  for (std::size_t k = 0; k <= cone; ++k) {
    sum += returned[k];
    sum += scattered[k];
    sum += entrance_reflected[k];
  }
  return sum;
}

Vec3 direction_to_source(const Illumination& illumination) {
  return geometry::direction_at(illumination.incidence, illumination.azimuth);
}

LightSetup::LightSetup(const geometry::Part& part, const Vec2& centre_mm, const Optics& how,
                       const Illumination& illumination, const std::vector<double>& cones_deg)
    : optics(how),
      thickness_mm(part.thickness_mm),
      depth_mm(part.element_depth_mm),
      top_mm(part.top_mm),
      stops(part, centre_mm) {
  to_source = direction_to_source(illumination);
  CoherentLight arriving;
  static_cast<Light&>(arriving) = light_of_beam(illumination.stokes, to_source);
  arriving.jones(1, 1) = -1.0;  // see light_of_beam()
  if (!deflect(optics.shells)) arrival_losses = pass_plates(optics.shells, ShellPassage::to_part, -to_source, arriving);
  incident = arriving;
  for (const double half_angle_deg : cones_deg) {
    const double chord = 2.0 * std::sin(0.5 * Angle::from_deg(half_angle_deg).rad());
    cone_chord2.push_back(chord * chord * (1.0 + 1e-9));  // directions on the edge belong to the cone despite rounding
  }
  for (std::size_t k = 0; k < part.outline.size(); ++k) {
    const Vec2 a = part.outline[k] - centre_mm;
    const Vec2 along = (part.outline[(k + 1) % part.outline.size()] - part.outline[k]).normalized();
    const Vec3 normal(along.y(), -along.x(), 0.0);
    sides.push_back({normal, normal.head<2>().dot(a)});
  }
  entry = enter(arriving);
}

std::size_t LightSetup::cone_of(const Vec3& direction, const Vec3& back) const {
  const double chord2 = (direction - back).squaredNorm();
  std::size_t k = 0;
  while (k < cone_chord2.size() && chord2 > cone_chord2[k]) ++k;
  return k;
}

/// Returns the light that enters through the entrance face and the light that the face reflects.
/// \param arriving incident light directly in front of the face
LightSetup::Entry LightSetup::enter(const CoherentLight& arriving) const {
  const Vec3 down = -to_source;
  const double ratio = 1.0 / optics.index;
  const materials::FresnelCoefficients f = fresnel_at_entrance(optics, false, to_source.z());
  CoherentLight light = arriving;
  light.rotate_basis_to_interface(down, Vec3::UnitZ());
  Entry entered;
  entered.direction = refracted(down, Vec3::UnitZ(), ratio, to_source.z(), f.cos_refracted);
  entered.reflected_direction = mirrored(down, Vec3::UnitZ());
  entered.reflected_cone = cone_of(entered.reflected_direction);
  entered.light = light;
  if (optics.lossless_entrance) return entered;
  const CoherentLight reflected = light.reflected(f);
  CoherentLight seen = reflected;
  if (!deflect(optics.shells)) entered.reflected_losses = pass_shells_outward(seen, entered.reflected_direction);
  seen.rotate_basis_to_axis(entered.reflected_direction, source_axis(entered.reflected_direction));
  entered.reflected = seen.stokes;
  entered.reflected_jones = seen.jones;
  entered.light = light.transmitted(f);
  entered.absorbed = absorbed_at_entrance(optics, light, reflected, entered.light);
  return entered;
}

}  // namespace retrace::raytrace
