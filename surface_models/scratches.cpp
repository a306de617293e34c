#include "surface_models/scratches.h"
#include "surface_models/height_parameters.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace retrace::surface_models {
namespace {

constexpr std::size_t kStretches = 16;

/// Grid line of the map: its mean height and the mean heights of its sections. NaN where nothing was measured.
struct Line {
  double mean_nm = kMissing;
  std::array<double, kStretches> stretches_nm{};
};

constexpr double kSameSide = 0.75;
constexpr double kDeviations = 5.0;
/// Ratio of the standard deviation to the median absolute deviation of Gaussian values.
constexpr double kGaussianMad = 1.4826;
constexpr std::size_t kMinLines = 16;
/// Minimum number of lines on each side with which a line is compared.
constexpr double kMinNeighbourLines = 4.0;

Line line_of(const HeightMap& map, Axis along, std::size_t index) {
  const std::size_t points = along == Axis::x ? map.columns : map.rows;
  std::array<double, kStretches> sum{};
  std::array<double, kStretches> count{};
  for (std::size_t i = 0; i < points; ++i) {
    const double z = along == Axis::x ? map.at(i, index) : map.at(index, i);
    if (!std::isfinite(z)) continue;
    sum[i * kStretches / points] += z;
    count[i * kStretches / points] += 1.0;
  }
  Line line;
  double all = 0.0;
  double measured = 0.0;
  for (std::size_t s = 0; s < kStretches; ++s) {
    line.stretches_nm[s] = count[s] > 0.0 ? sum[s] / count[s] : kMissing;
    all += sum[s];
    measured += count[s];
  }
  if (2.0 * measured >= static_cast<double>(points)) line.mean_nm = all / measured;
  return line;
}

/// Returns true if most sections of a line deviate in the same direction as its mean.
bool is_consistent(const Line& line, double beside_nm) {
  const double side = line.mean_nm < beside_nm ? -1.0 : 1.0;
  double same = 0.0;
  double measured = 0.0;
  for (const double z : line.stretches_nm) {
    if (!std::isfinite(z)) continue;
    measured += 1.0;
    // A section counts if its depth is more than half of the line's mean depth. A few deep points are therefore not a
    // scratch.
    if (side * (z - beside_nm) > 0.5 * side * (line.mean_nm - beside_nm)) same += 1.0;
  }
  return same >= kSameSide * measured;
}

/// Returns the reference height for each line: the mean of the medians of the lines before and after it, `near` to
/// `far` lines away. Slopes cancel in this mean. The result is NaN if one of the medians is missing.
std::vector<double> beside(const std::vector<Line>& lines, std::size_t near, std::size_t far) {
  const auto median_of = [&](std::size_t begin, std::size_t end) {
    std::vector<double> means;
    for (std::size_t k = begin; k < std::min(end, lines.size()); ++k)
      if (std::isfinite(lines[k].mean_nm)) means.push_back(lines[k].mean_nm);
    return means.empty() ? kMissing : median(std::move(means));
  };
  std::vector<double> result;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const double before = i < near ? kMissing : median_of(i > far ? i - far : 0, i - near + 1);
    result.push_back(0.5 * (before + median_of(i + near, i + far + 1)));
  }
  return result;
}

}  // namespace

std::vector<Scratch> find_scratches(const HeightMap& roughness, Axis along, double neighbourhood_um) {
  const std::size_t count = along == Axis::x ? roughness.rows : roughness.columns;
  if (roughness.is_profile() || count < kMinLines) return {};
  const double pixel_um = along == Axis::x ? roughness.y_pixel_um : roughness.x_pixel_um;
  std::vector<Line> lines;
  for (std::size_t i = 0; i < count; ++i) lines.push_back(line_of(roughness, along, i));
  const auto far = static_cast<std::size_t>(std::max(kMinNeighbourLines, std::ceil(neighbourhood_um / pixel_um)));
  const std::vector<double> middles = beside(lines, far / 2, far);
  const auto depth = [&](std::size_t i) { return middles[i] - lines[i].mean_nm; };
  std::vector<double> deviations;
  for (std::size_t i = 0; i < count; ++i)
    if (std::isfinite(depth(i))) deviations.push_back(std::abs(depth(i)));
  if (deviations.size() < kMinLines) return {};
  const double limit = kDeviations * kGaussianMad * median(std::move(deviations));

  std::vector<Scratch> scratches;
  const auto stands_out = [&](std::size_t i) {
    return std::abs(depth(i)) > limit && is_consistent(lines[i], middles[i]);
  };
  for (std::size_t i = 0; i < count;) {
    if (!stands_out(i)) {
      ++i;
      continue;
    }
    // A scratch includes all neighbouring lines that deviate in the same direction.
    std::size_t deepest = i;
    std::size_t end = i;
    for (; end < count && stands_out(end) && (depth(end) > 0.0) == (depth(i) > 0.0); ++end)
      if (std::abs(depth(end)) > std::abs(depth(deepest))) deepest = end;
    const auto within = [&](std::size_t k) { return depth(k) / depth(deepest) >= 0.5; };
    std::size_t low = deepest;
    std::size_t high = deepest;
    while (low > 0 && within(low - 1)) --low;
    while (high + 1 < count && within(high + 1)) ++high;  // also ends at NaN, where there is no reference height
    scratches.push_back({along, static_cast<double>(deepest) * pixel_um, depth(deepest),
                         static_cast<double>(high - low + 1) * pixel_um});
    i = std::max(end, high + 1);
  }
  return scratches;
}

}  // namespace retrace::surface_models
