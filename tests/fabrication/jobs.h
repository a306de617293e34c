#pragma once

// Small jobs for tests.

#include <algorithm>

#include "fabrication/job/job.h"

namespace retrace::fabrication::test {

inline Process thesis_process() {
  Process p;
  p.name = "test";
  p.source = "a test";
  return p;
}

/// Returns a job of n x n prisms of 0.451 mm in brick rows, as in the thesis, with a suitable tool.
inline Job square_job(int n, geometry::Arrangement arrangement = geometry::Arrangement::offset) {
  Job job;
  prism_of(job).base_mm = 0.451;
  prism_of(job).width_mm = 0.451;
  job.array.arrangement = n == 1 ? geometry::Arrangement::single : arrangement;
  if (n > 1) job.array.x_length_mm = job.array.y_length_mm = 0.451 * n;
  job.tool.width_mm = 0.451;
  job.process = thesis_process();
  return job;
}

/// Returns a job of one prism that is cut in two steps with few passes.
inline Job small_prism_job() {
  Job job = square_job(1, geometry::Arrangement::single);
  job.strategy = Strategy::two_step;
  job.process.roughing_depth_um = 100;
  job.process.finishing_cuts = 1;
  return job;
}

/// Returns a valid wedge angle for a job of prisms. It is `above_deg` larger than the minimum, but at most the maximum.
inline double wedge_deg(const Job& job, int above_deg) {
  const double apex_deg = prism_of(job).apex_angle_deg;
  const double widest_deg = std::min(apex_deg - 12.5 - job.tool.clearance_deg, 70.0);
  // If the rake faces of plunges along both facets do not intersect, a fin remains above the root.
  const double least_deg =
      job.strategy == Strategy::unidirectional ? 40.0 : std::max(40.0, 0.5 * apex_deg + 2.0 - job.tool.clearance_deg);
  return std::min(widest_deg, least_deg + above_deg);
}

}  // namespace retrace::fabrication::test
