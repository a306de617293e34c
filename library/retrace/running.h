#pragma once

// How long work is watched, stopped and spread over cores.

#include "core/error.h"
#include "core/progress.h"

namespace retrace {

/// How work is done. What comes out does not depend on it.
struct Running {
  Progress* progress = nullptr;                ///< told how far it has come
  const Cancellation* cancellation = nullptr;  ///< asked whether to stop
  unsigned threads = 0;                        ///< at most; 0: as many as there are cores
};

/// Of the library that runs, such as "0.1.0".
RETRACE_API const char* version();

}  // namespace retrace
