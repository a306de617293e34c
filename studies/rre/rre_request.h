#pragma once

// Conversion of a user's RRE request into the settings of the RRE study.

#include "requests/rre.h"
#include "studies/rre/rre.h"

namespace retrace::studies {

/// Checks a request and returns its settings.
/// \throw InputError at the first field whose value is not allowed
RreSettings resolve(const RreRequest& request);

}  // namespace retrace::studies
