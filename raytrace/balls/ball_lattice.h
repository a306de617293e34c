#pragma once

// Positions of the balls in a layer, and the search for the ball that a ray in the air above them meets.

#include <cstdint>
#include <optional>

#include "geometry/vec.h"
#include "raytrace/balls/ball_layer.h"

namespace retrace::raytrace {

using geometry::Vec2, geometry::Vec3;

/// Index of a ball in the lattice of a layer. Rows are parallel to x, and each row is shifted by half a pitch relative
/// to the row before.
struct BallIndex {
  std::int64_t along = 0;
  std::int64_t row = 0;
  bool operator==(const BallIndex&) const = default;
};

/// Lattice of the balls of a layer. It finds the ball that a ray in the air above z = 0 meets.
class BallLattice {
 public:
  explicit BallLattice(const BallLayer& layer) : radius_mm_(layer.radius_mm()), pitch_mm_(layer.pitch_mm) {}

  Vec3 centre_mm(const BallIndex& ball) const;
  /// Returns the size of the rectangular period, which contains two balls.
  /// \pre the layer has a pitch
  Vec2 period_mm() const;

  struct Hit {
    BallIndex ball;
    Vec3 from_centre_mm = Vec3::Zero();
  };
  /// Result of the search along a ray in the air. A ray that meets no ball above z = 0 either leaves the layer, or
  /// reaches the plane z = 0 between the balls.
  struct SearchResult {
    std::optional<Hit> hit;
    bool is_rising = false;     ///< true if the ray rises; a rising ray without a hit leaves the layer
    bool is_abandoned = false;  ///< true if the ray is nearly horizontal and was given up after many balls
  };
  /// \param leaving ball from whose surface the ray starts, which is excluded from the search; null for none
  SearchResult follow(const Vec3& origin_mm, const Vec3& direction, const BallIndex* leaving) const;

 private:
  BallIndex nearest(const Vec2& point_mm) const;
  std::optional<double> distance_to(const BallIndex& ball, const Vec3& origin_mm, const Vec3& direction) const;

  double radius_mm_;
  std::optional<double> pitch_mm_;
};

}  // namespace retrace::raytrace
