#pragma once

// Which elements of a finite array are meant: those in a region of the plan, or a share of them by chance.

#include <cstdint>
#include <variant>

#include "geometry/polygon.h"

namespace retrace::geometry {

/// Every element with the same chance, by a hash of its row, its column and the seed.
struct RandomShare {
  double share = 0.0;  ///< 0 to 1
  std::uint32_t seed = 1;
};
struct Disc {
  Vec2 centre_mm = Vec2::Zero();
  double radius_mm = 0.0;  ///< > 0; the circle belongs to it
};
/// One side of a line; the line belongs to it.
struct HalfPlane {
  Vec2 through_mm = Vec2::Zero();
  double azimuth_deg = 0.0;  ///< across the line and into it, from +x towards +y
};
/// Places are those of the part frame. The borders of a rectangle belong to it.
using ElementChoice = std::variant<RandomShare, Rectangle, Disc, HalfPlane>;

}  // namespace retrace::geometry
