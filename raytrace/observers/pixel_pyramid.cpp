#include "raytrace/observers/pixel_pyramid.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "raytrace/sampling/replicate_means.h"

namespace retrace::raytrace {
namespace {

/// Returns the sums of blocks of 2 x 2 values.
std::vector<double> halved(const std::vector<double>& values, std::size_t columns, std::size_t rows) {
  const std::size_t half = (columns + 1) / 2;
  std::vector<double> sums(half * ((rows + 1) / 2), 0.0);
  for (std::size_t row = 0; row < rows; ++row)
    for (std::size_t column = 0; column < columns; ++column)
      sums[row / 2 * half + column / 2] += values[row * columns + column];
  return sums;
}

}  // namespace

double largest_relative_error(const PixelValues& values, double dark) {
  if (values.std_error.empty() || values.value.empty()) return 0.0;
  const double limit = dark * *std::max_element(values.value.begin(), values.value.end());
  double largest = 0.0;
  for (std::size_t k = 0; k < values.value.size(); ++k)
    if (values.value[k] > limit) largest = std::max(largest, values.std_error[k] / values.value[k]);
  return largest;
}

PixelPyramid::PixelPyramid(std::size_t columns, std::size_t rows, const BinRule& rule)
    : sum_(columns * rows, 0.0), rule_(rule) {
  std::vector<double> pixels(columns * rows, 1.0);
  while (true) {
    levels_.push_back(
        {columns, rows, pixels, std::vector<double>(pixels.size(), 0.0), std::vector<double>(pixels.size(), 0.0)});
    if (!(rule.relative_error > 0.0) || pixels.size() == 1) return;
    pixels = halved(pixels, columns, rows);
    columns = (columns + 1) / 2;
    rows = (rows + 1) / 2;
  }
}

void PixelPyramid::Level::take(const std::vector<double>& sums, double scale, double count) {
  for (std::size_t k = 0; k < sums.size(); ++k) {
    const double value = scale * sums[k] / pixels[k];
    const double off = value - mean[k];
    mean[k] += off / count;
    squares[k] += off * (value - mean[k]);
  }
}

void PixelPyramid::close(double scale) {
  count_ += 1.0;
  std::vector<double> coarse;
  for (std::size_t l = 0; l < levels_.size(); ++l) {
    const std::vector<double>& sums = l == 0 ? sum_ : coarse;
    levels_[l].take(sums, scale, count_);
    if (l + 1 < levels_.size()) coarse = halved(sums, levels_[l].columns, levels_[l].rows);
  }
  std::fill(sum_.begin(), sum_.end(), 0.0);
}

PixelValues PixelPyramid::values(std::uint64_t rays, double largest) const {
  const double factor = student_factor(static_cast<std::size_t>(count_));
  const auto error = [&](const Level& level, std::size_t k) {
    return with_unsampled_paths(factor * std::sqrt(level.squares[k] / (count_ - 1.0) / count_),
                                static_cast<double>(rays), largest / level.pixels[k]);
  };
  const Level& finest = levels_.front();
  PixelValues values{finest.mean, std::vector<double>(finest.mean.size())};
  if (levels_.size() == 1) {
    for (std::size_t k = 0; k < finest.mean.size(); ++k) values.std_error[k] = error(finest, k);
    return values;
  }
  // The largest value is that of the finest level on which it is accurate. On finer levels, it is too large by the
  // noise.
  double brightest = 0.0;
  for (const Level& level : levels_) {
    const auto at = std::max_element(level.mean.begin(), level.mean.end());
    brightest = *at;
    if (error(level, static_cast<std::size_t>(at - level.mean.begin())) <= rule_.relative_error * brightest) break;
  }
  const auto satisfies = [&](const Level& level, std::size_t k) {
    const bool is_dark = level.mean[k] < rule_.dark * brightest;
    return error(level, k) <= rule_.relative_error * (is_dark ? brightest : level.mean[k]);
  };
  const std::function<void(std::size_t, std::size_t, std::size_t)> divide = [&](std::size_t l, std::size_t row,
                                                                                std::size_t column) {
    const Level& level = levels_[l];
    bool can_divide = l > 0;
    for (std::size_t child = 0; child < 4 && can_divide; ++child) {
      const std::size_t r = 2 * row + child / 2;
      const std::size_t c = 2 * column + child % 2;
      const Level& finer = levels_[l - 1];
      if (r < finer.rows && c < finer.columns) can_divide = satisfies(finer, r * finer.columns + c);
    }
    if (can_divide) {
      for (std::size_t child = 0; child < 4; ++child) {
        const std::size_t r = 2 * row + child / 2;
        const std::size_t c = 2 * column + child % 2;
        if (r < levels_[l - 1].rows && c < levels_[l - 1].columns) divide(l - 1, r, c);
      }
      return;
    }
    const std::size_t side = std::size_t{1} << l;
    const std::size_t k = row * level.columns + column;
    const double std_error = error(level, k);
    for (std::size_t y = row * side; y < std::min(finest.rows, (row + 1) * side); ++y)
      for (std::size_t x = column * side; x < std::min(finest.columns, (column + 1) * side); ++x) {
        values.value[y * finest.columns + x] = level.mean[k];
        values.std_error[y * finest.columns + x] = std_error;
      }
  };
  divide(levels_.size() - 1, 0, 0);
  return values;
}

}  // namespace retrace::raytrace
