#pragma once

// Interface for what records every path that leaves through the entrance face, such as detectors.

#include "raytrace/faces/surface_ray.h"

namespace retrace::raytrace {

/// Told of light that leaves the part through the entrance face, path by path; of a plane face that scatters also of
/// what it sends back at once.
class ExitObserver {
 public:
  virtual ~ExitObserver() = default;
  /// \param position on the entrance face, relative to its centre in x and y; of an infinite part in some period of it
  /// \param direction in air, a unit vector \param power in units of that of the path when it began
  virtual void leaves(const Vec3& position, const Vec3& direction, double power) = 0;
};

}  // namespace retrace::raytrace
