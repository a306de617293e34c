#pragma once

// Comparison of beams behind a tangent plane with rays through the curved entrance surface.

#include <cstddef>

#include "raytrace/observers/element_light.h"

namespace retrace::raytrace {

/// Differences between the model of tangent planes and rays that are refracted at the curved surface where they enter
/// and where they leave.
class TangentError {
 public:
  /// Compares some rays of a beam from trace_element(). Beams that were refracted at the back surface are ignored.
  void add(const geometry::EntranceSurface& surface, const ElementScene& scene, const ReturnedBeam& beam);
  void add(const TangentError& other);
  /// Records a ray for which the comparison failed. The maximum angle becomes infinite.
  void add_failure();

  std::size_t rays() const { return rays_; }
  /// Returns the root mean square difference between the optical path lengths, in mm, after the mean difference of each
  /// beam has been subtracted. Beams are weighted by their power.
  double path_rms_mm() const;
  /// Returns the root mean square angle between the directions in which the light leaves, in rad. Beams are weighted by
  /// their power.
  double angle_rms_rad() const;
  /// Returns the maximum angle between the directions in which the light leaves, in rad.
  double max_angle_rad() const { return max_angle_rad_; }

 private:
  std::size_t rays_ = 0;
  double power_ = 0.0;
  double squared_path_mm2_ = 0.0;  ///< sum of squared path differences times power
  double squared_angle_ = 0.0;     ///< sum of squared angles times power
  double max_angle_rad_ = 0.0;
};

}  // namespace retrace::raytrace
