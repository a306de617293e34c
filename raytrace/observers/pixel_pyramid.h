#pragma once

// Means of pixels over independent replicates. Pixels with few rays are merged into square bins until the standard
// error of a bin is small enough.

#include <cstddef>
#include <cstdint>
#include <vector>

namespace retrace::raytrace {

/// Pixel values and their standard errors. `std_error` is empty if the values are not sampled. Merged pixels have the
/// mean value of their bin and its standard error.
struct PixelValues {
  std::vector<double> value;
  std::vector<double> std_error;
  /// Level of the bin of each pixel: a bin has 2^level x 2^level pixels. Empty if the values are not sampled.
  std::vector<std::uint8_t> level = {};
};

/// Rule by which pixels are merged.
struct BinRule {
  /// Maximum standard error of a bin, relative to its value; 0: pixels are not merged.
  double relative_error = 0.0;
  /// Fraction of the largest value below which a bin counts as dark. The standard error of a dark bin is at most
  /// `relative_error` times the largest value.
  double dark = 0.01;
};

/// Returns the largest standard error relative to the value, of all pixels that are not dark. 0 if there are none.
double largest_relative_error(const PixelValues& values, double dark);

/// Returns the smallest width, in pixels, such that bins of at most this width contain a given fraction of the sum of
/// all values. Bins at the border of the grid count with their full width. Returns 1 if the values are not sampled.
/// \param fraction 0 to 1
std::size_t bin_width(const PixelValues& values, double fraction);

/// Means and standard errors over replicates, for the pixels of a grid and for all blocks of 2^k x 2^k pixels.
class PixelPyramid {
 public:
  /// \param rule rule by which values() merges pixels
  PixelPyramid(std::size_t columns, std::size_t rows, const BinRule& rule);

  /// Returns the sums of the present replicate, for each pixel.
  std::vector<double>& replicate() { return sum_; }
  /// Adds the sums of the present replicate, multiplied by `scale`, and starts the next replicate.
  void close(double scale);
  /// Returns the mean over the replicates and the standard error of the mean. The bins are the smallest blocks of
  /// pixels that satisfy the rule. A block is divided into four only if each of them satisfies the rule. The sum over
  /// all pixels does not depend on the bins.
  /// \param rays total number of rays in all replicates
  /// \param largest maximum value that a single ray can add to a pixel, in units of the mean
  PixelValues values(std::uint64_t rays, double largest) const;

 private:
  /// Blocks of 2^k x 2^k pixels. Blocks at the right and lower border may have fewer pixels.
  struct Level {
    std::size_t columns = 0;
    std::size_t rows = 0;
    std::vector<double> pixels;   ///< number of pixels of each block
    std::vector<double> mean;     ///< mean of the pixels of each block (Welford 1962)
    std::vector<double> squares;  ///< sum of squared deviations over the replicates

    /// Adds a replicate.
    /// \param sums sums over the pixels of each block, to be multiplied by `scale`
    /// \param count number of replicates including this one
    void add(const std::vector<double>& sums, double scale, double count);
  };

  /// Returns the indices of the blocks of the next finer level into which a block is divided; empty on the finest
  /// level.
  std::vector<std::size_t> quarters_of(std::size_t level, std::size_t block) const;

  std::vector<double> sum_;
  std::vector<Level> levels_;  ///< pixels first
  BinRule rule_;
  double count_ = 0.0;
};

}  // namespace retrace::raytrace
