#pragma once

// What a design is, before any light is traced, and its drawings.

#include <string>
#include <vector>

#include "core/warning.h"
#include "retrace/design.h"
#include "retrace/drawing.h"

namespace retrace {

struct Inspection {
  Warnings warnings;
  std::string json;   ///< document retrace.inspect/1
  std::string table;  ///< for people
  Drawing plan;       ///< SVG, as all but the view; drawings that a design has not are none or empty
  Drawing section;
  Drawing front;  ///< profile of a curved entrance face
  Drawing view;   ///< in three dimensions; PNG
};

/// \throw InputError for an unknown material
RETRACE_API Inspection inspect(const Design& design);

}  // namespace retrace
