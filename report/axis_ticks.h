#pragma once

// Arithmetic of plot axes: ranges, round tick positions with their labels, and scales from values to drawing units.

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace retrace::report {

/// An interval of an axis, low < high once it is drawn.
struct Range {
  double low = 0.0;
  double high = 0.0;

  double span() const { return high - low; }
  bool contains(double value) const { return value >= low && value <= high; }
};

/// The marks of an axis: multiples of `step` (1, 2 or 5 times a power of ten) inside a range, with what is written
/// there.
struct Ticks {
  double step = 0.0;
  std::vector<double> positions;    ///< rising
  std::vector<std::string> labels;  ///< as many as positions; a true minus sign (U+2212), never "-0"
};

/// Maps values to drawing units along one axis; `first` belongs to the low end.
struct AxisScale {
  Range values;
  double first = 0.0;
  double last = 0.0;

  double at(double value) const { return first + (value - values.low) / values.span() * (last - first); }
};

/// The smallest interval that holds every finite number in `values`; nothing if there is none.
std::optional<Range> extent_of(std::span<const double> values);

/// `range` in order, within what can be drawn, and widened about its middle if it is (nearly) a single point.
Range drawable(Range range);

/// The ticks inside `range` (made drawable first): at most about `most` intervals. \pre most >= 1
Ticks make_ticks(Range range, int most);

/// A range for values that spread over `data` and whose error bars reach over `with_errors`: its ends lie on ticks for
/// `most` intervals. Starts at 0 when the values are positive and spread over more than half of their largest, so that
/// heights compare; otherwise it is snug. Error bars that stick out by less than a twentieth of a step change nothing.
Range rounded_range(Range data, Range with_errors, int most);

}  // namespace retrace::report
