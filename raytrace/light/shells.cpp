#include "raytrace/light/shells.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "raytrace/light/coherent_light.h"
#include "raytrace/light/light_setup.h"

namespace retrace::raytrace {
namespace {

// Maximum distance by which a ray may start beyond the surface that it meets next, because of rounding errors. It is a
// fraction of the distance between the start of the ray and the vertex of the surface.
constexpr double kRounding = 1e-9;

/// Point at which a ray crosses a surface.
struct Crossing {
  double t_mm = 0.0;
  Vec3 normal = Vec3::UnitZ();  ///< unit normal on the side of the source
};

/// Returns the point at which a line crosses a surface in the direction of `passage` (towards the part or away from
/// it). Crossing::t_mm may be negative.
///
/// The points p of the surface, relative to its vertex, satisfy 2 p.N + c p.p = 0, with the normal N at the vertex and
/// the curvature c. The unit normal at p is N + c p. The root is written in a form that remains accurate for c = 0 (G.
/// H. Spencer, M. V. R. K. Murty, J. Opt. Soc. Am. 52 (1962), 672).
std::optional<Crossing> crossing_of(const ShellSurface& surface, const Vec3& position, const Vec3& direction,
                                    ShellPassage passage) {
  const Vec3 from = position - surface.vertex_mm;
  const double c = surface.curvature_per_mm;
  const double half_slope = direction.dot(surface.normal + c * from);
  const double offset = 2.0 * from.dot(surface.normal) + c * from.squaredNorm();
  const double discriminant = half_slope * half_slope - c * offset;
  if (!(discriminant > 0.0)) return std::nullopt;
  // The cosine between the ray and the normal at the crossing is +-root.
  const double root = std::sqrt(discriminant);
  const double divisor = passage == ShellPassage::to_part ? root - half_slope : -root - half_slope;
  if (divisor == 0.0) return std::nullopt;
  const double t = offset / divisor;
  const Vec3 normal = surface.normal + c * (from + t * direction);
  // Only the hemisphere around the vertex belongs to the surface.
  if (!std::isfinite(t) || !(normal.dot(surface.normal) > 0.0)) return std::nullopt;
  return Crossing{t, normal.normalized()};
}

/// Refracts light at a surface. Returns the direction behind the surface, or nothing if the light is totally reflected.
/// \param facing_normal unit normal that faces the light
/// \param ratio refractive index before the surface divided by the index behind it
template <class AnyLight>
std::optional<Vec3> refract(const Vec3& direction, const Vec3& facing_normal, double ratio, AnyLight& light,
                            ShellLosses& losses) {
  if (ratio == 1.0) return direction;
  const double before = light.power();
  const double cos_incidence = -facing_normal.dot(direction);
  const materials::FresnelCoefficients f = materials::fresnel(ratio, cos_incidence);
  if (f.total_reflection) {
    losses.reflected += before;
    light.scale(0.0);
    return std::nullopt;
  }
  light.rotate_basis_to_interface(direction, facing_normal);
  light = light.transmitted(f);
  losses.reflected += before - light.power();
  return refracted(direction, facing_normal, ratio, cos_incidence, f.cos_refracted);
}

/// Reduces light by absorption along a path in a shell.
template <class AnyLight>
void absorb(const Shell& shell, double length_mm, AnyLight& light, ShellLosses& losses) {
  const double kept = std::exp(-shell.absorption_per_mm * length_mm);
  losses.absorbed += light.power() * (1.0 - kept);
  light.scale(kept);
}

template <class AnyLight>
void miss(AnyLight& light, ShellLosses& losses) {
  losses.missed += light.power();
  light.scale(0.0);
}

template <class AnyLight>
void pass_plate(const Shell& shell, ShellPassage passage, const Vec3& direction, AnyLight& light, ShellLosses& losses) {
  const Vec3 facing = passage == ShellPassage::to_part ? shell.outer.normal : Vec3(-shell.outer.normal);
  if (!(facing.dot(direction) < 0.0)) return miss(light, losses);
  const std::optional<Vec3> inside = refract(direction, facing, 1.0 / shell.index, light, losses);
  if (!inside) return;
  absorb(shell, shell.thickness_mm / -facing.dot(*inside), light, losses);
  refract(*inside, facing, shell.index, light, losses);
}

/// Calls pass(shell) for each shell in the order in which light crosses the shells. Stops and returns false if a call
/// returns false.
template <class Pass>
bool in_order(const Shells& shells, ShellPassage passage, const Pass& pass) {
  return passage == ShellPassage::to_part ? std::all_of(shells.begin(), shells.end(), pass)
                                          : std::all_of(shells.rbegin(), shells.rend(), pass);
}

/// Traces a ray to a surface and refracts it there. Returns true if light passes the surface.
/// \param is_first true for the surface that light from the source meets first. If a ray starts behind this surface, it
///     is moved back to the surface.
/// \param ratio refractive index before the surface divided by the index behind it
/// \param within shell in which the ray travels to the surface, or null in air
bool cross(const ShellSurface& surface, ShellPassage passage, bool is_first, double ratio, const Shell* within,
           ShellRay& ray, ShellLosses& losses) {
  const std::optional<Crossing> crossing = crossing_of(surface, ray.position_mm, ray.direction, passage);
  const double tolerance_mm = kRounding * (ray.position_mm - surface.vertex_mm).norm();
  if (!crossing || (!is_first && crossing->t_mm < -tolerance_mm)) {
    miss(ray.light, losses);
    return false;
  }
  ray.position_mm += crossing->t_mm * ray.direction;
  if (within != nullptr) absorb(*within, std::max(0.0, crossing->t_mm), ray.light, losses);
  const Vec3 facing = passage == ShellPassage::to_part ? crossing->normal : Vec3(-crossing->normal);
  const std::optional<Vec3> behind = refract(ray.direction, facing, ratio, ray.light, losses);
  if (behind) ray.direction = *behind;
  return behind.has_value();
}

}  // namespace

bool deflect(const Shells& shells) {
  return std::any_of(shells.begin(), shells.end(), [](const Shell& shell) { return !shell.is_plane_parallel(); });
}

bool affect_light(const Shells& shells) {
  return std::any_of(shells.begin(), shells.end(),
                     [](const Shell& shell) { return shell.index != 1.0 || shell.absorption_per_mm > 0.0; });
}

template <class AnyLight>
ShellLosses pass_plates(const Shells& shells, ShellPassage passage, const Vec3& direction, AnyLight& light) {
  ShellLosses losses;
  in_order(shells, passage, [&](const Shell& shell) {
    pass_plate(shell, passage, direction, light, losses);
    return true;
  });
  return losses;
}

template ShellLosses pass_plates(const Shells&, ShellPassage, const Vec3&, Light&);
template ShellLosses pass_plates(const Shells&, ShellPassage, const Vec3&, CoherentLight&);

bool pass_shells(const Shells& shells, ShellPassage passage, ShellRay& ray, ShellLosses& losses) {
  const bool inward = passage == ShellPassage::to_part;
  return in_order(shells, passage, [&](const Shell& shell) {
    const bool is_first = inward && &shell == &shells.front();
    return cross(inward ? shell.outer : shell.inner, passage, is_first, 1.0 / shell.index, nullptr, ray, losses) &&
           cross(inward ? shell.inner : shell.outer, passage, false, shell.index, &shell, ray, losses);
  });
}

bool is_in_front(const ShellSurface& surface, const Vec3& position_mm) {
  const Vec3 from = position_mm - surface.vertex_mm;
  const double c = surface.curvature_per_mm;
  const double height = from.dot(surface.normal);
  if (1.0 + c * height <= 0.0) return c < 0.0;  // the position is beyond the centre of the sphere
  return 2.0 * height + c * from.squaredNorm() > 0.0;
}

bool meets(const ShellSurface& surface, const Vec3& position_mm, const Vec3& direction) {
  const std::optional<Crossing> crossing = crossing_of(surface, position_mm, direction, ShellPassage::to_part);
  return crossing && crossing->t_mm >= 0.0;
}

double height_mm(const ShellSurface& surface, const Vec2& point_mm) {
  const std::optional<Crossing> crossing =
      crossing_of(surface, Vec3(point_mm.x(), point_mm.y(), 0.0), -Vec3::UnitZ(), ShellPassage::to_part);
  return crossing ? -crossing->t_mm : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace retrace::raytrace
