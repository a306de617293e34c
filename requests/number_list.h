#pragma once

// Reads lists of angles and lengths from the command line, such as 0:40:5 or -40:40:auto.

#include <array>
#include <string_view>
#include <vector>

#include "core/field.h"

namespace retrace::requests {

/// Reads a list of numbers `a,b,c` and ranges `start:stop:step`. The values of a range are start + i * step. They
/// include stop if stop is a whole number of steps away from start. Duplicates are removed.
/// \param field field that is named in error messages
/// \throw InputError if the list is empty, has more than 100,000 values, or contains text that is not a finite number
/// \throw InputError if the step of a range is 0 or leads from start away from stop
std::vector<double> read_number_list(std::string_view text, Field field);

/// List of numbers that may contain ranges `start:stop:auto`, in which the program chooses the points.
struct CurveList {
  std::vector<double> values;
  std::vector<std::array<double, 2>> chosen;  ///< start and stop of each range `start:stop:auto`; start < stop
};

/// Reads a list like read_number_list(), in which ranges `start:stop:auto` are also allowed.
/// \throw InputError like read_number_list(); also if start >= stop in a range `start:stop:auto`
CurveList read_curve_list(std::string_view text, Field field);

}  // namespace retrace::requests
