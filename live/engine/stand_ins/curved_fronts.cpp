// Replaces turned parts and meshes as entrance surfaces, because they are read from files.
#include "live/engine/stand_ins/absent.h"
#include "studies/design/entrance_of_design.h"

namespace retrace::studies {

geometry::Entrance entrance_of_design(const Design&, const geometry::Part&) {
  live::fail_as_absent("no files beside the design");
}

}  // namespace retrace::studies
