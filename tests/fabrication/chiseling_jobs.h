#pragma once

// Small jobs of cube corners for tests.

#include <string>
#include <vector>

#include "tests/fabrication/jobs.h"

namespace retrace::fabrication::test {

/// Returns a job of 3 x 3 cube corners with a suitable tool: three columns of three triangles or of three hexagons. The
/// outer two columns of hexagons have a fourth cell, which the pattern excludes.
inline Job cube_job(bool is_hexagonal, double aperture_mm = 0.3) {
  Job job;
  const double radius_mm = 0.5 * aperture_mm;
  const double row_mm = 0.8660254037844386 * radius_mm;
  if (is_hexagonal) {
    job.element = geometry::HexagonalCube{aperture_mm, {}};
    job.array.arrangement = geometry::Arrangement::honeycomb;
    job.array.x_length_mm = 5.01 * radius_mm;
    job.array.y_length_mm = 8.01 * row_mm;
    job.array.pattern = {"--", "#", "##", "#", "##", "#", "##"};
    job.tool.width_mm = 1.4 * aperture_mm;
  } else {
    job.element = geometry::TriangularCube{aperture_mm, {}};
    job.array.arrangement = geometry::Arrangement::triangular;
    job.array.x_length_mm = 5.01 * radius_mm;
    job.array.y_length_mm = 4.01 * row_mm;
    job.tool.width_mm = 0.6 * aperture_mm;
  }
  job.strategy = Strategy::dmc;
  job.machine = "ideal-dmc";
  job.tool.wedge_deg = kDmcWedgeDeg;
  job.process = thesis_process();
  job.process.roughing_depth_um = 10.0;
  job.process.finishing_cuts = 1;
  return job;
}

/// Job and machine of a test case, and its name in messages.
struct StrategyCase {
  std::string name;
  Job job;
  std::string machine;
};

/// Returns a job of 2 x 2 prisms for each strategy for prisms, and a job of hexagonal cube corners.
/// \param change function that changes each job of prisms
template <class Change>
std::vector<StrategyCase> strategy_cases(const Change& change) {
  std::vector<StrategyCase> cases;
  for (const auto strategy : {Strategy::unidirectional, Strategy::bidirectional, Strategy::two_step}) {
    Job job = square_job(2, geometry::Arrangement::checker);
    job.strategy = strategy;
    job.process.roughing_depth_um = 40;
    change(job);
    cases.push_back({std::string(kStrategyWords[static_cast<std::size_t>(strategy)]), job, "paper"});
  }
  Job cubes = cube_job(true, 0.15);
  cubes.process.roughing_depth_um = 20;
  cases.push_back({"dmc", cubes, "ideal-dmc"});
  return cases;
}

}  // namespace retrace::fabrication::test
