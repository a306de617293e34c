#pragma once

// Turned parts as data: freeform surface, tool, path, machine and tolerances.

#include <optional>
#include <string>
#include <vector>

#include "core/warning.h"
#include "fabrication/turning/path_options.h"
#include "fabrication/turning/tool.h"
#include "geometry/surface/freeform_surface.h"

namespace retrace::fabrication::turning {

/// A part to be turned: its surface, the tool, the path, the machine and what is asked of the result.
struct TurnedPart {
  std::string title;
  geometry::FreeformSurface surface;
  TurningTool tool;
  bool skew_is_least = false;  ///< the file asks for the least skew that clears; `tool` has it
  PathOptions path;
  TurningMachine machine;
  double form_tolerance_nm = 10.0;
  std::size_t map_pixels = 101;
  std::optional<double> mesh_thickness_mm;  ///< of what is moulded in it, as a mesh; nothing: no mesh
  int mesh_rings = 100;
  Warnings warnings;
};

}  // namespace retrace::fabrication::turning
