#pragma once

// Interface for the intersection of rays with curved entrance faces. It is implemented by height fields
// (height_field.h) and meshes (mesh_entrance.h).

#include <memory>
#include <optional>

#include "geometry/entrance/entrance_surface.h"
#include "geometry/part/part.h"
#include "raytrace/faces/surface_ray.h"

namespace retrace::raytrace {

/// Intersection of a ray with the entrance surface.
struct EntranceHit {
  SurfaceHit hit;
  Vec3 normal = Vec3::UnitZ();  ///< unit normal that points out of the part
};

/// The curved entrance face of a part, prepared for ray tracing. Positions are relative to the centre of the part's
/// outline in x and y. All member functions are thread-safe.
class EntranceFace {
 public:
  EntranceFace(const EntranceFace&) = delete;
  EntranceFace& operator=(const EntranceFace&) = delete;
  virtual ~EntranceFace() = default;

  /// Returns the first point, up to `t_max`, at which the ray crosses the entrance surface from the side on which it
  /// starts. This is the lower side for rays inside the part, otherwise the upper side.
  /// \pre the intersection is within the outline of the part
  virtual std::optional<EntranceHit> first_hit(const SurfaceRay& ray) const = 0;

  /// Returns the minimum height over the outline; highest_mm() returns the maximum height.
  double lowest_mm() const { return range_.lowest_mm; }
  double highest_mm() const { return range_.highest_mm; }
  /// Returns the height, at a given position, of the plane that touches the surface from above. In this plane, the
  /// incident beam covers exactly the outline of the part. The plane is horizontal unless the surface is inclined.
  double beam_height_mm(const Vec2& position_mm) const { return range_.beam_height_mm(position_mm + centre_mm_); }
  /// Returns the height of the surface at the middle of the part, which is the centre of the outline's bounding box. If
  /// the outline does not contain this point, returns the maximum height.
  double middle_height_mm() const;

 protected:
  EntranceFace(const geometry::EntranceRange& range, const Vec2& centre_mm) : range_(range), centre_mm_(centre_mm) {}

 private:
  geometry::EntranceRange range_;
  Vec2 centre_mm_;
};

/// Returns the entrance face for ray tracing.
/// \param centre_mm point of the plane z = 0 that becomes the origin of rays
/// \throw InputError for a surface that has no finite height somewhere over the part's outline
std::unique_ptr<const EntranceFace> make_entrance_face(const geometry::Entrance& entrance_face,
                                                       const geometry::Part& part, const Vec2& centre_mm);

}  // namespace retrace::raytrace
