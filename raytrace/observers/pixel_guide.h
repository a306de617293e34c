#pragma once

// Importance sampling of the pixels of a camera. Passes over the picture train it to find the positions on an element
// where the few bright paths start.

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "geometry/vec.h"

namespace retrace::raytrace {

/// Affine map from the points of a pixel to points of the entrance face. The exact map differs from it by terms of
/// second order in the angle that a pixel subtends.
struct PixelProjection {
  geometry::Vec2 corner_mm = geometry::Vec2::Zero();
  geometry::Vec2 along_row_mm = geometry::Vec2::Zero();     ///< vector from the left to the right side of the pixel
  geometry::Vec2 along_column_mm = geometry::Vec2::Zero();  ///< vector from the upper to the lower side of the pixel
  std::uint32_t tile = 0;                                   ///< index of the tile (rectangular area of the picture)
};

/// Importance map over one period of an array. Paths are sorted into bins by the position where they start. The value
/// of a bin is the mean square of the luminance of its paths, after the typical luminance of their pixel is subtracted.
///
/// In each pass, a pixel selects half of its points from random candidates. The probability of a candidate is
/// proportional to the square root of the map. Bright strips with a width of a few thousandths of an element are thus
/// sampled in every pass (docs/theory/images.md). The expected luminance of a pixel does not depend on the map.
class PixelGuide {
 public:
  /// Number of points per pixel and pass. Half of them are selected uniformly and half of them by the map.
  static constexpr std::size_t kPointsPerPixel = 4;

  /// A sample point of a pixel, in coordinates from 0 to 1, and the weight of its path in the mean of the pixel.
  struct Point {
    geometry::Vec2 within = geometry::Vec2::Zero();
    double weight = 1.0 / kPointsPerPixel;
  };

  /// Training sample: the contribution of one path to the map.
  struct Sample {
    std::uint32_t bin = 0;  ///< index of the bin; the bins of all tiles are numbered consecutively
    float square = 0.0F;    ///< square of the difference between the luminance and the typical luminance of the pixel
  };
  using Samples = std::vector<Sample>;

  /// Sums of training samples in the bins of one period.
  struct Bins {
    Bins(std::size_t across, std::size_t down);
    /// Returns the index of the bin that contains `bin` at half the resolution.
    std::size_t coarser(std::size_t bin) const;
    /// Returns the sums at half the resolution.
    Bins coarser() const;

    std::size_t columns;
    std::size_t rows;
    std::vector<float> sums;  ///< sum of Sample::square per bin; `counts` is the number of samples
    std::vector<float> counts;
  };

  /// \param tiles number of tiles of the picture; each tile has its own map
  /// \param paths approximate number of training samples per pass
  PixelGuide(const geometry::Vec2& period_mm, std::size_t tiles, std::size_t paths);

  /// Returns the training sample of a path.
  /// \param excess luminance of the path minus the typical luminance of its pixel
  Sample sample(const geometry::Vec2& position_mm, std::uint32_t tile, float excess) const;
  /// Updates the map with the training samples of one pass. The points of this pass may have been selected uniformly or
  /// by an earlier map. In both cases, they are uniformly distributed within a bin.
  void train(const std::vector<Samples>& lists);
  /// Returns true if the map reduces the noise of a pixel. Returns false if the map is nearly constant over the pixel,
  /// or small there compared with its mean over the picture.
  bool reduces_noise(const PixelProjection& pixel) const;
  /// Returns the sample points of a pixel for one pass.
  /// \param random four random 32-bit words
  std::array<Point, kPointsPerPixel> points(const PixelProjection& pixel,
                                            const std::array<std::uint32_t, 4>& random) const;

 private:
  /// Number of candidate points of a pixel. They form a rank-1 lattice of Fibonacci numbers. Their projections onto
  /// both sides of the pixel are therefore uniformly distributed.
  static constexpr std::size_t kCandidates = 233;
  static constexpr std::size_t kCandidateStep = 144;
  using Shift = std::array<std::uint32_t, 2>;
  using Weights = std::array<double, kCandidates>;

  static std::array<std::uint32_t, 2> candidate(std::size_t k, const Shift& shift);
  /// Computes the square root of the map at each candidate.
  /// \return the sum of the square roots, which is greater than 0
  double roots_at(const PixelProjection& pixel, const Shift& shift, Weights& roots) const;
  std::size_t bin_at(std::uint32_t x, std::uint32_t y) const;

  geometry::Vec2 period_mm_;
  std::size_t columns_ = 1;
  std::size_t rows_ = 1;
  double mean_square_ = 0.0;               ///< mean of Sample::square over all samples
  std::vector<Bins> found_;                ///< sums of the training samples, indexed by tile
  std::vector<std::vector<float>> roots_;  ///< square roots of the mean squares, indexed by tile and bin
};

}  // namespace retrace::raytrace
