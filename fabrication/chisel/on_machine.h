#pragma once

// What a job asks of the machine that cuts it, for those who plan it and those who judge its programs.

#include "fabrication/job/job.h"
#include "fabrication/machine/machine.h"

namespace retrace::fabrication {

/// Whether a job's strategy has finishing cuts.
bool has_finishing_cuts(const Job& job);

/// \throw InputError naming file, line and key: another axis must tilt, a feed is above those of the machine's axes,
/// finishing cuts would be deeper than roughing, or a depth of cut is little beside the increments of the control
void check_on_machine(const Job& job, const Machine& machine);

}  // namespace retrace::fabrication
