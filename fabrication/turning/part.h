#pragma once

// Data of a turned part: freeform surface, tool, path, machine and tolerances.

#include <optional>
#include <string>

#include "core/warning.h"
#include "fabrication/turning/path_options.h"
#include "fabrication/turning/tool.h"
#include "geometry/surface/freeform_surface.h"

namespace retrace::fabrication::turning {

/// Part to be turned: its surface, the tool, the path, the machine and the tolerances.
struct TurnedPart {
  std::string title;
  geometry::FreeformSurface surface;
  TurningTool tool;
  bool skew_is_min = false;  ///< true: the file requests the minimum possible skew, and `tool` contains its value
  PathOptions path;
  TurningMachine machine;
  double form_tolerance_nm = 10.0;
  std::size_t map_pixels = 101;
  std::optional<double> mesh_thickness_mm;  ///< thickness of the moulded part in the mesh; no mesh is written if empty
  int mesh_rings = 100;
  Warnings warnings;
};

}  // namespace retrace::fabrication::turning
