#include "studies/image/camera_colours.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "materials/io/spectrum_reader.h"

namespace retrace::studies {
namespace {

// Relative noise of pixels for which colours are averaged over one pixel to each side. Noisier pictures use more
// pixels.
constexpr double kNoiseOfColours = 0.02;

/// Returns a picture of another response with less noise. Each value is the luminance of the pixel, times the ratio of
/// the means of `other` and `luminance` over a square around the pixel.
/// \param reach half of the side of the square, in pixels
std::vector<double> with_mean_colour(const raytrace::CameraImage& luminance, const std::vector<double>& other,
                                     std::size_t reach) {
  const std::size_t columns = luminance.columns;
  const std::size_t rows = luminance.rows;
  // Summed-area table: each value is the sum over all pixels above and to its left. It has one row and one column more
  // than the picture.
  const auto sums_of = [&](const std::vector<double>& values) {
    std::vector<double> sums((columns + 1) * (rows + 1), 0.0);
    for (std::size_t r = 0; r < rows; ++r)
      for (std::size_t c = 0; c < columns; ++c)
        sums[(r + 1) * (columns + 1) + c + 1] = values[r * columns + c] + sums[r * (columns + 1) + c + 1] +
                                                sums[(r + 1) * (columns + 1) + c] - sums[r * (columns + 1) + c];
    return sums;
  };
  const std::vector<double> y = sums_of(luminance.luminance);
  const std::vector<double> z = sums_of(other);
  std::vector<double> result(other.size());
  for (std::size_t r = 0; r < rows; ++r)
    for (std::size_t c = 0; c < columns; ++c) {
      const std::size_t top = r - std::min(r, reach);
      const std::size_t left = c - std::min(c, reach);
      const std::size_t bottom = std::min(rows, r + reach + 1);
      const std::size_t right = std::min(columns, c + reach + 1);
      const auto within = [&](const std::vector<double>& sums) {
        return sums[bottom * (columns + 1) + right] - sums[top * (columns + 1) + right] -
               sums[bottom * (columns + 1) + left] + sums[top * (columns + 1) + left];
      };
      const double all = within(y);
      result[r * columns + c] = all > 0.0 ? luminance.luminance[r * columns + c] * within(z) / all : 0.0;
    }
  return result;
}

}  // namespace

std::array<double, 3> CameraColours::rgb(double y, std::size_t pixel) const {
  // Bradford's matrix from XYZ to cone responses, and the matrix from XYZ to linear sRGB.
  const Eigen::Matrix3d cones{{0.8951, 0.2664, -0.1614}, {-0.7502, 1.7135, 0.0367}, {0.0389, -0.0685, 1.0296}};
  const Eigen::Matrix3d rgb_of_xyz{
      {3.2404542, -1.5371385, -0.4985314}, {-0.9692660, 1.8760108, 0.0415560}, {0.0556434, -0.2040259, 1.0572252}};
  const geometry::Vec3 d65(0.95047, 1.0, 1.08883);
  const geometry::Vec3 white(lamp[0], lamp[1], lamp[2]);
  const geometry::Vec3 xyz(x[pixel] * lamp[0], y * lamp[1], z[pixel] * lamp[2]);
  const geometry::Vec3 scale = (cones * d65).cwiseQuotient(cones * white);
  const geometry::Vec3 rgb = rgb_of_xyz * cones.inverse() * scale.asDiagonal() * cones * xyz;
  return {rgb[0], rgb[1], rgb[2]};
}

materials::Tristimulus lamp_colour(PhotometricLight light) {
  const materials::Tristimulus lamp = materials::tristimulus(lamp_power(light), materials::shipped_colour_matching());
  return {lamp[0] / lamp[1], 1.0, lamp[2] / lamp[1]};
}

CameraColours colours_of(const std::vector<raytrace::CameraImage>& responses, const materials::Tristimulus& lamp) {
  const raytrace::CameraImage& luminance = responses[0];
  const double noise = luminance.passes > 1 ? luminance.relative_noise() : 1.0;
  const auto reach = static_cast<std::size_t>(std::clamp(std::ceil(noise / kNoiseOfColours), 1.0, 12.0));
  return {with_mean_colour(luminance, responses[1].luminance, reach),
          with_mean_colour(luminance, responses[2].luminance, reach), lamp};
}

}  // namespace retrace::studies
