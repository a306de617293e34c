#pragma once

// Places of the balls in a layer, and the search for the ball that a ray in the air above them meets.

#include <cstdint>
#include <optional>

#include "geometry/vec.h"
#include "raytrace/balls/ball_layer.h"

namespace retrace::raytrace {

using geometry::Vec2, geometry::Vec3;

/// A ball of a layer, by its place in the lattice: rows along x, every next one shifted by half a pitch.
struct BallIndex {
  std::int64_t along = 0;
  std::int64_t row = 0;
  bool operator==(const BallIndex&) const = default;
};

/// Where the balls of a layer lie, and which of them light in the air above z = 0 meets.
class BallLattice {
 public:
  explicit BallLattice(const BallLayer& layer) : radius_mm_(layer.radius_mm()), pitch_mm_(layer.pitch_mm) {}

  Vec3 centre_mm(const BallIndex& ball) const;
  /// Rectangle that repeats, of two balls. \pre a layer
  Vec2 period_mm() const;

  struct Hit {
    BallIndex ball;
    Vec3 from_centre_mm = Vec3::Zero();
  };
  /// What a ray in the air comes to: a ball above z = 0, or nothing that is above it.
  struct Way {
    std::optional<Hit> hit;
    bool leaves = false;       ///< upwards, for good
    bool goes_astray = false;  ///< so level that it would pass too many balls
  };
  /// \param leaving the ball that the ray starts from, if it does; a ball is never met from its own surface
  Way follow(const Vec3& origin_mm, const Vec3& direction, const BallIndex* leaving) const;

 private:
  BallIndex nearest(const Vec2& place_mm) const;
  std::optional<double> distance_to(const BallIndex& ball, const Vec3& origin_mm, const Vec3& direction) const;

  double radius_mm_;
  std::optional<double> pitch_mm_;
};

}  // namespace retrace::raytrace
