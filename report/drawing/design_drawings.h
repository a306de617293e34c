#pragma once

// Makes the drawings of `retrace inspect`.

#include <string>

#include "core/warning.h"
#include "studies/inspect/inspect.h"

namespace retrace::report {

/// Contents of the drawings. Drawings that do not apply to the design are empty.
struct DesignDrawings {
  std::string plan = {};      ///< SVG
  std::string section = {};   ///< SVG
  std::string view = {};      ///< PNG
  std::string entrance = {};  ///< SVG: profile of a curved entrance face
  std::string shells = {};    ///< SVG: section through the shells in front of the part
  std::string pin_axes = {};  ///< SVG: angles between the elements' axes and a curved entrance face
  Warnings warnings = {};
};

/// Returns the plan, the section and the view of a design, and the profile of a curved entrance face. Shells are shown
/// in an additional section. A design with balls has no drawings. A design with elements on a substrate (a curved
/// surface) has only the view, because the plan and the section cannot show true lengths.
DesignDrawings design_drawings(const studies::Inspection& inspection);

}  // namespace retrace::report
