#pragma once

// Heights, profiles and maximum slope of a curved entrance face, for `retrace inspect`.

#include <vector>

#include "geometry/entrance/entrance_surface.h"
#include "geometry/part/part.h"

namespace retrace::studies {

/// Heights, profiles and maximum slope of a curved entrance face.
struct EntranceReport {
  geometry::EntranceRange range;  ///< heights in the part frame
  double steepest_deg = 0.0;      ///< maximum slope of sampled points
  /// Heights along x and along y, through the centre of the part. NaN outside the outline.
  struct Profile {
    std::vector<double> position_mm;
    std::vector<double> height_mm;
  };
  Profile along_x;
  Profile along_y;
};

/// Returns a function for the heights of a curved entrance face.
/// \pre the entrance face covers the part (entrance_of_design())
geometry::EntranceHeights heights_of(const geometry::Entrance& entrance, const geometry::Part& part);

/// Returns the report on a curved entrance face.
/// \pre the entrance face covers the part (entrance_of_design())
EntranceReport report_entrance(const geometry::Entrance& entrance, const geometry::Part& part);

}  // namespace retrace::studies
