#include "studies/rre/adaptive_curve.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>
#include <utility>

namespace retrace::studies {
namespace {

/// Maximum number of known kinks. If there are more, as for many wavelengths at many azimuths, none of them is used.
/// The search must then find the kinks.
constexpr std::size_t kMaxKinks = 64;

double rounded(double value, double scale) {
  return std::round(value * scale) / scale + 0.0;  // -0 is 0
}

/// Returns a number with few decimals near the centre of an interval. Its distance from the centre is at most a
/// twentieth of the interval's length.
double middle_of(double low, double high) {
  const double middle = 0.5 * (low + high);
  for (double scale = 1.0; scale < 1e9; scale *= 10.0)
    if (std::abs(rounded(middle, scale) - middle) <= 0.05 * (high - low)) return rounded(middle, scale);
  return middle;
}

std::vector<CurveSpan> merged(std::vector<CurveSpan> spans) {
  std::sort(spans.begin(), spans.end(), [](const CurveSpan& a, const CurveSpan& b) { return a.low < b.low; });
  std::vector<CurveSpan> apart;
  for (const CurveSpan& span : spans)
    if (!apart.empty() && span.low <= apart.back().high)
      apart.back().high = std::max(apart.back().high, span.high);
    else
      apart.push_back(span);
  return apart;
}

/// Inserts points until no gap between neighbours is wider than kMaxGapDeg.
void fill(double low, double high, std::set<double>& places) {
  if (high - low <= AdaptiveCurve::kMaxGapDeg) return;
  const double middle = middle_of(low, high);
  places.insert(middle);
  fill(low, middle, places);
  fill(middle, high, places);
}

/// Returns the kinks rounded to 1e-6 degrees, without duplicates.
std::vector<double> without_repeats(const std::vector<double>& kinks) {
  std::set<double> places;
  for (const double place : kinks) places.insert(rounded(place, 1e6));
  if (places.size() > kMaxKinks) return {};
  return {places.begin(), places.end()};
}

}  // namespace

AdaptiveCurve::AdaptiveCurve(std::vector<CurveSpan> spans, const std::vector<double>& kinks,
                             const std::vector<double>& fixed, double tolerance)
    : tolerance_(tolerance) {
  for (const double place : fixed) values_[place];
  spans = merged(std::move(spans));
  max_points_ = fixed.size() + spans.size() * kMaxPoints;
  for (const CurveSpan& span : spans) begin(span, without_repeats(kinks));
  check_gaps(std::exchange(gaps_, {}));
}

void AdaptiveCurve::begin(const CurveSpan& span, const std::vector<double>& kinks) {
  std::set<double> places = {span.low, span.high};
  const auto add_if_inside = [&](double place) {
    if (place > span.low && place < span.high) places.insert(place);
  };
  add_if_inside(0.0);
  for (const double place : kinks) add_if_inside(place);
  for (const auto& [place, values] : values_) add_if_inside(place);
  const std::vector<double> apart(places.begin(), places.end());
  for (std::size_t i = 1; i < apart.size(); ++i) fill(apart[i - 1], apart[i], places);
  for (auto place = places.begin(); place != places.end(); ++place) {
    values_[*place];
    if (place != places.begin()) gaps_.push_back({*std::prev(place), *place});
  }
}

double AdaptiveCurve::interpolation_error_of(const Gap& gap) const {
  const double middle = middle_of(gap.low, gap.high);
  const double share = (middle - gap.low) / (gap.high - gap.low);
  const auto& low = values_.at(gap.low);
  const auto& high = values_.at(gap.high);
  const auto& found = values_.at(middle);
  double most = 0.0;
  for (std::size_t curve = 0; curve < found.size(); ++curve) {
    const double line = (1.0 - share) * low[curve].value + share * high[curve].value;
    const double std_error =
        std::hypot(found[curve].std_error, (1.0 - share) * low[curve].std_error, share * high[curve].std_error);
    most = std::max(most, std::abs(found[curve].value - line) - 2.0 * std_error);
  }
  return most;
}

void AdaptiveCurve::check_gaps(std::vector<Gap> gaps) {
  std::erase_if(gaps, [](const Gap& gap) { return gap.high - gap.low < kMinGapDeg; });
  std::stable_sort(gaps.begin(), gaps.end(),
                   [](const Gap& a, const Gap& b) { return a.interpolation_error > b.interpolation_error; });
  const std::size_t room = max_points_ - std::min(max_points_, values_.size());
  if (gaps.size() > room) {
    residual_error_ = std::max(residual_error_, gaps[room].interpolation_error);
    gaps.resize(room);
  }
  for (const Gap& gap : gaps) values_[middle_of(gap.low, gap.high)];
  gaps_ = std::move(gaps);
}

std::vector<double> AdaptiveCurve::next() {
  if (has_begun_) {
    std::vector<Gap> halves;
    for (const Gap& gap : gaps_) {
      const double miss = interpolation_error_of(gap);
      const double middle = middle_of(gap.low, gap.high);
      const bool is_straight = miss <= 0.5 * tolerance_;
      if (is_straight && gap.parent_passed) continue;
      halves.insert(halves.end(), {{gap.low, middle, miss, is_straight}, {middle, gap.high, miss, is_straight}});
    }
    check_gaps(std::move(halves));
  }
  has_begun_ = true;
  std::vector<double> places;
  for (const auto& [place, values] : values_)
    if (values.empty()) places.push_back(place);
  return places;
}

}  // namespace retrace::studies
