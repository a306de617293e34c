#pragma once

// Random numbers for one scatter event, generated from counters. For models that sample by rejection.

#include <cstdint>

#include "core/random.h"

namespace retrace::surface_models {

/// Stream of uniform random numbers for one event, which is identified by counters. Rejection sampling needs a variable
/// number of random numbers; its advantage is that most samples have the weight 1. Streams with different (a, b, c) are
/// independent.
class RandomStream {
 public:
  RandomStream(RandomKey key, std::uint32_t a, std::uint32_t b, std::uint32_t c) : key_(key), a_(a), b_(b), c_(c) {}

  /// Returns the next number, in [0, 1).
  double next() {
    if (used_ % 4 == 0) words_ = philox(key_, a_, b_, c_, used_ / 4);
    return unit_interval(words_[used_++ % 4]);
  }

 private:
  RandomKey key_;
  std::uint32_t a_, b_, c_;
  std::uint32_t used_ = 0;
  r123::Philox4x32::ctr_type words_{};
};

}  // namespace retrace::surface_models
