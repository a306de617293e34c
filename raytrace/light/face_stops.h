#pragma once

// Stops at the entrance face of a single cube corner: the chamfer of its rim, and the edge of its mount.

#include <optional>

#include "geometry/part/part.h"
#include "raytrace/light/light.h"

namespace retrace::raytrace {

/// Openings through which light must pass on its way to the entrance face and on its way back. Positions are relative
/// to the centre of the entrance face in x and y.
class FaceStops {
 public:
  FaceStops() = default;
  FaceStops(const geometry::Part& part, const Vec2& centre_mm);

  bool has_chamfer() const { return clear_face_.has_value(); }
  bool has_mount() const { return mount_.has_value(); }
  bool is_empty() const { return !has_chamfer() && !has_mount(); }

  /// Returns true if a point of the face is not on the chamfer.
  bool is_clear(const Vec2& at_mm) const { return !clear_face_ || clear_face_->contains(at_mm); }
  /// Returns true if a line crosses the plane of the mount's edge inside the edge.
  bool passes_mount(const Vec3& position, const Vec3& direction) const;
  /// Returns true if light on the line through a point of the plane entrance face reaches this point: past the mount,
  /// and not on the chamfer.
  bool reaches(const Vec3& on_face, const Vec3& direction) const {
    return is_clear(on_face.head<2>()) && passes_mount(on_face, direction);
  }
  /// Returns true if a position is on the source side of the plane of the mount's edge.
  bool is_in_front_of_mount(const Vec3& position) const { return mount_ && position.z() > edge_height_mm_; }

  /// Returns the z of the edge of the mount, or the height of the plane entrance face if there is no mount.
  double top_mm() const { return mount_ ? edge_height_mm_ : thickness_mm_; }

  /// Returns the area of the plane entrance face that is not on the chamfer.
  /// \pre has_chamfer()
  const geometry::Polygon& clear_face() const { return clear_face_->outline; }
  /// Returns the area in the plane of the entrance face from which light in the given direction passes the mount. Light
  /// in the opposite direction passes the mount towards the same area.
  /// \pre has_mount()
  geometry::Polygon face_through_mount(const Vec3& direction) const;

 private:
  /// Convex polygon, with the radii of two circles about its centre. The border of the polygon is between these
  /// circles.
  struct Opening {
    explicit Opening(geometry::Polygon polygon);
    bool contains(const Vec2& at_mm) const;

    geometry::Polygon outline;
    Vec2 centre_mm;
    double inner_radius_mm = 0.0;
    double outer_radius_mm = 0.0;
  };

  std::optional<Opening> clear_face_;
  std::optional<Opening> mount_;
  double thickness_mm_ = 0.0;    ///< height of the plane entrance face
  double edge_height_mm_ = 0.0;  ///< z of the edge of the mount
};

}  // namespace retrace::raytrace
