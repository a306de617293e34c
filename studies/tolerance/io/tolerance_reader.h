#pragma once

// Reads what a study file asks of a tolerance analysis.

#include "studies/tolerance/tolerance.h"

namespace retrace::studies {

/// What [tolerance] and [[constraint]] of a study ask; without that table, the defaults. Parameters must have
/// distributions. \throw InputError
ToleranceRequest read_tolerance(const Study& study);

}  // namespace retrace::studies
