#pragma once

// Where in an element the rare bright paths of a camera's pixels begin, learnt from passes over the picture.

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "geometry/vec.h"

namespace retrace::raytrace {

/// Where a pixel's points lie on the entrance face: affine in the point of the pixel, which a camera's are but for
/// terms of the order of the square of a pixel's angle.
struct PixelPlace {
  geometry::Vec2 corner_mm = geometry::Vec2::Zero();
  geometry::Vec2 along_row_mm = geometry::Vec2::Zero();     ///< from one side of the pixel to the other
  geometry::Vec2 along_column_mm = geometry::Vec2::Zero();  ///< from its upper to its lower side
  std::uint32_t tile = 0;                                   ///< of the picture that the pixel lies in
};

/// A map over one period of an array: the mean square of what paths that begin there see more, or less, than most of
/// their pixel. Pixels take some of their points at random among candidates by its root, so that strips a few
/// thousandths of an element wide are met in every pass (docs/theory/images.md). Any map leaves means as they are.
class PixelGuide {
 public:
  /// Points of a pixel in a pass: as many evenly as by the map.
  static constexpr std::size_t kPoints = 4;

  /// A point of a pixel, both coordinates in [0, 1), and what its luminance counts in the pixel's mean.
  struct Point {
    geometry::Vec2 within = geometry::Vec2::Zero();
    double weight = 1.0 / kPoints;
  };

  /// What a path tells.
  struct Sample {
    std::uint32_t bin = 0;  ///< of the maps of all tiles
    float square = 0.0F;    ///< of the luminance that it saw more, or less, than most of its pixel
  };
  using Samples = std::vector<Sample>;

  /// What paths found in bins over a period.
  struct Bins {
    Bins(std::size_t across, std::size_t down);
    /// Of the bin that holds it on a map that is twice as coarse.
    std::size_t coarser(std::size_t bin) const;
    /// That map.
    Bins coarser() const;

    std::size_t columns;
    std::size_t rows;
    std::vector<float> sums;  ///< of squares
    std::vector<float> counts;
  };

  /// \param tiles of the picture, each of which has a map of its own \param paths that a pass tells of, about
  PixelGuide(const geometry::Vec2& period_mm, std::size_t tiles, std::size_t paths);

  /// \param excess luminance that the path saw more, or less, than most of its pixel
  Sample sample(const geometry::Vec2& place_mm, std::uint32_t tile, float excess) const;
  /// Of paths of a pass, even or by what was learnt before: within a bin they lie evenly in any case.
  void learn(const std::vector<Samples>& lists);
  /// Whether a pixel gains by taking points by the map: not where that is even, or faint beside the picture.
  bool serves(const PixelPlace& pixel) const;
  /// Points for one pass. \param random words
  std::array<Point, kPoints> points(const PixelPlace& pixel, const std::array<std::uint32_t, 4>& random) const;

 private:
  /// Of a rank-1 lattice of Fibonacci numbers, whose projections on both sides of the pixel are even.
  static constexpr std::size_t kCandidates = 233;
  static constexpr std::size_t kCandidateStep = 144;
  using Shift = std::array<std::uint32_t, 2>;
  using Weights = std::array<double, kCandidates>;

  static std::array<std::uint32_t, 2> candidate(std::size_t k, const Shift& shift);
  /// Of the candidates, and their sum, which is above 0.
  double roots_at(const PixelPlace& pixel, const Shift& shift, Weights& roots) const;
  std::size_t bin_at(std::uint32_t x, std::uint32_t y) const;

  geometry::Vec2 period_mm_;
  std::size_t columns_ = 1;
  std::size_t rows_ = 1;
  double mean_square_ = 0.0;               ///< of all paths that told
  std::vector<Bins> found_;                ///< by tile
  std::vector<std::vector<float>> roots_;  ///< of the mean squares, by tile and row by row
};

}  // namespace retrace::raytrace
