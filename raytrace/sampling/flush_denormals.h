#pragma once

// Makes the processor flush denormal numbers during a task, as Embree recommends.

#include <pmmintrin.h>
#include <xmmintrin.h>

namespace retrace::raytrace {

/// Makes the processor flush denormal numbers to 0 during the lifetime of the object, as Embree recommends. Each task
/// creates one object at its beginning, so that all tasks compute with the same rounding.
class FlushDenormals {
 public:
  FlushDenormals() : saved_(_mm_getcsr()) { _mm_setcsr(saved_ | _MM_FLUSH_ZERO_ON | _MM_DENORMALS_ZERO_ON); }
  ~FlushDenormals() { _mm_setcsr(saved_); }
  FlushDenormals(const FlushDenormals&) = delete;
  FlushDenormals& operator=(const FlushDenormals&) = delete;

 private:
  unsigned saved_;
};

}  // namespace retrace::raytrace
