#include "surface_models/autocorrelation.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "surface_models/fft.h"

namespace retrace::surface_models {
namespace {

double mean_height(const HeightMap& map) {
  double sum = 0.0;
  double count = 0.0;
  for (const double z : map.heights_nm)
    if (std::isfinite(z)) {
      sum += z;
      count += 1.0;
    }
  return sum / count;
}

std::size_t lags(std::size_t points, double pixel_um, double most_um) {
  const auto wanted = static_cast<std::size_t>(std::ceil(most_um / pixel_um)) + 1;
  return std::min(wanted, points / 2 + 1);
}

/// Replaces a field by its autocorrelation. By the Wiener-Khinchin theorem, the sum of products at each distance is the
/// inverse transform of the power spectrum.
void correlate(RealFft& fft) {
  fft.forward();
  for (auto& value : fft.spectrum()) value = std::norm(value);
  fft.inverse();
}

}  // namespace

Autocorrelation autocorrelation(const HeightMap& map, double max_um) {
  Autocorrelation r{lags(map.columns, map.x_pixel_um, max_um),
                    lags(map.rows, map.y_pixel_um, max_um),
                    map.x_pixel_um,
                    map.y_pixel_um,
                    {}};
  // The fields are padded with zeros, so that no pair of points extends across a border.
  RealFft products(fast_length(map.rows + r.y_lags), fast_length(map.columns + r.x_lags));
  RealFft pairs(products.rows(), products.columns());
  const double mean = mean_height(map);
  for (std::size_t row = 0; row < map.rows; ++row)
    for (std::size_t column = 0; column < map.columns; ++column) {
      const double z = map.at(column, row);
      products.field(column, row) = std::isfinite(z) ? z - mean : 0.0;
      pairs.field(column, row) = std::isfinite(z) ? 1.0 : 0.0;
    }
  correlate(products);
  correlate(pairs);
  const auto most_dy = static_cast<std::ptrdiff_t>(r.y_lags) - 1;
  for (std::ptrdiff_t dy = -most_dy; dy <= most_dy; ++dy) {
    const std::size_t row = dy < 0 ? products.rows() - static_cast<std::size_t>(-dy) : static_cast<std::size_t>(dy);
    for (std::size_t dx = 0; dx < r.x_lags; ++dx) {
      const double count = std::round(pairs.field(dx, row));
      r.values_nm2.push_back(count > 0.0 ? products.field(dx, row) / count : kMissing);
    }
  }
  return r;
}

std::optional<double> correlation_length_um(const Autocorrelation& r, Axis axis) {
  const bool along_x = axis == Axis::x;
  const double level = r.variance_nm2() / std::numbers::e;
  if (!(level > 0.0)) return std::nullopt;
  double before = r.variance_nm2();
  for (std::size_t i = 1; i < (along_x ? r.x_lags : r.y_lags); ++i) {
    const double value = along_x ? r.at(i, 0) : r.at(0, static_cast<std::ptrdiff_t>(i));
    if (value <= level) {
      const double at = static_cast<double>(i - 1) + (before - level) / (before - value);
      return at * (along_x ? r.x_pixel_um : r.y_pixel_um);
    }
    before = value;
  }
  return std::nullopt;
}

}  // namespace retrace::surface_models
