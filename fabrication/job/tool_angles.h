#pragma once

// Clearance and rake angle of a chisel against the facet that it cuts.

#include "fabrication/job/job.h"

namespace retrace::fabrication {

/// Angles between tool and cut surface; clearance + wedge + rake = 90 for either motion.
struct CuttingAngles {
  double clearance_deg = 0.0;
  double rake_deg = 0.0;
};

/// Plunging along facet 1: the clearance face looks at the wall it leaves behind.
inline CuttingAngles plunge_angles(const Tool& tool) {
  return {tool.clearance_deg, 90.0 - tool.wedge_deg - tool.clearance_deg};
}

/// Ploughing along a facet at right angles to facet 1: the rake face leads.
inline CuttingAngles plough_angles(const Tool& tool) {
  return {90.0 + tool.clearance_deg, -tool.wedge_deg - tool.clearance_deg};
}

}  // namespace retrace::fabrication
