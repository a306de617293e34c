#pragma once

#include "report/surface_plot.h"
#include "studies/closed_loop/error_map.h"

namespace retrace::report {

/// The array from above, coloured by what programs leave over its facets.
SurfacePlot error_map_plot(const studies::ErrorMap& map);

}  // namespace retrace::report
