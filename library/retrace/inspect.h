#pragma once

// Computes properties of a design without tracing light, and makes drawings of the design.

#include <string>
#include <vector>

#include "core/warning.h"
#include "requests/inspect.h"
#include "retrace/design.h"
#include "retrace/drawing.h"

namespace retrace {

struct Inspection {
  Warnings warnings;
  std::string json;   ///< JSON document retrace.inspect/2
  std::string table;  ///< summary as text
  Drawing plan;       ///< SVG; this drawing and the next four are empty if they do not apply to the design
  Drawing section;
  Drawing entrance_surface;  ///< profile of a curved entrance surface
  Drawing shells;            ///< section through the shells in front of the part; empty without shells
  Drawing pin_axes;          ///< map of the angles between the axes of the elements and a curved entrance surface
  Drawing view;              ///< view in three dimensions; PNG
};

/// Computes the properties of a design.
/// \throw InputError for an unknown material, and if the request is invalid
RETRACE_API Inspection inspect(const Design& design, const InspectRequest& request = {});

}  // namespace retrace
