#pragma once

// Converts the request that users write into the settings of the RRE study.

#include "requests/rre.h"
#include "studies/rre/rre.h"

namespace retrace::studies {

/// Checks a request and returns its settings.
/// \throw InputError at the first field that is not allowed
RreSettings resolve(const RreRequest& request);

}  // namespace retrace::studies
