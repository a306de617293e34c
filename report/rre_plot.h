#pragma once

#include "report/plot.h"
#include "studies/rre/rre.h"

namespace retrace::report {

/// RRE in percent against the incidence angle, one curve a design, azimuth and acceptance cone. With a single incidence
/// angle the axis is the azimuth, with a single direction the acceptance half angle.
LinePlot rre_plot(const studies::RreResult& result);

}  // namespace retrace::report
