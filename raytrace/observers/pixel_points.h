#pragma once

// Number of paths that a camera traces through each pixel in one pass.

#include <cstddef>
#include <cstdint>
#include <vector>

namespace retrace::raytrace {

/// Sum and sum of squares of the luminances of paths through a pixel, in cd/m^2.
struct PixelMoments {
  double sum = 0.0;
  double squares = 0.0;

  void add(double luminance) {
    sum += luminance;
    squares += luminance * luminance;
  }
};

/// Number of points of each pixel in one pass. A point is the start of a path. In many pictures, most pixels are dark
/// or uniform, and only a few pixels are noisy. Noisy pixels have more points. docs/theory/images.md derives the
/// formula.
class PixelPoints {
 public:
  /// Assigns the same number of points to every pixel.
  /// \param points number of points per pixel
  PixelPoints(std::size_t pixels, std::uint32_t points)
      : points_(pixels, points), total_(std::uint64_t{pixels} * points) {}

  /// Determines the number of points of each pixel from training samples. Each number is `min_points` times a power of
  /// two. If the variance at equal cost decreases by less than a factor of two, every pixel has `min_points` points.
  /// \param moments moments of the training samples, row by row
  /// \param samples number of training samples per pixel; >= 2
  PixelPoints(const std::vector<PixelMoments>& moments, std::uint32_t samples, std::size_t columns,
              std::uint32_t min_points);

  std::uint32_t operator[](std::size_t pixel) const { return points_[pixel]; }
  /// Returns the number of points, summed over all pixels.
  std::uint64_t total() const { return total_; }

 private:
  std::vector<std::uint32_t> points_;
  std::uint64_t total_ = 0;
};

}  // namespace retrace::raytrace
