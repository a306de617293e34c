#pragma once

// Small jobs for tests.

#include "fabrication/job/job.h"

namespace retrace::fabrication::test {

inline Process thesis_process() {
  Process p;
  p.name = "test";
  p.source = "a test";
  return p;
}

/// n x n prisms of 0.451 mm in brick rows, as the thesis cut them, by a tool that fits.
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

}  // namespace retrace::fabrication::test
