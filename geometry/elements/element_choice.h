#pragma once

// Describes which elements of a finite array are chosen: those in a region of the plan, or a random fraction of all.

#include <cstdint>
#include <variant>

#include "geometry/polygon.h"

namespace retrace::geometry {

/// Chooses each element with equal probability, using a hash of its row, its column and the seed.
struct RandomFraction {
  double fraction = 0.0;  ///< 0 to 1
  std::uint32_t seed = 1;
};
struct Disc {
  Vec2 centre_mm = Vec2::Zero();
  double radius_mm = 0.0;  ///< > 0; the circle itself is included
};
/// One side of a line. The line itself is included.
struct HalfPlane {
  Vec2 through_mm = Vec2::Zero();
  double azimuth_deg = 0.0;  ///< direction from the line into the half-plane, from +x towards +y
};
/// Choice of elements. Positions are in the part frame. The borders of a rectangle are included.
using ElementChoice = std::variant<RandomFraction, Rectangle, Disc, HalfPlane>;

}  // namespace retrace::geometry
