#pragma once

// Reads the request for a tolerance analysis from a study file.

#include "studies/tolerance/tolerance.h"

namespace retrace::studies {

/// Reads the tables [tolerance] and [[constraint]] of a study. Without [tolerance], defaults apply. Parameters must
/// have distributions.
/// \throw InputError for invalid keys
ToleranceRequest read_tolerance(const Study& study);

}  // namespace retrace::studies
