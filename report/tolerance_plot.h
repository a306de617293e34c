#pragma once

#include "report/plot.h"
#include "studies/tolerance/tolerance.h"

namespace retrace::report {

/// The share of parts below a value of the study's first quantity, with its nominal value and the limits on it.
LinePlot tolerance_plot(const studies::Study& study, const studies::ToleranceRequest& request,
                        const studies::ToleranceResult& result);

}  // namespace retrace::report
