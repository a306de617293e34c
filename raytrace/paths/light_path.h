#pragma once

// Single light paths as polylines, with the events along the path. They are used for drawings.

#include <functional>
#include <optional>
#include <vector>

#include "geometry/part/part.h"
#include "raytrace/faces/entrance_face.h"
#include "raytrace/faces/surface_ray.h"
#include "raytrace/light/optics.h"

namespace retrace::raytrace {

/// Events on a path at an interface.
enum class PathEvent {
  enters,            ///< through the entrance face from outside
  total_reflection,  ///< at a facet, a wall, a side or the entrance face
  reflection,        ///< at a facet, a wall, a side or the entrance face, but not total: Fresnel reflection, a film or
                     ///< a mirror
  leaves,            ///< through the entrance face; the path ends
  exits,             ///< through a facet or wall into the air behind the part
  enters_again,      ///< through a facet from the air behind the part
  leaves_side,       ///< through a side of the plate; the path ends
  escapes,           ///< from the air behind the part; the path ends
  stopped,           ///< blocked by the mount or by the chamfer of the entrance face; the path ends
  ends               ///< absorbed or not traced further
};

struct PathStep {
  PathEvent event = PathEvent::ends;
  geometry::FacetRole role = geometry::FacetRole::entrance;  ///< role of the face
  Vec3 at_mm = Vec3::Zero();                                 ///< position in the part frame
  double incidence_deg = 0.0;                                ///< angle of incidence on the face
  double power = 0.0;                                        ///< power after the event over the incident power
  std::optional<FacetRef> facet = {};                        ///< facet of the back surface
};

/// A path of light through a part, with a segment in air before and after it.
struct LightPath {
  std::vector<Vec3> points_mm;  ///< corners in the part frame, including the ends of the segments in air
  std::vector<PathStep> steps;
  double power = 0.0;          ///< power at the end of the path over the incident power
  double deviation_deg = 0.0;  ///< angle between the leaving light and the direction to the source
  bool is_returned = false;    ///< true if the light leaves through the entrance face within `cone_deg`
};

/// Function that returns the first facet that a ray meets, or nothing if it meets none.
using HitFinder = std::function<std::optional<SurfaceHit>(const SurfaceRay& ray)>;

/// Traces a single path from a point of the entrance face. If the face is curved, the path starts on the plane that
/// touches the face from above (EntranceFace::beam_height_mm()). At every interface, the path continues with the
/// stronger of the reflected and the transmitted light. The path is meant for drawings and does not show how the power
/// is split.
/// \param first_hit finds facets of the part, in coordinates with the origin `centre_mm`
/// \param cone_deg half angle of the acceptance cone
/// \param entrance_face curved entrance face with the origin `centre_mm`; null for the plane face
/// \pre the part is finite and its facets are smooth
LightPath strongest_path(const geometry::Part& part, const HitFinder& first_hit, const Vec2& centre_mm,
                         const Optics& optics, const Illumination& illumination, double cone_deg, const Vec2& entry_mm,
                         const EntranceFace* entrance_face = nullptr);

}  // namespace retrace::raytrace
