#pragma once

#include "report/surface_plot.h"
#include "studies/metrology/metrology.h"

namespace retrace::report {

/// A measured surface less its form, its roughness, its waviness and its power spectral densities.
SurfacePlot metrology_plot(const studies::MetrologyResult& result);

}  // namespace retrace::report
