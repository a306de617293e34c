#pragma once

// Stops in front of a single cube corner: the chamfer at the rim of its entrance face, and the edge of its mount.

#include <optional>

#include "geometry/part/part.h"
#include "raytrace/light/light.h"

namespace retrace::raytrace {

/// Areas that incident and returning light must pass: the entrance face without its chamfer, and the opening of the
/// mount. Coordinates x and y are relative to the centre of the entrance face.
class FaceStops {
 public:
  FaceStops() = default;
  FaceStops(const geometry::Part& part, const Vec2& centre_mm);

  bool has_chamfer() const { return clear_face_.has_value(); }
  bool has_mount() const { return mount_.has_value(); }
  bool is_empty() const { return !has_chamfer() && !has_mount(); }

  /// Returns true if a point of the entrance face is not on the chamfer.
  bool is_clear(const Vec2& at_mm) const { return !clear_face_ || clear_face_->contains(at_mm); }
  /// Returns true if the line through `position` along `direction` passes the opening of the mount.
  bool passes_mount(const Vec3& position, const Vec3& direction) const;
  /// Returns true if light along `direction` passes the mount and reaches the point `on_face` of the plane entrance
  /// face. The point must not be on the chamfer.
  bool reaches(const Vec3& on_face, const Vec3& direction) const {
    return is_clear(on_face.head<2>()) && passes_mount(on_face, direction);
  }
  /// Returns true if a position is above the plane of the mount's edge, on the side of the source.
  bool is_in_front_of_mount(const Vec3& position) const { return mount_ && position.z() > edge_height_mm_; }

  /// Returns the z coordinate of the mount's edge. Without a mount, returns the height of the plane entrance face.
  double top_mm() const { return mount_ ? edge_height_mm_ : thickness_mm_; }

  /// Returns the outline of the plane entrance face without its chamfer.
  /// \pre has_chamfer()
  const geometry::Polygon& clear_face() const { return clear_face_->outline; }
  /// Returns the area of the entrance plane from which light in the given direction passes the mount. Light in the
  /// opposite direction reaches the same area through the mount.
  /// \pre has_mount()
  geometry::Polygon face_through_mount(const Vec3& direction) const;

 private:
  /// Convex polygon whose border is between two circles about its centre. The circles speed up tests of points.
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
  double edge_height_mm_ = 0.0;  ///< z coordinate of the mount's edge
};

}  // namespace retrace::raytrace
