// Stand-ins for functions that make entrance surfaces from files or meshes. They report an error, because the live page
// cannot read files and has no Embree, which meshes need. Exact surfaces are traced as usual.
#include "design/entrance_file.h"
#include "live/engine/stand_ins/absent.h"
#include "raytrace/faces/height_field.h"

namespace retrace::design {

geometry::Entrance entrance_of_file(const Design&, const geometry::Part&, const geometry::Vec3&) {
  live::fail_as_absent("no access to other files than the design");
}

}  // namespace retrace::design

namespace retrace::raytrace {

std::unique_ptr<const EntranceFace> make_entrance_face(const geometry::Entrance& entrance_face,
                                                       const geometry::Part& part, const Vec2& centre_mm) {
  if (const auto* const surface = std::get_if<std::shared_ptr<const geometry::EntranceSurface>>(&entrance_face))
    return std::make_unique<HeightField>(*surface, part.outline, centre_mm);
  live::fail_as_absent("no entrance surfaces that are meshes");
}

}  // namespace retrace::raytrace
