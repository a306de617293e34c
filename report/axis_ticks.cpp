#include "report/axis_ticks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/number_format.h"

namespace retrace::report {
namespace {

/// Maximum magnitude of values that are drawn. The difference of two larger values could overflow.
constexpr double kLargest = 1e300;
/// Minimum width of a range, relative to its values. Narrower ranges are rounding noise.
constexpr double kNarrowest = 1e-9;
/// Maximum distance between a value and a tick, in steps, at which the value counts as being on the tick.
constexpr double kOnTick = 1e-6;

/// A step of 1, 2 or 5 times an integer power of ten. It is stored as integers, so that its multiples are the nearest
/// doubles: 0.3, not 0.30000000000000004.
struct NiceStep {
  int mantissa = 1;
  int exponent = 0;

  double times(double count) const {
    const double units = count * mantissa;
    return exponent < 0 ? units / std::pow(10.0, -exponent) : units * std::pow(10.0, exponent);
  }
  NiceStep next() const {
    if (mantissa == 1) return {2, exponent};
    if (mantissa == 2) return {5, exponent};
    return {1, exponent + 1};
  }
  NiceStep previous() const {
    if (mantissa == 5) return {2, exponent};
    if (mantissa == 2) return {1, exponent};
    return {5, exponent - 1};
  }
};

/// Returns the smallest nice step that divides `span` into at most `most` intervals.
NiceStep nice_step(double span, int most) {
  const double wanted = span / most;
  NiceStep step{1, static_cast<int>(std::floor(std::log10(wanted))) - 1};
  while (step.times(1.0) < wanted * (1.0 - kOnTick)) step = step.next();
  return step;
}

std::string with_true_minus(std::string text) {
  if (!text.empty() && text.front() == '-') text.replace(0, 1, "\u2212");
  return text;
}

/// Returns true if a power of ten is written with all its digits instead of a superscript.
bool has_few_digits(int exponent) {
  return exponent >= -3 && exponent <= 4;
}

/// Returns the labels of ticks, with the number of digits that the step requires. Labels of very large and very small
/// values have an exponent, which is the same for all labels.
std::vector<std::string> tick_labels(const std::vector<double>& positions, NiceStep step) {
  double largest = 0.0;
  for (const double position : positions) largest = std::max(largest, std::abs(position));
  const int magnitude = largest > 0.0 ? static_cast<int>(std::floor(std::log10(largest) + kNarrowest)) : 0;
  const bool with_exponent = magnitude > 6 || step.exponent < -6;

  std::vector<std::string> labels;
  for (const double position : positions) {
    std::string label;
    if (with_exponent && position != 0.0) {
      const double mantissa = position / std::pow(10.0, magnitude);
      label = fmt::format("{}e{}", fixed(mantissa, std::clamp(magnitude - step.exponent, 0, 12)), magnitude);
    } else {
      label = with_exponent ? "0" : fixed(position, std::max(0, -step.exponent));
    }
    labels.push_back(with_true_minus(label));
  }
  return labels;
}

}  // namespace

std::optional<Range> extent_of(std::span<const double> values) {
  std::optional<Range> extent;
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    if (!extent) extent = Range{value, value};
    extent->low = std::min(extent->low, value);
    extent->high = std::max(extent->high, value);
  }
  return extent;
}

Range drawable(Range range) {
  if (!std::isfinite(range.low) || !std::isfinite(range.high)) return {0.0, 1.0};
  if (range.low > range.high) std::swap(range.low, range.high);
  range.low = std::clamp(range.low, -kLargest, kLargest);
  range.high = std::clamp(range.high, -kLargest, kLargest);
  const double magnitude = std::max(std::abs(range.low), std::abs(range.high));
  if (magnitude < 1.0 / kLargest) return {-1.0, 1.0};
  if (range.span() >= kNarrowest * magnitude) return range;
  const double middle = range.low + 0.5 * range.span();
  const double half = 0.05 * magnitude;
  return {middle - half, middle + half};
}

Ticks make_ticks(Range range, int max_intervals) {
  range = drawable(range);
  NiceStep step = nice_step(range.span(), max_intervals);
  // If the step is larger than the range, there may be no tick in the range.
  if (step.times(1.0) > range.span()) step = step.previous();
  Ticks ticks;
  ticks.step = step.times(1.0);
  const double first = std::ceil(range.low / ticks.step - kOnTick);
  const double last = std::floor(range.high / ticks.step + kOnTick);
  for (double count = first; count <= last; count += 1.0) {
    // Adding 0 converts -0 to 0.
    ticks.positions.push_back(step.times(count) + 0.0);
  }
  ticks.labels = tick_labels(ticks.positions, step);
  return ticks;
}

double next_round_number(double value) {
  NiceStep step{1, static_cast<int>(std::floor(std::log10(value)))};
  while (step.times(1.0) < value * (1.0 - kNarrowest)) step = step.next();
  return step.times(1.0);
}

double previous_round_number(double value) {
  NiceStep step{1, static_cast<int>(std::floor(std::log10(value)))};
  while (step.next().times(1.0) <= value) step = step.next();
  return step.times(1.0);
}

std::string power_with_superscript(int exponent) {
  static constexpr const char* kDigits[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string text = "10";
  for (const char c : std::to_string(exponent)) text += c == '-' ? "⁻" : kDigits[c - '0'];
  return text;
}

std::vector<std::string> decade_labels(const std::vector<int>& exponents) {
  const bool has_digits = std::ranges::all_of(exponents, has_few_digits);
  std::vector<std::string> labels;
  for (const int exponent : exponents)
    labels.push_back(has_digits ? fixed(std::pow(10.0, exponent), std::max(0, -exponent))
                                : power_with_superscript(exponent));
  return labels;
}

Ticks decade_ticks(Range decades) {
  Ticks ticks;
  ticks.step = 1.0;
  std::vector<int> exponents;
  for (int e = static_cast<int>(std::ceil(decades.low - kOnTick)); e <= std::floor(decades.high + kOnTick); ++e) {
    exponents.push_back(e);
    ticks.positions.push_back(e);
  }
  ticks.labels = decade_labels(exponents);
  return ticks;
}

LogTicks make_log_ticks(Range decades, int max_labels) {
  LogTicks ticks;
  const int first = static_cast<int>(std::ceil(decades.low - kOnTick));
  const int last = static_cast<int>(std::floor(decades.high + kOnTick));
  int every = 1;
  while ((last - first) / every + 1 > max_labels) ++every;
  ticks.decades.step = every;
  std::vector<int> exponents;
  for (int e = first; e <= last; ++e) {
    if ((last - e) % every != 0) continue;
    exponents.push_back(e);
    ticks.decades.positions.push_back(e);
  }
  ticks.decades.labels = decade_labels(exponents);
  if (every > 1) return ticks;
  for (int e = first - 1; e <= last; ++e)
    for (int m = 2; m <= 9; ++m) {
      const double at = e + std::log10(static_cast<double>(m));
      if (decades.contains(at)) ticks.minor.push_back(at);
    }
  return ticks;
}

std::optional<Range> whole_decades(std::span<const double> logarithms, int max_decades) {
  const std::optional<Range> extent = extent_of(logarithms);
  if (!extent) return std::nullopt;
  Range range{std::floor(extent->low + kOnTick), std::ceil(extent->high - kOnTick)};
  if (range.span() < 1.0) range.high = range.low + 1.0;
  range.low = std::max(range.low, range.high - max_decades);
  return range;
}

Range rounded_range(Range data, Range with_errors, int max_intervals) {
  if (data.low == 0.0 && data.high == 0.0) data.high = 1.0;
  data = drawable(data);
  if (data.low >= 0.0 && data.span() > 0.5 * data.high) data.low = 0.0;
  constexpr double error_slack = 0.05;
  const NiceStep step = nice_step(data.span(), max_intervals);
  const double size = step.times(1.0);
  double first = std::floor(data.low / size + kOnTick);
  double last = std::ceil(data.high / size - kOnTick);
  if (std::isfinite(with_errors.low)) first = std::min(first, std::floor(with_errors.low / size + error_slack));
  if (std::isfinite(with_errors.high)) last = std::max(last, std::ceil(with_errors.high / size - error_slack));
  return drawable({step.times(first) + 0.0, step.times(last) + 0.0});
}

}  // namespace retrace::report
