#pragma once

// Single light paths as polylines with the events on them, for pictures that explain a part.

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "geometry/part/part.h"
#include "raytrace/faces/surface_ray.h"
#include "raytrace/light/optics.h"

namespace retrace::raytrace {

/// What happens to light at an interface.
enum class PathEvent {
  enters,            ///< through the entrance face, from outside
  total_reflection,  ///< at a facet, a wall, a side or the entrance face
  reflection,        ///< the same, but not total: by Fresnel, a film or a mirror
  leaves,            ///< through the entrance face: the path ends
  exits,             ///< through a facet or wall into the air behind the part
  enters_again,      ///< through a facet, from behind
  leaves_side,       ///< through a side of the plate: the path ends
  escapes,           ///< from behind the part: the path ends
  ends               ///< absorbed, or followed no further
};

struct PathStep {
  PathEvent event = PathEvent::ends;
  geometry::FacetRole role = geometry::FacetRole::entrance;  ///< of the face
  Vec3 at_mm = Vec3::Zero();                                 ///< part frame
  double incidence_deg = 0.0;                                ///< on the face
  double power = 0.0;                                        ///< that goes on, over the incident power
  std::optional<FacetRef> facet = {};                        ///< of the back
};

/// One way of light through a part, from before it enters to after it leaves.
struct LightPath {
  std::vector<Vec3> points_mm;  ///< corners, with a piece of air before and behind; part frame
  std::vector<PathStep> steps;
  double power = 0.0;          ///< that arrives at its end
  double deviation_deg = 0.0;  ///< of where it leaves the entrance face from the way back to the source
  bool is_returned = false;    ///< it leaves through the entrance face, within `cone_deg`
};

/// Function that returns the first facet that a ray meets, or nothing.
using HitFinder = std::function<std::optional<SurfaceHit>(const SurfaceRay& ray)>;

/// Follows the stronger branch at every interface, from a point of the entrance face. The resulting path is a drawing
/// aid and does not give the distribution of power.
/// \param first_hit finds facets of the part, in coordinates with the origin `centre_mm`
/// \param cone_deg half angle of the acceptance cone
/// \pre the part is finite and its facets are smooth
LightPath strongest_path(const geometry::Part& part, const HitFinder& first_hit, const Vec2& centre_mm,
                         const Optics& optics, const Illumination& illumination, double cone_deg, const Vec2& entry_mm);

}  // namespace retrace::raytrace
