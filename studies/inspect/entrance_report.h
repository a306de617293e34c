#pragma once

// Figures of a curved entrance surface for `retrace inspect`: heights, profiles, steepest slope.

#include <vector>

#include "geometry/entrance/entrance_surface.h"
#include "geometry/part/part.h"

namespace retrace::studies {

/// What a curved entrance surface is like.
struct EntranceReport {
  geometry::EntranceRange range;  ///< heights in the part's frame
  double steepest_deg = 0.0;      ///< sampled
  /// Heights along x and along y, through the middle of the part; NaN beyond its outline.
  struct Profile {
    std::vector<double> place_mm;
    std::vector<double> height_mm;
  };
  Profile along_x;
  Profile along_y;
};

/// \pre the entrance surface covers the part (entrance_of_design())
EntranceReport report_entrance(const geometry::Entrance& entrance, const geometry::Part& part);

}  // namespace retrace::studies
