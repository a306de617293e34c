#pragma once

// Importance sampling of camera pixels. It learns from passes over the picture which positions on an element start the
// rare bright paths.

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "geometry/vec.h"

namespace retrace::raytrace {

/// Affine map from the points of a pixel to the points of the entrance face. The exact map of a camera differs from it
/// by terms of second order in the angle that a pixel subtends.
struct PixelPlace {
  geometry::Vec2 corner_mm = geometry::Vec2::Zero();
  geometry::Vec2 along_row_mm = geometry::Vec2::Zero();     ///< from one side of the pixel to the other
  geometry::Vec2 along_column_mm = geometry::Vec2::Zero();  ///< from its upper to its lower side
  std::uint32_t tile = 0;                                   ///< index of the picture tile that contains the pixel
};

/// Importance map over one period of an array. The value of a bin is the mean square of (luminance of a path that
/// starts in the bin) minus (usual luminance of its pixel). In each pass, a pixel selects some of its points from
/// random candidates, with probabilities proportional to the root of the map. Bright strips of a few thousandths of an
/// element's width are thus sampled in every pass (docs/theory/images.md). The expected luminance of a pixel does not
/// depend on the map.
class PixelGuide {
 public:
  /// Number of points of a pixel in a pass. Half of them are distributed uniformly, the other half by the map.
  static constexpr std::size_t kPoints = 4;

  /// A sample point of a pixel, and the weight of its luminance in the mean of the pixel. Its coordinates are in [0,
  /// 1).
  struct Point {
    geometry::Vec2 within = geometry::Vec2::Zero();
    double weight = 1.0 / kPoints;
  };

  /// Contribution of one path to the map.
  struct Sample {
    std::uint32_t bin = 0;  ///< index of the bin, over the maps of all tiles
    float square = 0.0F;    ///< square of the luminance minus the usual luminance of the pixel
  };
  using Samples = std::vector<Sample>;

  /// Sums of path contributions in the bins of one period.
  struct Bins {
    Bins(std::size_t across, std::size_t down);
    /// Returns the index of the bin that contains `bin` in the map of half the resolution.
    std::size_t coarser(std::size_t bin) const;
    /// Returns the map of half the resolution.
    Bins coarser() const;

    std::size_t columns;
    std::size_t rows;
    std::vector<float> sums;  ///< sums of Sample::square
    std::vector<float> counts;
  };

  /// \param tiles number of tiles of the picture; each tile has a map of its own
  /// \param paths approximate number of training samples from one pass
  PixelGuide(const geometry::Vec2& period_mm, std::size_t tiles, std::size_t paths);

  /// Returns the training sample of a path.
  /// \param excess luminance of the path minus the usual luminance of its pixel
  Sample sample(const geometry::Vec2& place_mm, std::uint32_t tile, float excess) const;
  /// Updates the map with the training samples of one pass. The points of that pass may be distributed uniformly or by
  /// an earlier map, because within a bin they are uniform in both cases.
  void learn(const std::vector<Samples>& lists);
  /// Returns true if sampling by the map reduces the noise of a pixel. It does not if the map is nearly constant over
  /// the pixel, or small compared with its mean over the picture.
  bool serves(const PixelPlace& pixel) const;
  /// Returns the sample points of a pixel for one pass.
  /// \param random four random 32-bit words
  std::array<Point, kPoints> points(const PixelPlace& pixel, const std::array<std::uint32_t, 4>& random) const;

 private:
  /// Number of candidate points. They form a rank-1 lattice of Fibonacci numbers, so that their projections onto both
  /// sides of the pixel are uniformly distributed.
  static constexpr std::size_t kCandidates = 233;
  static constexpr std::size_t kCandidateStep = 144;
  using Shift = std::array<std::uint32_t, 2>;
  using Weights = std::array<double, kCandidates>;

  static std::array<std::uint32_t, 2> candidate(std::size_t k, const Shift& shift);
  /// Computes the roots of the map values at the candidates. Returns their sum, which is greater than 0.
  double roots_at(const PixelPlace& pixel, const Shift& shift, Weights& roots) const;
  std::size_t bin_at(std::uint32_t x, std::uint32_t y) const;

  geometry::Vec2 period_mm_;
  std::size_t columns_ = 1;
  std::size_t rows_ = 1;
  double mean_square_ = 0.0;               ///< mean of Sample::square over all samples
  std::vector<Bins> found_;                ///< by tile
  std::vector<std::vector<float>> roots_;  ///< for each tile, the roots of the mean squares in the bins, row by row
};

}  // namespace retrace::raytrace
