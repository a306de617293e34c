#pragma once

#include <array>
#include <cstdint>

namespace retrace::raytrace {

/// Owen-scrambled Sobol points in the unit square: any 2^k consecutive aligned points are stratified, and each scramble
/// (each pair of keys) is an independent unbiased estimator whose errors are nearly normal (Sobol 1967; Owen 1995; Loh
/// 2003). The scramble is the full nested one: every digit is flipped by a hash of the digits above it. Cheaper affine
/// or few-bit scrambles have heavy tails, and 32 replicates then claim errors that are too small.
class SobolSquare {
 public:
  SobolSquare(std::uint64_t key_x, std::uint64_t key_y) : key_x_(key_x), key_y_(key_y) {}

  /// Point `index` of the sequence, each coordinate in [0, 1).
  std::array<double, 2> operator()(std::uint32_t index) const {
    return {scrambled(reversed(index), key_x_), scrambled(second_dimension(index), key_y_)};
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

  /// A well-mixed bit of (key, node): the finaliser of SplitMix64 (Steele, Lea, Flood 2014).
  static constexpr std::uint32_t flip(std::uint64_t key, std::uint32_t node) {
    std::uint64_t z = key + 0x9e3779b97f4a7c15U * node;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
    return static_cast<std::uint32_t>(z >> 63);
  }

  static constexpr double scrambled(std::uint32_t digits, std::uint64_t key) {
    std::uint32_t flips = 0;
    std::uint32_t node = 1;  // the digits above, after a leading 1
    for (int level = 31; level >= 0; --level) {
      flips |= flip(key, node) << level;
      node = (node << 1) | ((digits >> level) & 1U);
    }
    return static_cast<double>(digits ^ flips) * 0x1p-32;
  }

  std::uint64_t key_x_;
  std::uint64_t key_y_;
};

}  // namespace retrace::raytrace
