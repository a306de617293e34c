#pragma once

// Points for integrals over all directions far from a given one, in the plane of direction cosines.

#include <vector>

#include "geometry/vec.h"

namespace retrace::raytrace {

/// Points for the integral of a density that decreases as a power of the distance from a centre. They are distributed
/// uniformly in the logarithm of the distance. The integral is the sum of areas times densities, multiplied by
/// `factor`.
struct DistantDirections {
  std::vector<geometry::Vec2> cosines;
  std::vector<double> areas;
  double factor = 0.0;

  /// \param nearest smallest distance of a point from the centre, in direction cosines; if it is larger than all angles
  ///        at which light is expected, there are no points
  DistantDirections(const geometry::Vec2& centre, double nearest);
};

}  // namespace retrace::raytrace
