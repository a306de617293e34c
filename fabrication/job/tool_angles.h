#pragma once

// Computes the clearance angle and the rake angle between a chisel and the facet that it cuts.

#include "fabrication/job/job.h"

namespace retrace::fabrication {

/// Angles between the tool and the cut surface. The sum of clearance, wedge and rake angle is 90 degrees for both
/// motions.
struct CuttingAngles {
  double clearance_deg = 0.0;
  double rake_deg = 0.0;
};

/// Returns the angles while the tool plunges along facet 1. The clearance face is next to the machined wall.
inline CuttingAngles plunge_angles(const Tool& tool) {
  return {tool.clearance_deg, 90.0 - tool.wedge_deg - tool.clearance_deg};
}

/// Returns the angles while the tool ploughs along a facet that is perpendicular to facet 1. The rake face is next to
/// the machined facet.
inline CuttingAngles plough_angles(const Tool& tool) {
  return {90.0 + tool.clearance_deg, -tool.wedge_deg - tool.clearance_deg};
}

}  // namespace retrace::fabrication
