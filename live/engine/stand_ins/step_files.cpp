// Stand-ins for functions that read STEP files. They report an error, because the live page cannot read files.
#include "geometry/io/step_reader.h"
#include "geometry/io/step_solid.h"
#include "live/engine/stand_ins/absent.h"

namespace retrace::geometry {

std::shared_ptr<const StepSurface> read_step_surface(const StepChoice&) {
  live::fail_as_absent("no access to other files than the design");
}

std::vector<OutlineLoop> read_step_outline(const StepChoice&) {
  live::fail_as_absent("no access to other files than the design");
}

SolidMesh read_step_solid(const std::filesystem::path&, double) {
  live::fail_as_absent("no access to other files than the design");
}

}  // namespace retrace::geometry
