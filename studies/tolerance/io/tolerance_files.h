#pragma once

// Output documents and tables of `retrace tolerance`.

#include <string>

#include "studies/tolerance/tolerance.h"

namespace retrace::studies {

/// Returns the result as a document of the format `retrace.tolerance/2`.
/// \param swept computed points, with their warnings
std::string tolerance_json(const SweepResult& swept, const ToleranceRequest& request, const ToleranceResult& result);

/// Returns the spreads, yields and main contributors for the terminal.
std::string tolerance_text(const Study& study, const ToleranceRequest& request, const ToleranceResult& result);

/// Returns one line about the finished parts. It contains the yield or, if the study has no limits, the mean of the
/// first quantity.
std::string so_far_text(const ToleranceResult& result, const ToleranceRequest& request);

}  // namespace retrace::studies
