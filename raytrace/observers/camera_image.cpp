// Member functions of CameraImage, which compute means and errors of pictures.
#include <algorithm>
#include <cmath>

#include "raytrace/observers/camera.h"

namespace retrace::raytrace {
namespace {

// Weight of the neighbouring pixels in the estimate of a pixel's variance, as a number of paths that show the lamp.
// With fewer such paths, the variance of the pixel's own paths is uncertain.
constexpr double kKnownHits = 4.0;

}  // namespace

void CameraImage::add(const CameraPass& pass) {
  const std::size_t pixels = luminance.size();
  ++passes;
  double part_pixels = 0.0;
  for (std::size_t k = 0; k < pixels; ++k) {
    const double off = pass[k] - luminance[k];
    luminance[k] += off / passes;
    squares[k] += off * (pass[k] - luminance[k]);
    coverage[k] += (pass[pixels + k] - coverage[k]) / passes;
    paths[k] += pass[2 * pixels + k];
    part_pixels += pass[pixels + k];
  }
  if (part_pixels > 0.0) part_means.push_back(pass.back() / part_pixels);
}

double CameraImage::std_error(std::size_t pixel) const {
  const double own = own_variance(pixel);
  if (!(coverage[pixel] > 0.0)) return std::sqrt(own);
  constexpr std::size_t kReach = 2;
  const std::size_t row = pixel / columns;
  const std::size_t column = pixel % columns;
  double sum = 0.0;
  double luminances = 0.0;
  double count = 0.0;
  for (std::size_t r = row - std::min(row, kReach); r <= std::min(row + kReach, rows - 1); ++r)
    for (std::size_t c = column - std::min(column, kReach); c <= std::min(column + kReach, columns - 1); ++c) {
      const std::size_t at = r * columns + c;
      sum += own_variance(at) * paths[at];
      luminances += luminance[at];
      count += 1.0;
    }
  const double of_path = sum / count;
  const double mean = luminances / count;
  const double n = paths[pixel];
  if (!has_more_paths(pixel)) return std::sqrt(std::max(own, of_path / n));
  if (!(of_path > 0.0)) return std::sqrt(own);
  // Number of paths among which kKnownHits paths are expected to show the lamp. The formula assumes that each path
  // shows either a bright lamp or darkness.
  const double known = kKnownHits * (1.0 + of_path / (mean * mean));
  return std::sqrt((n * own + known * of_path / n) / (n + known));
}

bool CameraImage::has_more_paths(std::size_t pixel) const {
  return paths[pixel] > passes * CameraTracer::kPointsPerPass;
}

double CameraImage::total_paths() const {
  double sum = 0.0;
  for (const double count : paths) sum += count;
  return sum;
}

double CameraImage::part_mean() const {
  double sum = 0.0;
  for (const double mean : part_means) sum += mean;
  return sum / static_cast<double>(part_means.size());
}

double CameraImage::part_error() const {
  const double mean = part_mean();
  const auto count = static_cast<double>(part_means.size());
  double sum = 0.0;
  for (const double m : part_means) sum += (m - mean) * (m - mean);
  return std::sqrt(sum / (count - 1.0) / count);
}

double CameraImage::relative_noise() const {
  double errors = 0.0;
  double sum = 0.0;
  for (std::size_t k = 0; k < luminance.size(); ++k) {
    if (coverage[k] < 1.0 - 1e-9) continue;
    errors += has_more_paths(k) ? std::sqrt(own_variance(k)) : std_error(k);
    sum += luminance[k];
  }
  return sum > 0.0 ? errors / sum : 0.0;
}

}  // namespace retrace::raytrace
