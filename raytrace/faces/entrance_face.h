#pragma once

// Curved entrance faces as rays meet them: the interface that height fields (height_field.h) and meshes
// (mesh_entrance.h) fulfil.

#include <memory>
#include <optional>

#include "geometry/entrance/entrance_surface.h"
#include "geometry/part/part.h"
#include "raytrace/faces/surface_ray.h"

namespace retrace::raytrace {

/// Where a ray meets the entrance surface.
struct EntranceHit {
  SurfaceHit hit;
  Vec3 normal = Vec3::UnitZ();  ///< unit, out of the part
};

/// The curved front of a part, ready for rays: positions are relative to the centre of the part's outline in x and y.
/// Safe to use from many threads.
class EntranceFace {
 public:
  EntranceFace(const EntranceFace&) = delete;
  EntranceFace& operator=(const EntranceFace&) = delete;
  virtual ~EntranceFace() = default;

  /// The first place where the ray meets the entrance surface from its own side, up to `t_max`. \pre it does so over
  /// the outline
  virtual std::optional<EntranceHit> first_hit(const SurfaceRay& ray) const = 0;

  /// Over the outline.
  double lowest_mm() const { return range_.lowest_mm; }
  double highest_mm() const { return range_.highest_mm; }

 protected:
  explicit EntranceFace(const geometry::EntranceRange& range) : range_(range) {}

 private:
  geometry::EntranceRange range_;
};

/// \param centre_mm point of the plane that becomes the origin of rays
/// \throw InputError for a surface that has no finite height somewhere over the part's outline
std::unique_ptr<const EntranceFace> make_entrance_face(const geometry::Entrance& entrance_face,
                                                       const geometry::Part& part, const Vec2& centre_mm);

}  // namespace retrace::raytrace
