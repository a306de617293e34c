#pragma once

// Where a source of rays stands, and how it is turned: from its frame to that of the part.

#include <array>
#include <optional>

#include "geometry/part/part.h"
#include "studies/design/length_limits.h"
#include "studies/rays/ray_set.h"

namespace retrace::studies {

/// What is asked; `at_mm` or the three angles and distance, not both.
struct RayPlacementRequest {
  std::optional<std::array<double, 3>> at_mm;   ///< where its origin lies, in the part frame
  std::optional<std::array<double, 3>> aim_mm;  ///< what its +z points at
  // It stands in that direction from the middle of the entrance face, and its +z points there.
  std::optional<double> incidence_deg;
  std::optional<double> azimuth_deg;
  std::optional<double> distance_mm;

  bool is_by_angles() const { return incidence_deg || azimuth_deg || distance_mm; }
  /// Where no place is asked for, the source stands before the face.
  void face_part() {
    if (!at_mm && !is_by_angles()) incidence_deg = 0.0;
  }
};

/// Turns and moves rays.
struct RayPlacement {
  Eigen::Matrix3d part_from_source = Eigen::Matrix3d::Identity();
  Vec3 at_mm = Vec3::Zero();

  void apply(SetRay& ray) const {
    ray.position_mm = at_mm + part_from_source * ray.position_mm;
    ray.direction = (part_from_source * ray.direction).normalized();
    ray.axis = part_from_source * ray.axis;
  }
};

/// The middle of the entrance face, or of a period of it.
Vec3 middle_of_face(const geometry::Part& part);

/// A source that is aimed has its x axis along the part's, seen along its own z axis (where that is x, along y). The
/// frame of a source that nothing is asked of is that of the part.
/// \throw InputError for what contradicts itself, or is out of range
RayPlacement placement_of(const RayPlacementRequest& request, const geometry::Part& part);

}  // namespace retrace::studies
