#pragma once

#include <array>
#include <cstdint>

namespace retrace::raytrace {

/// Owen-scrambled Sobol points in the unit square: any 2^k consecutive aligned points are stratified, and each scramble
/// (each seed) is an independent unbiased estimator. Sobol 1967; hashed nested uniform scrambling after Laine and Karras
/// 2011, Burley 2020 (JCGT 9, 4).
class SobolSquare {
 public:
  SobolSquare(std::uint32_t seed_x, std::uint32_t seed_y) : seed_x_(seed_x), seed_y_(seed_y) {}

  /// Point `index` of the sequence, each coordinate in [0, 1).
  std::array<double, 2> operator()(std::uint32_t index) const {
    return {scrambled(reversed(index), seed_x_), scrambled(second_dimension(index), seed_y_)};
  }

 private:
  static constexpr std::uint32_t reversed(std::uint32_t v) {
    v = (v >> 16) | (v << 16);
    v = ((v & 0x00ff00ffU) << 8) | ((v >> 8) & 0x00ff00ffU);
    v = ((v & 0x0f0f0f0fU) << 4) | ((v >> 4) & 0x0f0f0f0fU);
    v = ((v & 0x33333333U) << 2) | ((v >> 2) & 0x33333333U);
    return ((v & 0x55555555U) << 1) | ((v >> 1) & 0x55555555U);
  }

  // Direction numbers of the second Sobol dimension: columns of the Pascal matrix modulo 2.
  static constexpr std::uint32_t second_dimension(std::uint32_t index) {
    std::uint32_t result = 0;
    for (std::uint32_t direction = 1U << 31; index != 0; index >>= 1, direction ^= direction >> 1)
      if ((index & 1U) != 0) result ^= direction;
    return result;
  }

  // Every bit is flipped by a hash of the bits above it: even multipliers carry upwards only, hence the reversals.
  static double scrambled(std::uint32_t v, std::uint32_t seed) {
    std::uint32_t x = reversed(v);
    x ^= x * 0x3d20adeaU;
    x += seed;
    x *= (seed >> 16) | 1U;
    x ^= x * 0x05526c56U;
    x ^= x * 0x53a22864U;
    return static_cast<double>(reversed(x)) * 0x1p-32;
  }

  std::uint32_t seed_x_;
  std::uint32_t seed_y_;
};

}  // namespace retrace::raytrace
