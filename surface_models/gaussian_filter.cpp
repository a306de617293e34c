#include "surface_models/gaussian_filter.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "surface_models/fft.h"

namespace retrace::surface_models {
namespace {

/// Returns the sampled weighting function of one axis, beginning with its centre. It is scaled such that all samples
/// add to 1.
std::vector<double> weights(double pixel_um, double cutoff_um, std::size_t points) {
  const auto reach = static_cast<std::size_t>(std::ceil(kGaussianReach * cutoff_um / pixel_um));
  std::vector<double> s;
  double sum = 0.0;
  for (std::size_t i = 0; i <= std::min(reach, points - 1); ++i) {
    const double t = static_cast<double>(i) * pixel_um / cutoff_um;
    s.push_back(std::exp(-std::numbers::pi * std::numbers::pi / std::numbers::ln2 * t * t));
    sum += (i == 0 ? 1.0 : 2.0) * s.back();
  }
  for (double& value : s) value /= sum;
  return s;
}

/// Returns the transform of symmetric weights for `length` points. It is real because of the symmetry.
std::vector<double> transfer(const std::vector<double>& s, std::size_t length) {
  std::vector<double> cosine(length);
  for (std::size_t i = 0; i < length; ++i)
    cosine[i] = std::cos(2.0 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(length));
  std::vector<double> t(length, s[0]);
  for (std::size_t k = 0; k < length; ++k)
    for (std::size_t i = 1; i < s.size(); ++i) t[k] += 2.0 * s[i] * cosine[k * i % length];
  return t;
}

void multiply(RealFft& fft, const std::vector<double>& tx, const std::vector<double>& ty) {
  for (std::size_t j = 0; j < fft.rows(); ++j)
    for (std::size_t k = 0; k < fft.spectrum_columns(); ++k)
      fft.spectrum()[j * fft.spectrum_columns() + k] *= tx[k] * ty[j];
}

}  // namespace

double gaussian_transmission(double frequency_per_um, double cutoff_um) {
  const double t = frequency_per_um * cutoff_um;
  return std::exp(-std::numbers::ln2 * t * t);
}

Split gaussian_split(const HeightMap& map, double cutoff_um) {
  const std::vector<double> sx = weights(map.x_pixel_um, cutoff_um, map.columns);
  const std::vector<double> sy = weights(map.y_pixel_um, cutoff_um, map.rows);
  // The fields are padded with zeros over the width of the weights, so that opposite borders do not influence each
  // other.
  RealFft heights(fast_length(map.rows + sy.size()), fast_length(map.columns + sx.size()));
  RealFft measured(heights.rows(), heights.columns());
  for (std::size_t row = 0; row < map.rows; ++row)
    for (std::size_t column = 0; column < map.columns; ++column) {
      const double z = map.at(column, row);
      heights.field(column, row) = std::isfinite(z) ? z : 0.0;
      measured.field(column, row) = std::isfinite(z) ? 1.0 : 0.0;
    }
  const std::vector<double> tx = transfer(sx, heights.columns());
  const std::vector<double> ty = transfer(sy, heights.rows());
  for (RealFft* fft : {&heights, &measured}) {
    fft->forward();
    multiply(*fft, tx, ty);
    fft->inverse();
  }
  Split split{map, map};
  for (std::size_t row = 0; row < map.rows; ++row)
    for (std::size_t column = 0; column < map.columns; ++column) {
      if (!std::isfinite(map.at(column, row))) continue;
      const double waviness = heights.field(column, row) / measured.field(column, row);
      split.waviness.at(column, row) = waviness;
      split.roughness.at(column, row) -= waviness;
    }
  return split;
}

}  // namespace retrace::surface_models
