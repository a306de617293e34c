#include "fabrication/turning/check/deviation_map.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/random.h"
#include "core/threads.h"

namespace retrace::fabrication::turning {
namespace {

using geometry::FreeformSurface;
using jets::Gradient;

using geometry::Vec2;
constexpr double kNanometresAMm = 1e6;
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr double kUncut = std::numeric_limits<double>::infinity();
constexpr int kMaxSamples = 12;
/// Pixel size, relative to the feed, below which single cusps are resolved.
constexpr double kResolved = 0.25;

/// Deviations in one pixel, in nm. They are NaN outside of the region, and infinite where there is no cut.
struct Pixel {
  double any = kNone;       ///< deviation at one random point of the pixel
  double greatest = kNone;  ///< deviation with the largest absolute value
  double lowest = 0.0;
};

/// Evaluates random points of a pixel.
class PixelProbe {
 public:
  PixelProbe(const Envelope& envelope, const FreeformSurface& design, const InspectedRegion& region, const Vec2& low,
             double side, std::uint32_t number)
      : envelope_(envelope), design_(design), region_(region), low_(low), side_(side), number_(number) {}

  Vec2 drawn(std::uint32_t sample) const {
    const auto words = philox(RandomKey{}, number_, sample);
    return low_ + side_ * Vec2(unit_interval(words[0]), unit_interval(words[1]));
  }

  /// Evaluates a point and updates the pixel.
  /// \return the deviation, or NaN if the point is not inspected
  double take(const Vec2& p) {
    if (!is_inspected(region_, p)) return kNone;
    const double e = deviation_nm(envelope_, design_, p).value_or(kUncut);
    if (std::isnan(pixel_.greatest) || std::abs(e) > std::abs(pixel_.greatest)) pixel_.greatest = e;
    pixel_.lowest = std::min(pixel_.lowest, e);
    return e;
  }

  Pixel found() {
    const Vec2 first = drawn(0);
    pixel_.any = take(first);
    const double per_feed = side_ / region_.feed_mm;
    if (per_feed >= kResolved)
      take_feed_through(first);
    else
      for (int k = 1; k < std::ceil(kMaxSamples * per_feed); ++k) take(drawn(static_cast<std::uint32_t>(k)));
    return pixel_;
  }

 private:
  /// Evaluates a short profile across the cuts, and then searches between its samples for a larger deviation.
  void take_feed_through(const Vec2& at) {
    const Vec2 outward = region_.is_round && at.norm() > 0.0 ? Vec2(at.normalized()) : Vec2(Vec2::UnitX());
    const double step = region_.feed_mm / kMaxSamples;
    double best = 0.0;
    double most = -1.0;
    const auto size_at = [&](double s) {
      const double e = std::abs(take(at + s * outward));
      return std::isnan(e) ? -1.0 : e;
    };
    for (int k = 0; k < kMaxSamples; ++k) {
      const double s = step * (k - 0.5 * kMaxSamples);
      const double size = size_at(s);
      if (size > most) {
        most = size;
        best = s;
      }
    }
    constexpr int kSteps = 10;
    largest_between(size_at, best - step, best + step, kSteps);
  }

  const Envelope& envelope_;
  const FreeformSurface& design_;
  const InspectedRegion& region_;
  Vec2 low_;
  double side_;
  std::uint32_t number_;
  Pixel pixel_;
};

}  // namespace

std::optional<double> deviation_nm(const Envelope& envelope, const FreeformSurface& design, const Vec2& p) {
  const auto height = envelope.height_mm(p.x(), p.y());
  if (!height) return std::nullopt;
  const Gradient z = design.gradient(p.x(), p.y());
  return (*height - z.value) / std::sqrt(1.0 + z.x * z.x + z.y * z.y) * kNanometresAMm;
}

std::pair<double, double> largest_between(const std::function<double(double)>& f, double a, double b, int steps) {
  constexpr double kInverseGoldenRatio = 0.6180339887498949;
  double c = b - kInverseGoldenRatio * (b - a);
  double d = a + kInverseGoldenRatio * (b - a);
  double fc = f(c);
  double fd = f(d);
  for (int step = 0; step < steps; ++step) {
    if (fc > fd) {
      b = d;
      d = c;
      fd = fc;
      c = b - kInverseGoldenRatio * (b - a);
      fc = f(c);
    } else {
      a = c;
      c = d;
      fc = fd;
      d = a + kInverseGoldenRatio * (b - a);
      fd = f(d);
    }
  }
  return fc > fd ? std::pair(c, fc) : std::pair(d, fd);
}

bool is_inspected(const InspectedRegion& region, const Vec2& p) {
  const double rim = kRimFeeds * region.feed_mm;
  if (region.is_round) return p.norm() <= region.radius_mm - rim && p.norm() >= rim;
  return std::abs(p.x()) <= region.half_height_mm - rim && std::abs(p.y()) <= region.half_width_mm - rim;
}

void fill_map(Inspection& result, const Envelope& envelope, const FreeformSurface& design,
              const InspectedRegion& region, std::size_t pixels) {
  result.columns = pixels;
  result.map_width_mm =
      2.0 * (region.is_round ? region.radius_mm : std::max(region.half_height_mm, region.half_width_mm));
  const double side = result.map_width_mm / static_cast<double>(pixels);
  std::vector<Pixel> found(pixels * pixels);
  for_each_in_parallel(pixels, [&](std::size_t row) {
    for (std::size_t column = 0; column < pixels; ++column) {
      const std::size_t number = row * pixels + column;
      const Vec2 low(side * static_cast<double>(column) - 0.5 * result.map_width_mm,
                     0.5 * result.map_width_mm - side * static_cast<double>(row + 1));
      found[number] = PixelProbe(envelope, design, region, low, side, static_cast<std::uint32_t>(number)).found();
    }
  });
  double sum = 0.0;
  std::size_t count = 0;
  for (const Pixel& pixel : found) {
    result.map_nm.push_back(pixel.greatest);
    if (std::isinf(pixel.greatest)) throw InputError("the programs leave a region of the part uncut");
    result.interference_nm = std::max(result.interference_nm, -pixel.lowest);
    if (std::isnan(pixel.any)) continue;
    sum += pixel.any * pixel.any;
    ++count;
  }
  result.rms_nm = count > 0 ? std::sqrt(sum / static_cast<double>(count)) : 0.0;
}

}  // namespace retrace::fabrication::turning
