#include "raytrace/observers/pixel_points.h"

#include <algorithm>
#include <cmath>

namespace retrace::raytrace {
namespace {

// Number of neighbouring pixels on each side that are included in the mean variance of a pixel. The training samples of
// a single pixel are too few.
constexpr std::size_t kAveragedPixels = 2;
// Ratio of the points for noisy pixels to the evenly distributed points of a pass.
constexpr double kAdditionalPoints = 1.7;
// Exponent e of the standard deviation s: the number of additional points of a pixel is proportional to s^e. The noise
// of a picture is the sum of the standard errors s / sqrt(N) of its pixels. For a given total number of points, the
// noise is minimal for e = 2/3.
constexpr double kExponent = 2.0 / 3.0;
// Maximum number of points of a pixel, divided by the minimum number.
constexpr double kMaxRatio = 64.0;
// If additional points reduce the variance by less than this factor, all pixels have the same number of points.
constexpr double kMinGain = 2.0;

/// Returns the standard deviation of a single sample for each pixel. The variance is averaged over the neighbouring
/// pixels.
std::vector<double> deviations_of(const std::vector<PixelMoments>& moments, std::uint32_t samples,
                                  std::size_t columns) {
  const std::size_t rows = moments.size() / columns;
  const auto variance = [&](std::size_t pixel) {
    const PixelMoments& m = moments[pixel];
    return std::max(0.0, m.squares - m.sum * m.sum / samples) / (samples - 1.0);
  };
  const auto first = [](std::size_t at) { return at - std::min(at, kAveragedPixels); };
  std::vector<double> deviations;
  deviations.reserve(moments.size());
  for (std::size_t row = 0; row < rows; ++row)
    for (std::size_t column = 0; column < columns; ++column) {
      const std::size_t last_row = std::min(row + kAveragedPixels, rows - 1);
      const std::size_t last_column = std::min(column + kAveragedPixels, columns - 1);
      double sum = 0.0;
      for (std::size_t r = first(row); r <= last_row; ++r)
        for (std::size_t c = first(column); c <= last_column; ++c) sum += variance(r * columns + c);
      const std::size_t count = (last_row - first(row) + 1) * (last_column - first(column) + 1);
      deviations.push_back(std::sqrt(sum / static_cast<double>(count)));
    }
  return deviations;
}

}  // namespace

PixelPoints::PixelPoints(const std::vector<PixelMoments>& moments, std::uint32_t samples, std::size_t columns,
                         std::uint32_t min_points)
    : PixelPoints(moments.size(), min_points) {
  const std::vector<double> deviations = deviations_of(moments, samples, columns);
  double sum = 0.0;
  double squares = 0.0;
  double wanted = 0.0;
  for (const double deviation : deviations) {
    sum += deviation;
    squares += deviation * deviation;
    wanted += std::pow(deviation, kExponent);
  }
  const auto pixels = static_cast<double>(moments.size());
  if (!(pixels * squares > kMinGain * sum * sum)) return;
  total_ = 0;
  for (std::size_t k = 0; k < points_.size(); ++k) {
    const double ratio = 1.0 + kAdditionalPoints * pixels * std::pow(deviations[k], kExponent) / wanted;
    points_[k] = min_points << static_cast<std::uint32_t>(std::lround(std::log2(std::min(ratio, kMaxRatio))));
    total_ += points_[k];
  }
}

}  // namespace retrace::raytrace
