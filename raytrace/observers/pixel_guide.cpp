#include "raytrace/observers/pixel_guide.h"

#include <algorithm>
#include <cmath>

#include "core/random.h"
#include "core/threads.h"

namespace retrace::raytrace {
namespace {

using geometry::Vec2;

/// Number of training samples of a whole picture per bin of a map. It determines the number of bins, which is at most
/// kMaxBins.
constexpr std::size_t kPathsPerBin = 32;
constexpr std::size_t kMaxBins = std::size_t{1} << 16U;
/// Weight of the expected mean of a bin, as a number of paths. It stabilizes the map, because few paths of a bin are
/// bright.
constexpr double kPathsOfPrior = 32.0;

// Positions within a period or a pixel are stored as 32-bit fractions. Integer overflow then removes whole periods.
constexpr double kWhole = 0x1p32;

std::uint64_t digits(double x) {
  return static_cast<std::uint64_t>(std::llround(x * kWhole));
}

std::uint32_t scaled_to(std::uint32_t within, std::uint64_t whole) {
  return static_cast<std::uint32_t>((std::uint64_t{within} * whole) >> 32U);
}

/// A map at all resolutions, from the finest to the coarsest. Each resolution is half of the preceding one.
using Pyramid = std::vector<PixelGuide::Bins>;

Pyramid pyramid(PixelGuide::Bins finest) {
  Pyramid levels = {std::move(finest)};
  while (levels.back().sums.size() > 1) levels.push_back(levels.back().coarser());
  return levels;
}

/// Returns the estimated means of the bins at each resolution of `found`. The estimate for a bin is a weighted mean of
/// the samples in the bin and of an expected value. The expected value is the estimate for the coarser bin that
/// contains the bin. If `like` is not null, the expected value is also multiplied by the ratio of the two bins' means
/// in `like`.
std::vector<std::vector<double>> means_of(const Pyramid& found,
                                          const std::vector<std::vector<double>>* like = nullptr) {
  std::vector<std::vector<double>> means(found.size());
  const PixelGuide::Bins& all = found.back();
  means.back() = {static_cast<double>(all.sums[0]) / std::max(1.0, static_cast<double>(all.counts[0]))};
  for (std::size_t level = found.size() - 1; level-- > 0;) {
    const PixelGuide::Bins& bins = found[level];
    for (std::size_t bin = 0; bin < bins.sums.size(); ++bin) {
      double expected = means[level + 1][bins.coarser(bin)];
      if (like != nullptr && expected > 0.0)
        expected *= (*like)[level][bin] / std::max((*like)[level + 1][bins.coarser(bin)], 1e-300);
      means[level].push_back((static_cast<double>(bins.sums[bin]) + kPathsOfPrior * expected) /
                             (static_cast<double>(bins.counts[bin]) + kPathsOfPrior));
    }
  }
  return means;
}

}  // namespace

PixelGuide::Bins::Bins(std::size_t across, std::size_t down)
    : columns(across), rows(down), sums(across * down, 0.0F), counts(across * down, 0.0F) {}

std::size_t PixelGuide::Bins::coarser(std::size_t bin) const {
  return bin / columns / 2 * ((columns + 1) / 2) + bin % columns / 2;
}

PixelGuide::Bins PixelGuide::Bins::coarser() const {
  Bins result((columns + 1) / 2, (rows + 1) / 2);
  for (std::size_t bin = 0; bin < sums.size(); ++bin) {
    result.sums[coarser(bin)] += sums[bin];
    result.counts[coarser(bin)] += counts[bin];
  }
  return result;
}

PixelGuide::PixelGuide(const Vec2& period_mm, std::size_t tiles, std::size_t paths) : period_mm_(period_mm) {
  const auto bins = static_cast<double>(std::clamp<std::size_t>(paths / kPathsPerBin, 1, kMaxBins));
  columns_ = static_cast<std::size_t>(std::max(1.0, std::sqrt(bins * period_mm.x() / period_mm.y())));
  rows_ = static_cast<std::size_t>(std::max(1.0, bins / static_cast<double>(columns_)));
  found_.assign(tiles, Bins(columns_, rows_));
  roots_.resize(tiles);
}

PixelGuide::Sample PixelGuide::sample(const Vec2& position_mm, std::uint32_t tile, float excess) const {
  const Vec2 periods = position_mm.cwiseQuotient(period_mm_);
  const std::size_t bin =
      bin_at(static_cast<std::uint32_t>(digits(periods.x())), static_cast<std::uint32_t>(digits(periods.y())));
  // The limit prevents an overflow of the sum over all paths.
  constexpr float kMaxSquare = 1e30F;
  return {static_cast<std::uint32_t>(tile * columns_ * rows_ + bin), std::min(excess * excess, kMaxSquare)};
}

void PixelGuide::train(const std::vector<Samples>& lists) {
  const std::size_t bins = columns_ * rows_;
  for (const Samples& samples : lists)
    for (const auto& [bin, square] : samples) {
      found_[bin / bins].sums[bin % bins] += square;
      found_[bin / bins].counts[bin % bins] += 1.0F;
    }
  Bins all(columns_, rows_);
  for (const Bins& tile : found_)
    for (std::size_t bin = 0; bin < bins; ++bin) {
      all.sums[bin] += tile.sums[bin];
      all.counts[bin] += tile.counts[bin];
    }
  const auto everywhere = means_of(pyramid(std::move(all)));
  mean_square_ = everywhere.back().front();
  for_each_in_parallel(found_.size(), [&](std::size_t tile) {
    const auto means = means_of(pyramid(found_[tile]), &everywhere);
    roots_[tile].clear();
    for (const double mean : means.front()) roots_[tile].push_back(static_cast<float>(std::sqrt(mean)));
  });
}

std::size_t PixelGuide::bin_at(std::uint32_t x, std::uint32_t y) const {
  return scaled_to(y, rows_) * columns_ + scaled_to(x, columns_);
}

std::array<std::uint32_t, 2> PixelGuide::candidate(std::size_t k, const Shift& shift) {
  constexpr std::uint64_t kStep = (std::uint64_t{1} << 32U) / kCandidates;
  return {static_cast<std::uint32_t>(k * kStep) + shift[0],
          static_cast<std::uint32_t>(k * kCandidateStep % kCandidates * kStep) + shift[1]};
}

double PixelGuide::roots_at(const PixelProjection& pixel, const Shift& shift, Weights& roots) const {
  const std::vector<float>& map = roots_[pixel.tile];
  const auto in_period = [&](const Vec2& mm) {
    return std::array{digits(mm.x() / period_mm_.x()), digits(mm.y() / period_mm_.y())};
  };
  const auto corner = in_period(pixel.corner_mm);
  const auto right = in_period(pixel.along_row_mm);
  const auto down = in_period(pixel.along_column_mm);
  double sum = 0.0;
  for (std::size_t k = 0; k < kCandidates; ++k) {
    const auto [x, y] = candidate(k, shift);
    const std::size_t bin =
        bin_at(static_cast<std::uint32_t>(corner[0]) + scaled_to(x, right[0]) + scaled_to(y, down[0]),
               static_cast<std::uint32_t>(corner[1]) + scaled_to(x, right[1]) + scaled_to(y, down[1]));
    roots[k] = static_cast<double>(map[bin]);
    sum += roots[k];
  }
  if (sum > 0.0) return sum;
  roots.fill(1.0);
  return kCandidates;
}

bool PixelGuide::reduces_noise(const PixelProjection& pixel) const {
  Weights roots;
  const double mean = roots_at(pixel, {}, roots) / kCandidates;
  double square = 0.0;
  for (const double root : roots) square += root * root / kCandidates;
  constexpr double kUneven = 2.0;
  constexpr double kFaint = 0.01;
  return square > kUneven * mean * mean && square > kFaint * mean_square_;
}

std::array<PixelGuide::Point, PixelGuide::kPointsPerPixel> PixelGuide::points(
    const PixelProjection& pixel, const std::array<std::uint32_t, 4>& random) const {
  const Shift shift = {random[0], random[1]};
  Weights roots;
  const double sum = roots_at(pixel, shift, roots);
  constexpr std::size_t kByMap = kPointsPerPixel / 2;
  constexpr std::size_t kEvenly = kPointsPerPixel - kByMap;
  // The same candidate may be selected by the uniform rule and by the map. The weight of a point is the reciprocal of
  // the expected number of its selections.
  const auto point_of = [&](std::size_t k) {
    const double even = static_cast<double>(kEvenly) / kCandidates;
    const auto [x, y] = candidate(k, shift);
    return Point{{unit_interval(x), unit_interval(y)}, 1.0 / (kCandidates * (even + kByMap * roots[k] / sum))};
  };
  std::array<Point, kPointsPerPixel> points;
  for (std::size_t k = 0; k < kEvenly; ++k)
    points[k] = point_of(std::min<std::size_t>(
        kCandidates - 1,
        static_cast<std::size_t>((static_cast<double>(k) + unit_interval(random[2])) / kEvenly * kCandidates)));
  std::size_t at = 0;
  double reached = roots[0];
  for (std::size_t k = 0; k < kByMap; ++k) {
    const double goal = (static_cast<double>(k) + unit_interval(random[3])) / kByMap * sum;
    while (reached <= goal && at + 1 < kCandidates) reached += roots[++at];
    points[kEvenly + k] = point_of(at);
  }
  return points;
}

}  // namespace retrace::raytrace
