#pragma once

// Contour lines of values on a grid of square cells.

#include <cstddef>
#include <vector>

#include "report/canvas.h"

namespace retrace::report {

/// Returns the lines on which values on a grid are equal to a level, by marching squares with linear interpolation
/// along the edges of the cells (W. E. Lorensen and H. E. Cline, Computer Graphics 21, 163 (1987), in two dimensions).
/// A closed line ends at its first point. Cells with a corner value that is not finite contain no line.
/// \param values values at the corners of the cells, row by row
/// \param columns number of values in a row, >= 1
/// \return points in units of the grid spacing: x is the column, y is the row
std::vector<std::vector<Point>> contour_lines(const std::vector<double>& values, std::size_t columns, double level);

}  // namespace retrace::report
