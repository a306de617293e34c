#pragma once

// Owen-scrambled Sobol points in the unit square: the low-discrepancy sample of entry points.

#include <array>
#include <cstdint>

namespace retrace::raytrace {

/// Digits of a nested scramble: in kScrambleBlocks blocks of kScrambleLevels each, whose flips are the bits of one
/// hash; no two of 2^25 aligned points share all of these digits, so one hash serves all the digits below.
inline constexpr int kScrambleLevels = 5;
inline constexpr int kScrambleBlocks = 5;
inline constexpr int kScrambleRest = 32 - kScrambleLevels * kScrambleBlocks;

/// Random bits of (key, node): a mixer of 32 bits with three multiplications (C. Wellons, "triple32").
constexpr std::uint32_t scramble_hash(std::uint64_t key, std::uint32_t node) {
  std::uint32_t x = node * 0x9e3779b9U + static_cast<std::uint32_t>(key);
  x = (x ^ (x >> 17)) * 0xed5ad4bbU + static_cast<std::uint32_t>(key >> 32);
  x = (x ^ (x >> 11)) * 0xac4c1b51U;
  x = (x ^ (x >> 15)) * 0x31848babU;
  return x ^ (x >> 14);
}

/// What a nested scramble flips of a number's 32 digits.
constexpr std::uint32_t nested_flips(std::uint32_t digits, std::uint64_t key) {
  std::uint32_t flips = 0;
  std::uint32_t node = 1;  // the digits above, after a leading 1
  for (int block = 0; block < kScrambleBlocks; ++block) {
    const std::uint32_t hash = scramble_hash(key, node);
    std::uint32_t below = 1;  // the digits of this block, after a leading 1
    for (int level = 0; level < kScrambleLevels; ++level) {
      flips = (flips << 1) | ((hash >> below) & 1U);
      below = (below << 1) | (digits >> 31);
      digits <<= 1;
    }
    node = (node << kScrambleLevels) | (below & ((1U << kScrambleLevels) - 1U));
  }
  return (flips << kScrambleRest) | (scramble_hash(key, node) >> (32 - kScrambleRest));
}

/// Owen-scrambled Sobol points in the unit square: any 2^k consecutive aligned points are stratified, and each scramble
/// (each pair of keys) is an independent unbiased estimator whose errors are nearly normal (Sobol 1967; Owen 1995; Loh
/// 2003). The scramble is the nested one: every digit is flipped by a random bit of the digits above it. Cheaper affine
/// or few-bit scrambles have heavy tails, and 32 replicates then claim errors that are too small.
class SobolSquare {
 public:
  SobolSquare(std::uint64_t key_x, std::uint64_t key_y) : key_x_(key_x), key_y_(key_y) {}

  /// Point `index` of the sequence, each coordinate in [0, 1).
  std::array<double, 2> operator()(std::uint32_t index) const {
    const auto [x, y] = digits(index);
    return {scrambled(x, key_x_), scrambled(y, key_y_)};
  }

  /// The two coordinates before the scramble, as binary digits.
  static constexpr std::array<std::uint32_t, 2> digits(std::uint32_t index) {
    return {reversed(index), second_dimension(index)};
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

  static constexpr double scrambled(std::uint32_t digits, std::uint64_t key) {
    return static_cast<double>(digits ^ nested_flips(digits, key)) * 0x1p-32;
  }

  std::uint64_t key_x_;
  std::uint64_t key_y_;
};

}  // namespace retrace::raytrace
