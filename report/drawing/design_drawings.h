#pragma once

// Makes the drawings of `retrace inspect`.

#include <string>
#include <vector>

#include "core/warning.h"
#include "studies/inspect/inspect.h"

namespace retrace::report {

/// Contents of the drawings. Drawings that do not apply to the design are empty.
struct DesignDrawings {
  std::string plan = {};      ///< SVG
  std::string section = {};   ///< SVG
  std::string view = {};      ///< PNG
  std::string entrance = {};  ///< SVG: profile of a curved front
  Warnings warnings = {};
};

/// Returns the plan, the section and the view of a design. A design with a curved front has a profile instead of
/// section and view, which require a plane entrance face. A design with balls has no drawings. A design with elements
/// on a curved substrate has only the view, because the plan cannot show their true lengths.
DesignDrawings design_drawings(const studies::Inspection& inspection);

}  // namespace retrace::report
