#pragma once

#include <string>
#include <utility>
#include <vector>

#include "studies/photometry/io/limits_reader.h"
#include "studies/photometry/photometry.h"
#include "studies/photometry/standards.h"
#include "tests/support/designs.h"

// Designs and requests for tests of photometry.

namespace retrace::studies::photometric_requests {

inline LimitTable shipped() {
  return read_limits(std::string(RETRACE_SOURCE_DIR) + "/data/photometry_limits.csv");
}

inline TestPlan r150(const std::string& part_class, const std::string& colour) {
  return test_plan_of(shipped(), "UN R3 / R150", part_class, colour);
}

inline design::Design design_of(const geometry::PartSpec& part, bool is_ideal = false) {
  design::Design design;
  design.part() = part;
  design.substance.refractive_index = retrace::testing::kPmma;
  design.idealisation = {is_ideal, is_ideal};
  return design;
}

inline geometry::PartSpec honeycomb(double error_arcmin = 0.0, double aperture_mm = 1.0) {
  geometry::PartSpec spec =
      retrace::testing::infinite(geometry::HexagonalCube{aperture_mm}, geometry::Arrangement::honeycomb, 1.0);
  spec.angle_errors.dihedral_error_arcmin.fill(error_arcmin);
  return spec;
}

/// Returns a test plan with one limit of R_A for each observation angle, at normal incidence.
inline TestPlan points_at(const std::vector<double>& observation_deg, double minimum_r_a) {
  TestPlan programme;
  for (const double a : observation_deg)
    programme.points.push_back(
        {a, 0.0, 0.0, minimum_r_a, PhotometricUnit::cd_per_lx_per_m2, LimitStatus::confirmed, 2});
  return programme;
}

/// Returns a request with the design's own light, without diffraction.
inline PhotometrySettings request_of(TestPlan programme) {
  PhotometrySettings request;
  request.test_plan = std::move(programme);
  request.area_cm2 = 10.0;
  request.apertures = default_apertures();
  request.light = PhotometricLight::of_design;
  request.diffraction = false;
  request.advice = false;
  return request;
}

inline PhotometryResult run(const design::Design& design, const PhotometrySettings& request) {
  return PhotometryStudy(design, request).run();
}

}  // namespace retrace::studies::photometric_requests
