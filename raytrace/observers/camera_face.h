#pragma once

// Points of the entrance face of a part in a camera picture.

#include <Eigen/Core>

#include "geometry/polygon.h"
#include "raytrace/observers/camera.h"

namespace retrace::raytrace {

/// Point of the entrance face, in the camera frame and in the frame in which light is traced.
struct FacePoint {
  geometry::Vec2 local_mm = geometry::Vec2::Zero();  ///< on a film: arc length along x, and y
  geometry::Vec3 world_mm = geometry::Vec3::Zero();
  Eigen::Matrix3d world_from_local = Eigen::Matrix3d::Identity();
};
/// Returns the point with the given coordinates FacePoint::local_mm.
FacePoint face_point(const geometry::Part& part, const CameraScene& scene, const geometry::Vec2& local_mm);
/// Returns a rectangle that contains the visible area of the entrance face, in the coordinates of FacePoint::local_mm.
/// Returns the bounding box of the face if the picture shows no point of it.
geometry::Rectangle visible_face(const geometry::Part& part, const CameraScene& scene);

}  // namespace retrace::raytrace
