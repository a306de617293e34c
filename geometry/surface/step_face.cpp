#include "geometry/surface/step_face.h"

#include "geometry/surface/step_surface.h"

namespace retrace::geometry {

std::shared_ptr<const PatchSurface> patches_of(const StepFace& face) {
  return face.surface ? std::shared_ptr<const PatchSurface>(face.surface, &face.surface->patches) : nullptr;
}

}  // namespace retrace::geometry
