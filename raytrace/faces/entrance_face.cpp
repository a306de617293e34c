#include "raytrace/faces/entrance_face.h"

#include "raytrace/faces/height_field.h"
#include "raytrace/faces/mesh_entrance.h"

namespace retrace::raytrace {

double EntranceFace::middle_height_mm() const {
  constexpr double kAbove = 1.0;
  const Vec3 from(0.0, 0.0, highest_mm() + kAbove);
  const auto met = first_hit({from, -Vec3::UnitZ(), {}, false});
  return met ? from.z() - met->hit.t : highest_mm();
}

std::unique_ptr<const EntranceFace> make_entrance_face(const geometry::Entrance& entrance_face,
                                                       const geometry::Part& part, const Vec2& centre_mm) {
  if (const auto* const mesh = std::get_if<std::shared_ptr<const geometry::SurfacePatch>>(&entrance_face))
    return std::make_unique<MeshEntrance>(**mesh, part.outline, centre_mm);
  return std::make_unique<HeightField>(std::get<0>(entrance_face), part.outline, centre_mm);
}

}  // namespace retrace::raytrace
