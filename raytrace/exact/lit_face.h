#pragma once

// Portions of the entrance face that are illuminated although a chamfer or a mount blocks some of the light.

#include "raytrace/exact/beam_scene.h"

namespace retrace::raytrace {

/// Illuminated portions of a plane entrance face with a chamfer or a mount (FaceStops). Coordinates are relative to the
/// centre of the face.
struct LitFace {
  explicit LitFace(const BeamScene& scene);

  Corners reached;                  ///< portion of the face that the incident light reaches
  Corners reflected;                ///< portion of the face from which reflected light passes the mount
  double reached_fraction = 0.0;    ///< area of `reached`, divided by the area of the face
  double reflected_fraction = 0.0;  ///< area of `reflected`, divided by the area of the face
};

/// Returns the area of a horizontal polygon with either orientation.
double horizontal_area(const Corners& corners);

}  // namespace retrace::raytrace
