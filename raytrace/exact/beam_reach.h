#pragma once

// Length of a beam's next step, and the region of the part that the beam passes through in this step.

#include "raytrace/exact/beam_scene.h"

namespace retrace::raytrace {

/// Axis-aligned rectangle, either in the coordinates across a beam or in x and y of the part.
struct PlanBox {
  Vec2 lower = Vec2::Constant(INFINITY);
  Vec2 upper = Vec2::Constant(-INFINITY);

  void include(const Vec2& p) {
    lower = lower.cwiseMin(p);
    upper = upper.cwiseMax(p);
  }
  bool overlaps(const PlanBox& other) const {
    return (lower.array() < other.upper.array()).all() && (other.lower.array() < upper.array()).all();
  }
};

/// Distance along a beam up to which facets are searched.
struct Horizon {
  double t = 0.0;        ///< distance in mm along the beam, from each corner of its cross-section
  bool limited = false;  ///< true if the beam may meet further facets beyond this distance
};

/// Returns the distance at which the whole beam has left the layer of elements, -depth <= z <= top. The distance is
/// limited for nearly horizontal beams.
Horizon horizon_of(const BeamScene& scene, const Beam& beam);

/// Returns the plane across a beam at its horizon, with the normal along the beam.
Plane plane_at(const Horizon& horizon, const Beam& beam);

/// Returns the bounding box in x and y of the beam's path through the layer of elements. The top of this layer is the
/// plane z = LightSetup::top_mm.
/// \param horizon maximum distance along the beam at which facets are searched
PlanBox sweep_in_layer(const BeamScene& scene, const Beam& beam, const Horizon& horizon);

/// Returns a box in x and y around all points at which a beam may meet a face in its next step. The box is the whole
/// plane if the beam is inside the part and nearly horizontal, and may travel to a side face.
PlanBox sweep_of(const BeamScene& scene, const Beam& beam);

}  // namespace retrace::raytrace
