#pragma once

// The drawings of `retrace inspect`.

#include <string>
#include <vector>

#include "core/warning.h"
#include "studies/inspect/inspect.h"

namespace retrace::report {

/// Contents of the drawings; those that a design has not are empty.
struct DesignDrawings {
  std::string plan = {};      ///< SVG
  std::string section = {};   ///< SVG
  std::string view = {};      ///< PNG
  std::string entrance = {};  ///< SVG: the profile of a curved front
  Warnings warnings = {};
};

/// Plan, section and view of the design; of a curved front its profile in place of section and view, which know plane
/// entrance faces alone; none of balls; of elements on a base the view alone, as their lengths lie in no plane.
DesignDrawings design_drawings(const studies::Inspection& inspection);

}  // namespace retrace::report
