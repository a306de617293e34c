#pragma once

// Settings for running long computations: progress reports, cancellation and number of threads.

#include "core/error.h"
#include "core/progress.h"

namespace retrace {

/// Settings for running a computation. They do not change its result.
struct Running {
  Progress* progress = nullptr;  ///< receives the finished fraction; if null, progress is not reported
  /// Request to stop, which is checked regularly; if null, the computation cannot be stopped.
  const Cancellation* cancellation = nullptr;
  unsigned threads = 0;  ///< maximum number of threads; 0 means the number of cores
};

/// Returns the version of the loaded library, such as "0.1.0".
RETRACE_API const char* version();

}  // namespace retrace
