#pragma once

#include <vector>

#include "geometry/front_surface.h"
#include "geometry/part.h"

namespace retrace::studies {

/// What a curved front is like.
struct FrontReport {
  geometry::FrontRange range;  ///< heights in the part's frame
  double steepest_deg = 0.0;   ///< sampled
  /// Heights along x and along y, through the middle of the part; NaN beyond its outline.
  struct Profile {
    std::vector<double> place_mm;
    std::vector<double> height_mm;
  };
  Profile along_x;
  Profile along_y;
};

/// \pre the front covers the part (front_of_design())
FrontReport report_front(const geometry::Front& front, const geometry::Part& part);

}  // namespace retrace::studies
