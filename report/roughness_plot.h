#pragma once

#include "report/plot.h"
#include "studies/roughness/roughness.h"

namespace retrace::report {

/// RRE over the Sa of the roughness: a curve for each correlation length, and measured facets as points.
LinePlot roughness_plot(const studies::RoughnessResult& result);

}  // namespace retrace::report
