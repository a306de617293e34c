#pragma once

// Members that the results of all kinds of pictures have.

#include <string>

#include "core/warning.h"
#include "design/design.h"

namespace retrace::studies {

struct ImageResultBase {
  design::Design design;
  std::string engine;  ///< engine that was used; for a camera "cell" (with Embree at borders) or "embree"
  double elapsed_s = 0.0;
  Warnings warnings;
  bool complete = true;  ///< false: the computation was cancelled, or has fewer passes than requested
};

}  // namespace retrace::studies
