#pragma once

// Reads lists of angles and lengths from the command line, such as 0:40:5 or -40:40:auto.

#include <string>
#include <string_view>
#include <vector>

namespace retrace::app {

/// Reads a LIST: `a,b,c` mixed with `start:stop:step`, stop included; values are start + i * step, duplicates are
/// dropped. \param option name for messages \throw InputError for an empty list, text that is no finite number, a range
/// that runs the wrong way, or more than 100,000 values
std::vector<double> read_number_list(std::string_view text, const std::string& option);

struct NumberRange {
  double low = 0.0;
  double high = 0.0;
};

/// A LIST in which `start:stop:auto` leaves numbers to be chosen.
struct CurveList {
  std::vector<double> values;
  std::vector<NumberRange> chosen;  ///< low < high
};

/// \throw InputError as read_number_list(), and for a range that is empty or runs down
CurveList read_curve_list(std::string_view text, const std::string& option);

}  // namespace retrace::app
