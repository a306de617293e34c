#pragma once

// Test cuts: few prisms in few poses, and which figures of them tell how a machine is set up.

#include <cstddef>
#include <string>
#include <vector>

#include "studies/calibration/calibration.h"
#include "studies/fabrication/job_maker.h"

namespace retrace::studies {

/// What the test cuts will say of a quantity of the set-up.
struct PlannedQuantity {
  const fabrication::SetupQuantity* quantity = nullptr;
  bool is_told = false;
  double uncertainty = 0.0;        ///< standard, um or arcsec
  std::vector<std::size_t> needs;  ///< parts without any one of which it is not told
};

struct TestCuts {
  std::vector<MadeJob> jobs;                ///< by MeasuredParts::jobs
  MeasuredParts parts;                      ///< what is to be measured, without values
  std::vector<PlannedQuantity> quantities;  ///< as setup_quantities()
  std::vector<std::string> untold;          ///< combinations that no figure tells
};

/// Jobs of four prisms each, two of them turned, of apex angles that the tool can cut: A stands at half of each, C at
/// 0, 90, 180 and 270. Figures are chosen one after the other, always the one that tells most of what is not known yet,
/// until all that any of them tell is known half as well as by all of them together, and each is checked by others.
/// \throw InputError for designs without prisms and requests that cannot be cut
TestCuts plan_test_cuts(const Design& design, const JobRequest& request);

}  // namespace retrace::studies
