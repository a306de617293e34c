#pragma once

#include "report/plot.h"
#include "report/polar_plot.h"
#include "studies/photometry/photometry.h"

namespace retrace::report {

/// R_A around the return for every map of a result, with the test points on it.
PolarPlot far_field_plot(const studies::PhotometryResult& result);

/// R_A over the observation angle, one curve for each entrance angle.
LinePlot observation_plot(const studies::PhotometryResult& result);

}  // namespace retrace::report
