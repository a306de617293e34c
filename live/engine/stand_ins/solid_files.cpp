// Stand-in for the function that reads solids of STEP files. It reports an error, because the live page cannot read
// files.
#include "geometry/io/step_solid.h"
#include "live/engine/stand_ins/absent.h"

namespace retrace::geometry {

SolidMesh read_step_solid(const std::filesystem::path&, double) {
  live::fail_as_absent("no access to other files than the design");
}

}  // namespace retrace::geometry
