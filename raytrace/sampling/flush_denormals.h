#pragma once

// Sets the processor to flush denormal numbers within a task, as Embree asks for.

#include <pmmintrin.h>
#include <xmmintrin.h>

namespace retrace::raytrace {

/// Embree wants denormals flushed; done here for a whole task so that every task computes alike.
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
