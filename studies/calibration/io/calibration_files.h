#pragma once

// Output documents and tables of a calibration.

#include <string>

#include "studies/calibration/correction.h"
#include "studies/calibration/test_cuts.h"

namespace retrace::studies {

std::string calibration_json(const Calibration& result);
std::string calibration_table(const Calibration& result);
/// Returns the measurements with their residuals in standard uncertainties, as CSV.
std::string residuals_csv(const Calibration& result);

std::string correction_json(const Correction& result);
std::string correction_table(const Correction& result);

/// Returns a table without values, into which the user enters the measurements of the test cuts.
std::string test_cuts_csv(const TestCuts& cuts);
std::string test_cuts_json(const TestCuts& cuts);
std::string test_cuts_table(const TestCuts& cuts);

}  // namespace retrace::studies
