#pragma once

// Learns, from passes over the picture, at which positions of an element the rare bright paths of a camera begin.

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "geometry/vec.h"

namespace retrace::raytrace {

/// Affine map from the points of a pixel to points on the entrance face. For a camera, the map is affine except for
/// terms of the order of the square of the angle that a pixel subtends.
struct PixelPlace {
  geometry::Vec2 corner_mm = geometry::Vec2::Zero();
  geometry::Vec2 along_row_mm = geometry::Vec2::Zero();     ///< from one side of the pixel to the other
  geometry::Vec2 along_column_mm = geometry::Vec2::Zero();  ///< from its upper to its lower side
  std::uint32_t tile = 0;  ///< index of the tile of the picture that contains the pixel
};

/// Importance map over one period of an array. For paths that begin in a bin of the map, it contains the mean square of
/// their luminance minus the usual luminance of their pixel. Pixels select some of their points among random candidates
/// with probabilities proportional to the root of the map. Bright strips a few thousandths of an element wide are then
/// sampled in every pass (docs/theory/images.md). The map does not change mean luminances.
class PixelGuide {
 public:
  /// Number of points of a pixel in a pass. Half of the points are distributed evenly, the other half by the map.
  static constexpr std::size_t kPoints = 4;

  /// A point of a pixel, with both coordinates in [0, 1), and the weight of its luminance in the mean of the pixel.
  struct Point {
    geometry::Vec2 within = geometry::Vec2::Zero();
    double weight = 1.0 / kPoints;
  };

  /// Contribution of a path to the map.
  struct Sample {
    std::uint32_t bin = 0;  ///< index in the bins of the maps of all tiles
    float square = 0.0F;    ///< square of the difference from the usual luminance of the pixel
  };
  using Samples = std::vector<Sample>;

  /// Sums over paths in the bins of one period.
  struct Bins {
    Bins(std::size_t across, std::size_t down);
    /// Returns the index of the bin that contains `bin` in a map with half the resolution.
    std::size_t coarser(std::size_t bin) const;
    /// Returns the map with half the resolution.
    Bins coarser() const;

    std::size_t columns;
    std::size_t rows;
    std::vector<float> sums;  ///< sums of Sample::square
    std::vector<float> counts;
  };

  /// \param tiles number of tiles of the picture; each tile has a map of its own
  /// \param paths approximate number of samples from one pass
  PixelGuide(const geometry::Vec2& period_mm, std::size_t tiles, std::size_t paths);

  /// Returns the sample of a path.
  /// \param excess luminance of the path minus the usual luminance of its pixel
  Sample sample(const geometry::Vec2& place_mm, std::uint32_t tile, float excess) const;
  /// Updates the map with the samples of a pass. The paths of the pass may be distributed evenly or by an earlier map,
  /// because they are distributed evenly within each bin in both cases.
  void learn(const std::vector<Samples>& lists);
  /// Returns true if the map reduces the noise of a pixel. It does not if the map is nearly constant over the pixel, or
  /// small compared with its mean over the picture.
  bool serves(const PixelPlace& pixel) const;
  /// Returns the points of a pixel for one pass.
  /// \param random random words
  std::array<Point, kPoints> points(const PixelPlace& pixel, const std::array<std::uint32_t, 4>& random) const;

 private:
  /// Number of candidates. They form a rank-1 lattice of Fibonacci numbers, whose projections onto both sides of the
  /// pixel are evenly distributed.
  static constexpr std::size_t kCandidates = 233;
  static constexpr std::size_t kCandidateStep = 144;
  using Shift = std::array<std::uint32_t, 2>;
  using Weights = std::array<double, kCandidates>;

  static std::array<std::uint32_t, 2> candidate(std::size_t k, const Shift& shift);
  /// Computes the roots of the map at the candidates. Returns their sum, which is above 0.
  double roots_at(const PixelPlace& pixel, const Shift& shift, Weights& roots) const;
  std::size_t bin_at(std::uint32_t x, std::uint32_t y) const;

  geometry::Vec2 period_mm_;
  std::size_t columns_ = 1;
  std::size_t rows_ = 1;
  double mean_square_ = 0.0;               ///< over all samples
  std::vector<Bins> found_;                ///< by tile
  std::vector<std::vector<float>> roots_;  ///< roots of the mean squares: for each tile, the bins row by row
};

}  // namespace retrace::raytrace
