#pragma once

// Sample points of the unit cube for parameter studies: Sobol, Latin hypercube, and Monte Carlo.

#include <cstddef>
#include <cstdint>
#include <vector>

namespace retrace::compute {

/// Points of the unit cube. The number of a point determines its coordinates, so that any process can compute any
/// point.
class UnitSamples {
 public:
  enum class Kind {
    sobol,  ///< Sobol points with hash-based Owen scrambling (Laine, Karras 2011); `count` should be a power of two
    latin_hypercube,  ///< one point in each of `count` equal intervals of every axis (McKay et al. 1979)
    monte_carlo       ///< independent random points
  };
  /// \pre 1 <= dimensions <= max_dimensions, 1 <= count <= 2^31
  UnitSamples(Kind kind, std::size_t dimensions, std::uint64_t count, std::uint32_t seed);

  static constexpr std::size_t max_dimensions = 1000;

  /// Returns the coordinates of a point, each in (0, 1).
  std::vector<double> at(std::uint64_t point) const;

 private:
  std::vector<double> sobol(std::uint64_t point) const;
  std::vector<double> latin_hypercube(std::uint64_t point) const;
  std::vector<double> monte_carlo(std::uint64_t point) const;

  Kind kind_;
  std::size_t dimensions_;
  std::uint64_t count_;
  std::uint32_t seed_;
  /// Permutations of the intervals, indexed by axis; only for the Latin hypercube.
  std::vector<std::vector<std::uint32_t>> permutations_;
};

}  // namespace retrace::compute
