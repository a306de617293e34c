#pragma once

// Test cuts: a few prisms in a few poses, and the measurements of them that determine the set-up of a machine.

#include <cstddef>
#include <string>
#include <vector>

#include "studies/calibration/calibration.h"
#include "studies/fabrication/job_maker.h"

namespace retrace::studies {

/// Expected result of the test cuts for a quantity of the set-up.
struct PlannedQuantity {
  const fabrication::SetupQuantity* quantity = nullptr;
  bool is_observable = false;
  double uncertainty = 0.0;        ///< expected standard uncertainty, um or arcsec
  std::vector<std::size_t> needs;  ///< parts that are needed: if one of them is missing, the quantity is unobservable
};

struct TestCuts {
  std::vector<GeneratedJob> jobs;           ///< jobs, in the order of MeasuredParts::jobs
  MeasuredParts parts;                      ///< measurements to be made, without values
  std::vector<PlannedQuantity> quantities;  ///< quantities, in the order of setup_quantities()
  std::vector<std::string> unobservable;    ///< unobservable combinations, as text
};

/// Plans the test cuts. Each job has four prisms, two of them rotated, and an apex angle that the tool can cut. Axis A
/// is at half of the apex angle, and C at 0, 90, 180 and 270 degrees. Measurements are chosen one by one, each time the
/// one that reduces the uncertainty most. The choice ends when each observable quantity has at most three times the
/// uncertainty that all possible measurements would give, and each measurement is checked by others.
/// \throw InputError for designs without prisms and requests that cannot be cut
TestCuts plan_test_cuts(const design::Design& design, const JobRequest& request);

}  // namespace retrace::studies
