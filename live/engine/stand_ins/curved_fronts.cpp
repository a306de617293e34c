// Replaces entrance surfaces of turned parts and meshes by a function that reports an error. Such surfaces are read
// from files, which the live page does not have.
#include "design/entrance_of_design.h"
#include "live/engine/stand_ins/absent.h"

namespace retrace::design {

geometry::Entrance entrance_of_design(const Design&, const geometry::Part&) {
  live::fail_as_absent("no access to other files than the design");
}

}  // namespace retrace::design
