#pragma once

// Position and orientation of a ray source: transformation from the frame of the source to the part frame.

#include <array>
#include <optional>

#include "geometry/part/part.h"
#include "studies/rays/ray_set.h"

namespace retrace::studies {

/// Requested position and direction of a ray source. The position is given either by `at_mm` or by the two angles and
/// the distance, but not by both.
struct RayPlacementRequest {
  std::optional<std::array<double, 3>> at_mm;   ///< origin of the source in the part frame
  std::optional<std::array<double, 3>> aim_mm;  ///< point at which the +z axis of the source is aimed
  // Direction and distance of the source from the centre of the entrance face. The +z axis of the source points at this
  // centre.
  std::optional<double> incidence_deg;
  std::optional<double> azimuth_deg;
  std::optional<double> distance_mm;

  bool is_by_angles() const { return incidence_deg || azimuth_deg || distance_mm; }
  /// Places the source in front of the entrance face if the request gives no position.
  void face_part() {
    if (!at_mm && !is_by_angles()) incidence_deg = 0.0;
  }
};

/// Transformation of rays from the frame of the source to the part frame.
struct RayPlacement {
  Eigen::Matrix3d part_from_source = Eigen::Matrix3d::Identity();
  Vec3 at_mm = Vec3::Zero();

  void apply(SetRay& ray) const {
    ray.position_mm = at_mm + part_from_source * ray.position_mm;
    ray.direction = (part_from_source * ray.direction).normalized();
    ray.axis = part_from_source * ray.axis;
  }
};

/// Returns the centre of the entrance face, or of one period of it.
Vec3 centre_of_face(const geometry::Part& part);

/// Computes the placement of a source. The x axis of an aimed source is the part's x axis, projected perpendicular to
/// the source's z axis. If the x axis of the part is parallel to this z axis, the part's y axis is used instead. If
/// nothing is requested, the frame of the source is the part frame.
/// \param in_front_mm minimum height above the entrance face of a source at the default distance; this keeps the source
///     in front of shells, for example
/// \pre each value is allowed by itself (see RaysRequest)
/// \throw InputError if the source would be aimed at its own position
RayPlacement placement_of(const RayPlacementRequest& request, const geometry::Part& part, double in_front_mm = 0.0);

}  // namespace retrace::studies
