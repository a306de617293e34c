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

std::size_t bin_width(const PixelValues& values, double fraction) {
  std::vector<double> of_level;
  double total = 0.0;
  for (std::size_t k = 0; k < values.level.size(); ++k) {
    const std::size_t level = values.level[k];
    if (of_level.size() <= level) of_level.resize(level + 1, 0.0);
    of_level[level] += values.value[k];
    total += values.value[k];
  }
  double sum = 0.0;
  for (std::size_t level = 0; level < of_level.size(); ++level) {
    sum += of_level[level];
    if (sum >= fraction * total) return std::size_t{1} << level;
  }
  return 1;
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

void PixelPyramid::Level::add(const std::vector<double>& sums, double scale, double count) {
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
    levels_[l].add(sums, scale, count_);
    if (l + 1 < levels_.size()) coarse = halved(sums, levels_[l].columns, levels_[l].rows);
  }
  std::fill(sum_.begin(), sum_.end(), 0.0);
}

std::vector<std::size_t> PixelPyramid::quarters_of(std::size_t level, std::size_t block) const {
  std::vector<std::size_t> quarters;
  if (level == 0) return quarters;
  const Level& finer = levels_[level - 1];
  for (std::size_t k = 0; k < 4; ++k) {
    const std::size_t row = 2 * (block / levels_[level].columns) + k / 2;
    const std::size_t column = 2 * (block % levels_[level].columns) + k % 2;
    if (row < finer.rows && column < finer.columns) quarters.push_back(row * finer.columns + column);
  }
  return quarters;
}

PixelValues PixelPyramid::values(std::uint64_t rays, double largest) const {
  const double factor = student_factor(static_cast<std::size_t>(count_));
  const auto error = [&](const Level& level, std::size_t k) {
    return with_unsampled_paths(factor * std::sqrt(level.squares[k] / (count_ - 1.0) / count_),
                                static_cast<double>(rays), largest / level.pixels[k]);
  };
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
  const Level& finest = levels_.front();
  PixelValues values{finest.mean, std::vector<double>(finest.mean.size()),
                     std::vector<std::uint8_t>(finest.mean.size())};
  const auto merge = [&](std::size_t l, std::size_t k) {
    const Level& level = levels_[l];
    const std::size_t side = std::size_t{1} << l;
    const std::size_t top = k / level.columns * side;
    const std::size_t left = k % level.columns * side;
    const double std_error = error(level, k);
    for (std::size_t y = top; y < std::min(finest.rows, top + side); ++y)
      for (std::size_t x = left; x < std::min(finest.columns, left + side); ++x) {
        values.value[y * finest.columns + x] = level.mean[k];
        values.std_error[y * finest.columns + x] = std_error;
        values.level[y * finest.columns + x] = static_cast<std::uint8_t>(l);
      }
  };
  const std::function<void(std::size_t, std::size_t)> divide = [&](std::size_t l, std::size_t k) {
    const std::vector<std::size_t> quarters = quarters_of(l, k);
    const bool can_divide =
        l > 0 && std::ranges::all_of(quarters, [&](std::size_t q) { return satisfies(levels_[l - 1], q); });
    if (!can_divide) return merge(l, k);
    for (const std::size_t quarter : quarters) divide(l - 1, quarter);
  };
  for (std::size_t k = 0; k < levels_.back().mean.size(); ++k) divide(levels_.size() - 1, k);
  return values;
}

}  // namespace retrace::raytrace
