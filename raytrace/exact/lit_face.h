#pragma once

// Portions of an entrance face that the incident light reaches through the stops in front of the face.

#include "raytrace/exact/beam_scene.h"

namespace retrace::raytrace {

/// Illuminated portions of the plane entrance face of a part with stops (FaceStops). Polygons are relative to the
/// centre of the face.
struct LitFace {
  explicit LitFace(const BeamScene& scene);

  Corners reached;                  ///< portion of the face that the incident light reaches
  Corners reflected;                ///< portion of the face whose reflected light passes the mount
  double reached_fraction = 0.0;    ///< area of `reached`, divided by the area of the face
  double reflected_fraction = 0.0;  ///< area of `reflected`, divided by the area of the face
};

/// Returns the area of a horizontal polygon, which may have either orientation.
double horizontal_area(const Corners& corners);

}  // namespace retrace::raytrace
