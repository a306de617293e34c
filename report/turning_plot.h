#pragma once

#include "report/image_plot.h"
#include "report/plot.h"
#include "studies/turning/turn.h"

namespace retrace::report {

/// Acceleration of Z over two turns round its largest jump.
LinePlot turning_acceleration_plot(const studies::TurningResult& result);

/// Deviation from the design across a few cuts.
LinePlot turning_profile_plot(const studies::TurningResult& result);

/// The surface's height, and the size of what the programs leave on it.
ImagePlot turning_maps(const studies::TurningResult& result);

}  // namespace retrace::report
