#pragma once

#include "report/map_plot.h"
#include "report/path_plot.h"
#include "studies/fabrication/fabricate.h"

namespace retrace::report {

/// The way of the tool through one element, roughing or finishing.
PathPlot tool_path_plot(const studies::FabricationResult& result, bool roughing);

/// Which elements are cut where, coloured by the order in which they are visited. Of large arrays neighbours in a row
/// are drawn as one.
MapPlot arrangement_plot(const studies::FabricationResult& result);

}  // namespace retrace::report
