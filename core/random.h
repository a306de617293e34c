#pragma once

// Random numbers that depend only on a key and a counter, so that results do not depend on the number of threads.

#include <Random123/philox.h>

#include <cstdint>

namespace retrace {

/// Key of counter-based random numbers (Philox4x32-10, Salmon et al. 2011). A number depends only on the key and the
/// counter, so threads may draw numbers in any order.
struct RandomKey {
  std::uint32_t seed = 0;
  std::uint32_t stream = 0;
};

/// Returns four independent 32-bit words for the counter (a, b, c, d).
inline r123::Philox4x32::ctr_type philox(RandomKey key, std::uint32_t a, std::uint32_t b, std::uint32_t c = 0,
                                         std::uint32_t d = 0) {
  return r123::Philox4x32()({{a, b, c, d}}, {{key.seed, key.stream}});
}

/// Converts a random word to a number with uniform distribution in [0, 1): 0, 2^-32, ..., 1 - 2^-32.
inline double unit_interval(std::uint32_t word) {
  return static_cast<double>(word) * 0x1p-32;
}

}  // namespace retrace
