#pragma once

// Jobs with four prisms of 0.5 mm in a checker arrangement, two of which are rotated, and their NC programs.

#include <fmt/format.h>

#include <random>
#include <string>
#include <vector>

#include "fabrication/machine/setup.h"
#include "fabrication/post/post.h"
#include "fabrication/read/nc_program.h"
#include "studies/fabrication/fabricate.h"

namespace retrace::test {

struct PrismJob {
  double apex_angle_deg = 90.0;
  double gap_mm = 0.0;  ///< gap between the prisms
  double finishing_depth_um = 5.0;
  int finishing_cuts = 2;
};

inline std::string prism_job(const PrismJob& job = {}) {
  return fmt::format(R"(schema = "retrace.job/1"
title = "Four prisms"
design = "design.toml"
machine = "ideal"
strategy = "two-step"
[element]
kind = "rtp"
base_mm = 0.5
width_mm = 0.5
apex_angle_deg = {0}
[array]
arrangement = "checker"
x_length_mm = {1}
y_length_mm = {1}
x_gap_mm = {2}
y_gap_mm = {2}
[tool]
width_mm = 0.5
[process]
name = "test"
source = "a test"
clearance_mm = 0.2
roughing_depth_um = 50
finishing_depth_um = {3}
finishing_cuts = {4}
plough_length_mm = 0.1
roughing_feed_mm_per_min = 50
finishing_feed_mm_per_min = 20
retract_feed_mm_per_min = 200
)",
                     job.apex_angle_deg, 1.0 + job.gap_mm, job.gap_mm, job.finishing_depth_um, job.finishing_cuts);
}

inline studies::FabricationResult planned(const std::string& job) {
  FabricationRequest request;
  request.job_text = job;
  return studies::fabricate("job.toml", request);
}

inline std::vector<fabrication::NcProgram> programs_of(const studies::FabricationResult& made) {
  std::vector<fabrication::NcProgram> programs;
  for (const fabrication::Program& program : made.plan.programs)
    programs.push_back(
        fabrication::parse_nc(fabrication::nc_text(program, made.dialect), "p.ngc", fabrication::NcDialect::rs274ngc));
  return programs;
}

/// Returns random errors of a machine for all quantities that the set-up leaves uncertain. The errors are up to 1 um
/// and up to 0.02 degrees. With larger errors, roughing cuts would be deeper than the finished surface.
template <class Bits>
std::vector<double> hidden_errors(Bits& bits) {
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::vector<double> errors;
  for (const fabrication::SetupQuantity& quantity : fabrication::setup_quantities(fabrication::Tilt::table))
    errors.push_back((quantity.is_angle() ? 72.0 : 1.0) * uniform(bits));
  return errors;
}

}  // namespace retrace::test
