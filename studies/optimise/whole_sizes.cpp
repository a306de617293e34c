#include "studies/optimise/whole_sizes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace retrace::studies {
namespace {

/// Maximum deviation of the number of elements from a whole number. Arrays are laid out with the same tolerance.
constexpr double kWhole = 1e-9;
/// Maximum number of element sizes that divide one length of the part into a whole number of elements. If a length has
/// more such sizes, it does not influence the choice of the element size.
constexpr double kMaxSizes = 1000.0;
/// Smallest step between values with few digits, as a fraction of the value.
constexpr double kSmallestStepFraction = 1e-9;

}  // namespace

WholeSizes::WholeSizes(const design::Design& design, const Parameter& parameter) {
  if (design.elements() == nullptr || design.is_infinite() || design.part().substrate) return;
  if (!std::holds_alternative<geometry::RtpElement>(design.part().element)) return;
  const geometry::ArrayLayout& array = design.part().array;
  if (array.arrangement == geometry::Arrangement::single || array.outline) return;
  for (const std::string& key : parameter.keys) {
    if (key == "element.base_mm")
      lengths_.push_back({array.x_length_mm - 2.0 * array.x_offset_mm + array.x_gap_mm, array.x_gap_mm});
    if (key == "element.width_mm")
      lengths_.push_back({array.y_length_mm - 2.0 * array.y_offset_mm + array.y_gap_mm, array.y_gap_mm});
  }
}

bool WholeSizes::divides(const Length& length, double size_mm) {
  const double count = length.room_mm / (size_mm + length.gap_mm);
  return count > 0.5 && std::abs(count - std::round(count)) <= kWhole * count;
}

bool WholeSizes::is_whole(double size_mm) const {
  return !lengths_.empty() &&
         std::ranges::all_of(lengths_, [&](const Length& length) { return divides(length, size_mm); });
}

std::vector<double> WholeSizes::between(double low_mm, double high_mm) const {
  std::vector<double> common;
  std::vector<double> single;
  for (const Length& length : lengths_) {
    const double most = std::floor(length.room_mm / (low_mm + length.gap_mm) + kWhole);
    const double least = std::max(1.0, std::ceil(length.room_mm / (high_mm + length.gap_mm) - kWhole));
    if (most - least > kMaxSizes) continue;
    for (double count = least; count <= most; count += 1.0) {
      const double size_mm = length.room_mm / count - length.gap_mm;
      (is_whole(size_mm) ? common : single).push_back(size_mm);
    }
  }
  std::vector<double>& sizes = common.empty() ? single : common;
  std::ranges::sort(sizes);
  const auto equal = [](double a, double b) { return std::abs(a - b) <= kWhole * std::abs(a); };
  const auto repeated = std::ranges::unique(sizes, equal);
  sizes.erase(repeated.begin(), repeated.end());
  return sizes;
}

std::vector<double> round_values(double value, double low, double high, const WholeSizes& whole) {
  std::vector<double> values;
  if (!(high > low)) return values;
  const double size = std::max(std::abs(low), std::abs(high));
  // The steps decrease from a power of ten that is at least as large as all values.
  const int first = static_cast<int>(std::ceil(std::log10(size)));
  for (int exponent = first; std::pow(10.0, exponent) > kSmallestStepFraction * size; --exponent)
    for (const double digit : {5.0, 2.0, 1.0}) {
      const double step = digit * std::pow(10.0, exponent);
      std::vector<double> near;
      for (const double count : {std::floor(value / step), std::ceil(value / step)}) {
        // The conversion to text and back removes rounding errors such as 0.30000000000000004.
        const double at = std::stod(fmt::format("{:.12g}", count * step));
        if (at >= low && at <= high && std::ranges::count(values, at) == 0 && std::ranges::count(near, at) == 0)
          near.push_back(at);
      }
      std::ranges::stable_sort(near, [&](double a, double b) {
        if (whole.is_whole(a) != whole.is_whole(b)) return whole.is_whole(a);
        return std::abs(a - value) < std::abs(b - value);
      });
      values.insert(values.end(), near.begin(), near.end());
    }
  return values;
}

}  // namespace retrace::studies
