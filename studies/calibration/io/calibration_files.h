#pragma once

// The documents of a calibration.

#include <string>

#include "studies/calibration/correction.h"
#include "studies/calibration/test_cuts.h"

namespace retrace::studies {

std::string calibration_json(const Calibration& result);
std::string calibration_table(const Calibration& result);
/// What was measured with what is left of it, in standard uncertainties.
std::string residuals_csv(const Calibration& result);

std::string correction_json(const Correction& result);
std::string correction_table(const Correction& result);

/// The table to be filled in with what is measured of test cuts.
std::string test_cuts_csv(const TestCuts& cuts);
std::string test_cuts_json(const TestCuts& cuts);
std::string test_cuts_table(const TestCuts& cuts);

}  // namespace retrace::studies
