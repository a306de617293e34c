#include "raytrace/front/front_face.h"

#include "raytrace/front/height_field.h"
#include "raytrace/front/mesh_front.h"

namespace retrace::raytrace {

std::unique_ptr<const FrontFace> make_front_face(const geometry::Front& front, const geometry::Part& part,
                                                 const Vec2& centre_mm) {
  if (const auto* const mesh = std::get_if<std::shared_ptr<const geometry::SurfacePatch>>(&front))
    return std::make_unique<MeshFront>(**mesh, part.outline, centre_mm);
  return std::make_unique<HeightField>(std::get<0>(front), part.outline, centre_mm);
}

}  // namespace retrace::raytrace
