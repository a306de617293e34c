#pragma once

// The random numbers of one scatter event, from counters, for models that sample by rejection.

#include <cstdint>

#include "core/random.h"

namespace retrace::surface_models {

/// As many uniform numbers as one event asks for, from the counters that name it. Rejection needs an unknown number of
/// them; in return every sample has the weight that the model gives it, mostly 1. Independent for different (a, b, c).
class RandomStream {
 public:
  RandomStream(RandomKey key, std::uint32_t a, std::uint32_t b, std::uint32_t c) : key_(key), a_(a), b_(b), c_(c) {}

  /// The next number, in [0, 1).
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
