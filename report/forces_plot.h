#pragma once

#include "report/plot.h"
#include "studies/forces/forces_study.h"

namespace retrace::report {

/// Forces on the tool against time, one curve an axis of the machine.
LinePlot forces_plot(const studies::ForcesResult& result);

}  // namespace retrace::report
