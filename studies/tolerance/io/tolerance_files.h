#pragma once

// Documents and tables of `retrace tolerance`.

#include <string>

#include "studies/tolerance/tolerance.h"

namespace retrace::studies {

/// The result as a `retrace.tolerance/1` document. \param swept what the points came to, with warnings
std::string tolerance_json(const SweepResult& swept, const ToleranceRequest& request, const ToleranceResult& result);

/// Spreads, yields and main contributors, for the terminal.
std::string tolerance_text(const Study& study, const ToleranceRequest& request, const ToleranceResult& result);

}  // namespace retrace::studies
