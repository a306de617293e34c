#pragma once

#include "fabrication/turning/plan/path.h"

namespace retrace::fabrication::turning {

inline PathOptions spiral_of(double radius_mm, double feed_mm, int points_per_turn = 90) {
  return {.radius_mm = radius_mm, .feed_mm = feed_mm, .points_per_turn = points_per_turn};
}

inline PathOptions raster_of(double width_mm, double height_mm, double feed_mm, double arc_mm) {
  return {
      .strategy = Strategy::raster, .width_mm = width_mm, .height_mm = height_mm, .feed_mm = feed_mm, .arc_mm = arc_mm};
}

}  // namespace retrace::fabrication::turning
