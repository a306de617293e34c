#include "fabrication/turning/check/inspection.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/threads.h"
#include "fabrication/turning/check/deviation_map.h"
#include "fabrication/turning/finish.h"

namespace retrace::fabrication::turning {
namespace {

using geometry::FreeformSurface;
using geometry::Zone;
using jets::Gradient;
using jets::line_series;
using jets::Series;

using geometry::Vec2;
constexpr int kGoldenSteps = 40;
/// Minimum distance from the centre, as a multiple of the feed per turn, at which the closed forms for cusps are valid.
/// Closer to the centre, the direction of the cut changes too much along a cusp.
constexpr double kCentreFeeds = 20.0;

/// Returns the predicted height of cusps along the surface normal. In the plane across the cuts, both the nose and the
/// surface are approximated by circles.
double predicted_nm(const FreeformSurface& design, TurningTool tool, const Vec2& at, const Vec2& outward,
                    double feed_mm, bool is_spiral) {
  // The inward motion of a spiral has the effect of an additional skew.
  if (is_spiral) tool.skew_deg += std::atan(feed_mm / (2.0 * std::numbers::pi * at.norm())) * 180.0 / std::numbers::pi;
  const Series<double> z = design.evaluate(line_series(at.x(), outward.x(), 2), line_series(at.y(), outward.y(), 2));
  const Gradient g = design.gradient(at.x(), at.y());
  const double length = std::sqrt(1.0 + z[1] * z[1]);
  const double curvature = 2.0 * z[2] / (length * length * length);
  const FinishFigures f = finish_figures(effective_radius_mm(tool), feed_mm * length, curvature);
  return f.peak_to_valley_nm * length / std::sqrt(1.0 + g.x * g.x + g.y * g.y);
}

struct Extreme {
  double at = 0.0;
  double value = 0.0;
  bool is_peak = false;
};

}  // namespace

std::optional<CuspSample> cusps_at(const Envelope& envelope, const FreeformSurface& design, const TurningTool& tool,
                                   const Vec2& at_mm, const Vec2& outward, double feed_mm, bool is_spiral) {
  constexpr int kPerFeed = 16;
  constexpr int kFeeds = 3;
  const double step = feed_mm / kPerFeed;
  const Zone zone = design.zone_at(at_mm.x(), at_mm.y());
  std::vector<double> e;
  for (int i = 0; i <= kPerFeed * kFeeds; ++i) {
    const Vec2 p = at_mm + step * i * outward;
    const auto deviation = deviation_nm(envelope, design, p);
    if (!deviation || design.zone_at(p.x(), p.y()) != zone) return std::nullopt;
    e.push_back(*deviation);
  }
  const auto along = [&](double s) {
    const auto deviation = deviation_nm(envelope, design, at_mm + s * outward);
    return deviation ? *deviation : -std::numeric_limits<double>::infinity();
  };
  std::vector<Extreme> extremes;
  for (std::size_t i = 1; i + 1 < e.size(); ++i) {
    const double a = step * static_cast<double>(i - 1);
    const double b = step * static_cast<double>(i + 1);
    if (e[i] > e[i - 1] && e[i] >= e[i + 1]) {
      const auto [at, value] = largest_between(along, a, b, kGoldenSteps);
      extremes.push_back({at, value, true});
    }
    if (e[i] < e[i - 1] && e[i] <= e[i + 1]) {
      const auto [at, value] = largest_between([&](double s) { return -along(s); }, a, b, kGoldenSteps);
      extremes.push_back({at, -value, false});
    }
  }
  CuspSample sample;
  sample.at_mm = at_mm + 0.5 * kFeeds * feed_mm * outward;
  int cusps = 0;
  bool is_even = true;
  const auto predicted = [&](double s) {
    return predicted_nm(design, tool, at_mm + s * outward, outward, feed_mm, is_spiral);
  };
  for (std::size_t i = 0; i < extremes.size(); ++i) {
    if (!extremes[i].is_peak) {
      if (std::abs(extremes[i].value) > std::abs(sample.valley_nm)) sample.valley_nm = extremes[i].value;
    } else if (i > 0 && i + 1 < extremes.size() && !extremes[i - 1].is_peak && !extremes[i + 1].is_peak) {
      sample.scallop_nm += extremes[i].value - 0.5 * (extremes[i - 1].value + extremes[i + 1].value);
      const double before = predicted(extremes[i - 1].at);
      const double after = predicted(extremes[i + 1].at);
      sample.predicted_nm += predicted(extremes[i].at);
      // The closed form requires a curvature that is nearly constant between neighbouring cuts.
      is_even = is_even && std::abs(after - before) < 0.02 * before;
      ++cusps;
    }
  }
  if (cusps == 0) return std::nullopt;
  sample.scallop_nm /= cusps;
  sample.predicted_nm = is_even ? sample.predicted_nm / cusps : 0.0;
  return sample;
}

namespace {

/// Returns the positions of the short profiles and their directions across the cuts. The positions are evenly
/// distributed, but not at multiples of the feed.
std::vector<std::pair<Vec2, Vec2>> profile_places(const InspectedRegion& region) {
  std::vector<std::pair<Vec2, Vec2>> places;
  constexpr int kAround = 24;
  constexpr int kAcross = 12;
  const double rim = kRimFeeds * region.feed_mm;
  for (int i = 0; i < kAcross; ++i)
    for (int k = 0; k < kAround; ++k) {
      const double share = (i + 0.37 + 0.4 * k / kAround) / kAcross;
      if (region.is_round) {
        const double centre = std::min(kCentreFeeds * region.feed_mm, 0.5 * region.radius_mm);
        const double r = centre + share * (region.radius_mm - centre - 2.0 * rim);
        const double angle = 2.0 * std::numbers::pi * (k + 0.31 * i) / kAround;
        const Vec2 outward(std::cos(angle), std::sin(angle));
        // Omit profiles within one feed of the spindle's axis, because the edge hardly moves over the part there.
        if (r > region.feed_mm) places.emplace_back(r * outward, outward);
      } else {
        const double x = (2.0 * share - 1.0) * (region.half_height_mm - 2.0 * rim);
        const double y = (2.0 * (k + 0.5) / kAround - 1.0) * (region.half_width_mm - rim);
        places.emplace_back(Vec2(x, y), Vec2::UnitX());
      }
    }
  return places;
}

}  // namespace

Inspection inspect(const Envelope& envelope, const FreeformSurface& design, const TurningTool& tool,
                   const InspectedRegion& region, std::size_t pixels) {
  Inspection result;
  fill_map(result, envelope, design, region, pixels);
  const auto places = profile_places(region);
  std::vector<std::optional<CuspSample>> samples(places.size());
  for_each_in_parallel(places.size(), [&](std::size_t i) {
    samples[i] = cusps_at(envelope, design, tool, places[i].first, places[i].second, region.feed_mm, region.is_round);
  });
  for (const auto& sample : samples) {
    if (!sample) continue;
    result.cusps.push_back(*sample);
    if (sample->predicted_nm > 0.0) {
      const double ratio = sample->scallop_nm / sample->predicted_nm;
      const bool is_first = result.compared++ == 0;
      result.scallop_ratio_low = is_first ? ratio : std::min(result.scallop_ratio_low, ratio);
      result.scallop_ratio_high = is_first ? ratio : std::max(result.scallop_ratio_high, ratio);
    }
    result.form_error_nm = std::max(result.form_error_nm, std::abs(sample->valley_nm));
    result.interference_nm = std::max(result.interference_nm, -sample->valley_nm);
    result.scallop_nm_max = std::max(result.scallop_nm_max, sample->scallop_nm);
    result.scallop_nm += sample->scallop_nm;
  }
  if (!result.cusps.empty()) result.scallop_nm /= static_cast<double>(result.cusps.size());
  return result;
}

}  // namespace retrace::fabrication::turning
