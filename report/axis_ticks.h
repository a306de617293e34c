#pragma once

// Arithmetic of plot axes: ranges, round tick positions with their labels, and scales from values to drawing units.

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace retrace::report {

/// An interval of an axis. low < high is required when it is drawn.
struct Range {
  double low = 0.0;
  double high = 0.0;

  double span() const { return high - low; }
  bool contains(double value) const { return value >= low && value <= high; }
};

/// The ticks of an axis and their labels. Ticks are multiples of `step` (1, 2 or 5 times a power of ten) within a
/// range.
struct Ticks {
  double step = 0.0;
  std::vector<double> positions;    ///< in ascending order
  std::vector<std::string> labels;  ///< one label for each position; with the minus sign U+2212, and never "-0"
};

/// Maps values to drawing units along one axis. The low end of the range is mapped to `first`.
struct AxisScale {
  Range values;
  double first = 0.0;
  double last = 0.0;

  double at(double value) const { return first + (value - values.low) / values.span() * (last - first); }
};

/// Returns the smallest interval that contains all finite numbers in `values`, or nothing if there are none.
std::optional<Range> extent_of(std::span<const double> values);

/// Returns a range that can be drawn: ordered, limited to allowed values, and widened if its width is (nearly) zero.
Range drawable(Range range);

/// Returns the ticks within `range`, after the range has been changed by drawable().
/// \param max_intervals approximate maximum number of intervals
/// \pre max_intervals >= 1
Ticks make_ticks(Range range, int max_intervals);

/// Returns the smallest number not less than a value, apart from rounding errors, that is 1, 2 or 5 times a power of
/// ten.
/// \pre value > 0
double next_round_number(double value);

/// Returns the largest number that is 1, 2 or 5 times a power of ten and not greater than a value.
/// \pre value > 0
double previous_round_number(double value);

/// Returns a power of ten with its exponent as a superscript, such as "10²".
std::string power_with_superscript(int exponent);

/// Returns the labels of powers of ten on one axis. All labels have the same form: all digits, such as "100", if every
/// exponent is from -3 to 4, and otherwise superscripts, such as "10²" and "10⁵".
std::vector<std::string> decade_labels(const std::vector<int>& exponents);

/// Returns ticks at the powers of ten within a range. The range and the positions are decimal logarithms.
Ticks decade_ticks(Range decades);

/// Ticks of a logarithmic axis. Positions are decimal logarithms.
struct LogTicks {
  Ticks decades;              ///< powers of ten with labels, see decade_labels()
  std::vector<double> minor;  ///< 2 to 9 times powers of ten, in ascending order
};

/// Returns the ticks within a range of decimal logarithms. If the range contains many decades, only every second or
/// third decade has a label, and there are no minor ticks.
/// \param max_labels maximum number of labels; >= 2
LogTicks make_log_ticks(Range decades, int max_labels);

/// Returns the smallest range of whole decades that contains all values, or nothing if there are no values.
/// \param logarithms decimal logarithms of the values; logarithms that are not finite are ignored
/// \param max_decades number of decades below the highest one to which the range is limited
std::optional<Range> whole_decades(std::span<const double> logarithms, int max_decades);

/// Returns an axis range whose ends are ticks. The step of the ticks divides the data into at most about
/// `max_intervals` intervals. If the values are positive and their spread exceeds half of the maximum, the range starts
/// at 0, so that heights can be compared. Otherwise the range fits the values closely. Error bars that extend beyond
/// the range by less than a twentieth of a step are ignored.
/// \param data range of the values
/// \param with_errors range of the values with their error bars
Range rounded_range(Range data, Range with_errors, int max_intervals);

}  // namespace retrace::report
