#pragma once

// Small jobs on bases for tests.

#include <memory>
#include <string>
#include <vector>

#include "geometry/formula.h"
#include "tests/fabrication/chiseling_jobs.h"

namespace retrace::fabrication::test {

using geometry::Base;
using geometry::Standing;

inline Base plane_base(double incline_deg, double azimuth_deg, geometry::Standing standing) {
  return {geometry::PlaneBase{incline_deg, azimuth_deg}, standing};
}
inline Base cylinder_base(double radius_mm, bool axis_is_x, geometry::Standing standing) {
  return {geometry::CylinderBase{radius_mm, axis_is_x}, standing};
}
inline Base sphere_base(double radius_mm, geometry::Standing standing) {
  return {geometry::SphereBase{radius_mm}, standing};
}
inline Base formula_base(const std::string& text, geometry::Standing standing) {
  return {geometry::FormulaBase{std::make_shared<const geometry::Formula>(text)}, standing};
}

/// n x n prisms side by side on a base, with room for elements that lean.
inline Job prisms_on(const Base& base, int n = 3, geometry::Arrangement arrangement = geometry::Arrangement::aligned) {
  Job job = square_job(n, arrangement);
  job.array.x_length_mm = job.array.y_length_mm = 0.451 * n;
  job.process.roughing_depth_um = 30.0;
  job.base = base;
  return job;
}

/// Cube corners on a base, by a tool with room for blanks that stand over the rims.
inline Job cubes_on(const Base& base, bool is_hexagonal, double aperture_mm = 0.15) {
  Job job = cube_job(is_hexagonal, aperture_mm);
  job.array.pattern.clear();
  job.array.x_length_mm *= 1.02;
  job.array.y_length_mm *= 1.02;
  job.tool.width_mm = 6.0 * aperture_mm;
  job.base = base;
  return job;
}

}  // namespace retrace::fabrication::test
