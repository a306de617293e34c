#pragma once

#include <cstddef>

#include "report/map_plot.h"
#include "studies/rre/rre.h"

namespace retrace::report {

/// More directions than this are not drawn.
inline constexpr std::size_t kMostFootprintPanels = 24;

/// The active regions of the entrance face, one panel a direction, coloured by their efficiency in percent.
/// \pre a footprint was asked for
MapPlot footprint_plot(const studies::RreResult& result);

}  // namespace retrace::report
