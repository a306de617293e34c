#pragma once

// Small jobs on substrates for tests.

#include <memory>
#include <string>
#include <vector>

#include "tests/fabrication/chiseling_jobs.h"

namespace retrace::fabrication::test {

using geometry::ElementAxes;
using geometry::Substrate;

inline Substrate plane_substrate(double incline_deg, double azimuth_deg, geometry::ElementAxes element_axes) {
  return {geometry::PlaneSubstrate{incline_deg, azimuth_deg}, element_axes};
}
inline Substrate cylinder_substrate(double radius_mm, bool axis_is_x, geometry::ElementAxes element_axes) {
  return {geometry::CylinderSubstrate{radius_mm, axis_is_x}, element_axes};
}
inline Substrate sphere_substrate(double radius_mm, geometry::ElementAxes element_axes) {
  return {geometry::SphereSubstrate{radius_mm}, element_axes};
}
inline Substrate formula_substrate(const std::string& text, geometry::ElementAxes element_axes) {
  return {geometry::formula_substrate(text), element_axes};
}

/// Returns a job of n x n adjacent prisms on a substrate. The roughing depth is large enough for tilted elements.
inline Job prisms_on(const Substrate& substrate, int n = 3,
                     geometry::Arrangement arrangement = geometry::Arrangement::aligned) {
  Job job = square_job(n, arrangement);
  job.array.x_length_mm = job.array.y_length_mm = 0.451 * n;
  job.process.roughing_depth_um = 30.0;
  job.substrate = substrate;
  return job;
}

/// Returns a job of cube corners on a substrate. The tool is wide enough for blanks that extend above the rims.
inline Job cubes_on(const Substrate& substrate, bool is_hexagonal, double aperture_mm = 0.15) {
  Job job = cube_job(is_hexagonal, aperture_mm);
  job.array.pattern.clear();
  job.array.x_length_mm *= 1.02;
  job.array.y_length_mm *= 1.02;
  job.tool.width_mm = 6.0 * aperture_mm;
  job.substrate = substrate;
  return job;
}

}  // namespace retrace::fabrication::test
