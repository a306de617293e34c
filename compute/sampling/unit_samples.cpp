#include "compute/sampling/unit_samples.h"

#include <boost/random/sobol.hpp>
#include <numeric>
#include <utility>

#include "core/random.h"

namespace retrace::compute {
namespace {

/// Identifiers of random-number streams. No other file uses them.
constexpr std::uint32_t kScramble = 0x53776501U;
constexpr std::uint32_t kShuffle = 0x53776502U;
constexpr std::uint32_t kJitter = 0x53776503U;
constexpr std::uint32_t kIndependent = 0x53776504U;

std::uint32_t reversed(std::uint32_t v) {
  v = (v >> 16) | (v << 16);
  v = ((v & 0x00ff00ffU) << 8) | ((v >> 8) & 0x00ff00ffU);
  v = ((v & 0x0f0f0f0fU) << 4) | ((v >> 4) & 0x0f0f0f0fU);
  v = ((v & 0x33333333U) << 2) | ((v >> 2) & 0x33333333U);
  return ((v & 0x55555555U) << 1) | ((v >> 1) & 0x55555555U);
}

/// Applies a nested uniform scramble: each bit is flipped depending on a hash of the bits above it. The constants are
/// from Burley, J. Comp. Graphics Techniques 9, 2020.
std::uint32_t scrambled(std::uint32_t digits, std::uint32_t key) {
  std::uint32_t v = reversed(digits);
  v ^= v * 0x3d20adeaU;
  v += key;
  v *= (key >> 16) | 1U;
  v ^= v * 0x05526c56U;
  v ^= v * 0x53a22864U;
  return reversed(v);
}

/// Divides the unit interval into 2^32 equal intervals and returns the centre of interval number `word`. The centre is
/// never 0 or 1, where quantile functions can be infinite.
double middle(std::uint32_t word) {
  return (static_cast<double>(word) + 0.5) * 0x1p-32;
}

}  // namespace

UnitSamples::UnitSamples(Kind kind, std::size_t dimensions, std::uint64_t count, std::uint32_t seed)
    : kind_(kind), dimensions_(dimensions), count_(count), seed_(seed) {
  if (kind != Kind::latin_hypercube) return;
  for (std::size_t axis = 0; axis < dimensions; ++axis) {
    std::vector<std::uint32_t> order(count);
    std::iota(order.begin(), order.end(), 0U);
    for (std::uint64_t k = count; k-- > 1;) {
      const auto words = philox({seed, kShuffle}, static_cast<std::uint32_t>(k), static_cast<std::uint32_t>(axis));
      const std::uint64_t other = (static_cast<std::uint64_t>(words[0]) << 32 | words[1]) % (k + 1);
      std::swap(order[k], order[other]);
    }
    permutations_.push_back(std::move(order));
  }
}

std::vector<double> UnitSamples::at(std::uint64_t point) const {
  switch (kind_) {
    case Kind::sobol: return sobol(point);
    case Kind::latin_hypercube: return latin_hypercube(point);
    case Kind::monte_carlo: break;
  }
  return monte_carlo(point);
}

std::vector<double> UnitSamples::sobol(std::uint64_t point) const {
  std::vector<double> coordinates(dimensions_);
  boost::random::sobol engine(dimensions_);
  // The Sobol engine of Boost omits the first point of the sequence, the origin.
  if (point > 0) engine.discard((point - 1) * dimensions_);
  for (std::size_t axis = 0; axis < dimensions_; ++axis) {
    const auto digits = point > 0 ? static_cast<std::uint32_t>(engine() >> 32) : 0U;
    const auto key = philox({seed_, kScramble}, static_cast<std::uint32_t>(axis), 0)[0];
    coordinates[axis] = middle(scrambled(digits, key));
  }
  return coordinates;
}

std::vector<double> UnitSamples::latin_hypercube(std::uint64_t point) const {
  std::vector<double> coordinates(dimensions_);
  for (std::size_t axis = 0; axis < dimensions_; ++axis) {
    const auto word = philox({seed_, kJitter}, static_cast<std::uint32_t>(point), static_cast<std::uint32_t>(axis))[0];
    coordinates[axis] = (permutations_[axis][point] + middle(word)) / static_cast<double>(count_);
  }
  return coordinates;
}

std::vector<double> UnitSamples::monte_carlo(std::uint64_t point) const {
  std::vector<double> coordinates(dimensions_);
  for (std::size_t axis = 0; axis < dimensions_; ++axis)
    coordinates[axis] =
        middle(philox({seed_, kIndependent}, static_cast<std::uint32_t>(point), static_cast<std::uint32_t>(axis))[0]);
  return coordinates;
}

}  // namespace retrace::compute
