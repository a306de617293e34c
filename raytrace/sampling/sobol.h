#pragma once

// Owen-scrambled Sobol points in the unit square, which are low-discrepancy entry points.

#include <array>
#include <cstdint>

namespace retrace::raytrace {

/// Number of digits in a block of a nested scramble, and number of blocks. The blocks contain the upper 25 of 32
/// digits. One hash gives the random bits of a block. Points in an aligned range of 2^25 consecutive points differ in
/// their upper 25 digits. One hash is therefore sufficient for all digits below the blocks.
inline constexpr int kScrambleLevels = 5;
inline constexpr int kScrambleBlocks = 5;
inline constexpr int kScrambleRest = 32 - kScrambleLevels * kScrambleBlocks;

/// Returns random bits for (key, node), with a 32-bit mixer of three multiplications (C. Wellons, "triple32").
constexpr std::uint32_t scramble_hash(std::uint64_t key, std::uint32_t node) {
  std::uint32_t x = node * 0x9e3779b9U + static_cast<std::uint32_t>(key);
  x = (x ^ (x >> 17)) * 0xed5ad4bbU + static_cast<std::uint32_t>(key >> 32);
  x = (x ^ (x >> 11)) * 0xac4c1b51U;
  x = (x ^ (x >> 15)) * 0x31848babU;
  return x ^ (x >> 14);
}

/// Returns the bits that a nested scramble flips in a number of 32 digits.
constexpr std::uint32_t nested_flips(std::uint32_t digits, std::uint64_t key) {
  std::uint32_t flips = 0;
  std::uint32_t node = 1;  // a leading 1, followed by the digits above this block
  for (int block = 0; block < kScrambleBlocks; ++block) {
    const std::uint32_t hash = scramble_hash(key, node);
    std::uint32_t below = 1;  // a leading 1, followed by the digits of this block
    for (int level = 0; level < kScrambleLevels; ++level) {
      flips = (flips << 1) | ((hash >> below) & 1U);
      below = (below << 1) | (digits >> 31);
      digits <<= 1;
    }
    node = (node << kScrambleLevels) | (below & ((1U << kScrambleLevels) - 1U));
  }
  return (flips << kScrambleRest) | (scramble_hash(key, node) >> (32 - kScrambleRest));
}

/// Owen-scrambled Sobol points in the unit square. Any 2^k consecutive points are stratified if the index of the first
/// one is a multiple of 2^k. Each scramble, given by a pair of keys, is an independent unbiased estimator with nearly
/// normal errors (Sobol 1967; Owen 1995; Loh 2003).
///
/// The scramble is nested: every digit is flipped by a random bit that depends on the digits above it. Affine scrambles
/// and scrambles of few bits take less time. Their errors have heavy tails, so that standard errors from 32 replicates
/// would be too small.
class SobolSquare {
 public:
  SobolSquare(std::uint64_t key_x, std::uint64_t key_y) : key_x_(key_x), key_y_(key_y) {}

  /// Returns the point with the number `index`, with coordinates in [0, 1).
  std::array<double, 2> operator()(std::uint32_t index) const {
    const auto [x, y] = digits(index);
    return {scrambled(x, key_x_), scrambled(y, key_y_)};
  }

  /// Returns the coordinates before the scramble, as binary digits.
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
