#pragma once

// Region of the incident beam from which light reaches a part through shells that change its direction.

#include <array>
#include <optional>

#include "geometry/polygon.h"
#include "raytrace/light/shells.h"
#include "raytrace/sampling/triangle_sampler.h"

namespace retrace::raytrace {

/// Region that the incident beam covers in the horizontal plane through the vertex of the outermost shell. Light from
/// this region reaches all points of the entrance face, and light from outside of the region reaches none. The border
/// of the region is a polygon. Light from its corners reaches the border of the face.
class LitRegion {
 public:
  /// \param to_source unit vector to the source; z > 0
  /// \param outline convex outline of the part, relative to the middle of the part
  /// \param face_height_mm height of the plane of the entrance face, relative to the middle of the part
  /// \pre `shells` is not empty
  LitRegion(const Shells& shells, const Vec3& to_source, const geometry::Polygon& outline, double face_height_mm);

  /// Returns the height of the plane of the region, relative to the middle of the part.
  double height_mm() const { return height_mm_; }
  /// Returns the area of the region divided by the area of the entrance face, both in plan.
  double area_ratio() const { return area_ratio_; }
  /// Maps the unit square onto the region and preserves ratios of areas. The result is relative to the middle of the
  /// part.
  Vec2 operator()(const std::array<double, 2>& u) const { return triangles_(u); }

 private:
  double height_mm_ = 0.0;
  double area_ratio_ = 1.0;
  TriangleSampler triangles_;
};

}  // namespace retrace::raytrace
