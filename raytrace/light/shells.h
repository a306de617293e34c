#pragma once

// Shells: separate lenses in the air in front of a part, such as the outer lens of a lamp. Light crosses them on its
// way to the part and again on its way back (docs/theory/shells.md).

#include <vector>

#include "geometry/vec.h"
#include "raytrace/light/light.h"

namespace retrace::raytrace {

// Positions on shells are relative to the middle of the part: the centre of the outline's bounding box in x and y, and
// the height of the entrance surface at this point in z.

/// Surface of a shell: a plane or a sphere.
struct ShellSurface {
  Vec3 vertex_mm = Vec3::Zero();
  Vec3 normal = Vec3::UnitZ();    ///< unit normal at the vertex; it points to the side of the source
  double curvature_per_mm = 0.0;  ///< 1 / radius; 0 for a plane, above 0 if the surface is convex towards the source
};

/// A shell at one wavelength.
struct Shell {
  ShellSurface outer;  ///< surface on the side of the source
  ShellSurface inner;
  double thickness_mm = 0.0;  ///< distance between the vertices
  double index = 1.0;         ///< refractive index relative to the air around the shell
  double absorption_per_mm = 0.0;

  /// Returns true if both surfaces are planes with the same normal. Light then keeps its direction.
  bool is_plane_parallel() const {
    return outer.curvature_per_mm == 0.0 && inner.curvature_per_mm == 0.0 && outer.normal == inner.normal;
  }
};

/// Shells of a part, in the order from the source to the part.
using Shells = std::vector<Shell>;

/// Returns true if at least one shell changes the direction of light.
bool deflect(const Shells& shells);

/// Returns true if at least one shell reflects, refracts or absorbs light.
bool affect_light(const Shells& shells);

/// Direction in which light crosses the shells.
enum class ShellPassage { to_part, from_part };

/// Power that light loses on its way through shells.
struct ShellLosses {
  double reflected = 0.0;  ///< reflected at surfaces of shells, including total reflection; this light is not followed
  double absorbed = 0.0;   ///< absorbed by the material of shells
  double missed = 0.0;     ///< light that misses a surface of a shell; it is not followed
};

/// Reduces `light` by the losses in plane-parallel shells. Returns these losses.
/// \param light light of any class with Stokes parameters: Light or CoherentLight
/// \param direction direction of the light in air
/// \pre !deflect(shells)
template <class AnyLight>
ShellLosses pass_plates(const Shells& shells, ShellPassage passage, const Vec3& direction, AnyLight& light);

/// A ray in the air, with a position relative to the middle of the part.
struct ShellRay {
  Vec3 position_mm = Vec3::Zero();
  Vec3 direction = -Vec3::UnitZ();
  Light light;
};

/// Traces a ray through all shells. If the ray passes all of them, its position is on the last surface afterwards. If
/// it is totally reflected or misses a surface, all its power is added to the losses.
/// \return true if the ray passes all shells
bool pass_shells(const Shells& shells, ShellPassage passage, ShellRay& ray, ShellLosses& losses);

/// Returns true if a position is on the source side of a surface.
bool is_in_front(const ShellSurface& surface, const Vec3& position_mm);

/// Returns true if a ray meets a surface from the source side.
bool meets(const ShellSurface& surface, const Vec3& position_mm, const Vec3& direction);

/// Returns the height of a surface at a point in plan, or NaN if the surface does not extend to this point.
double height_mm(const ShellSurface& surface, const Vec2& point_mm);

}  // namespace retrace::raytrace
