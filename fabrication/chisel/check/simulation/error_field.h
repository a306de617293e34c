#pragma once

// Computes a map of the height errors of a machined part, as seen along Z.

#include <cstddef>
#include <vector>

#include "fabrication/job/job.h"
#include "fabrication/machine/machine.h"
#include "fabrication/read/nc_program.h"
#include "geometry/vec.h"

namespace retrace::fabrication {

/// Height errors of the machined surface relative to the design, for pictures. They are computed with dexels,
/// independent of the exact simulation.
struct ErrorField {
  geometry::Vec2 low_mm = geometry::Vec2::Zero();  ///< low corner of the array's extent, in the workpiece frame
  geometry::Vec2 size_mm = geometry::Vec2::Zero();
  std::size_t columns = 0;  ///< number of columns along x_w
  std::size_t rows = 0;     ///< number of rows; the first row is at the largest y_w
  /// Height of the machined surface above the nearest designed facet, along its normal, row by row. NaN in flat areas
  /// between the elements.
  std::vector<double> height_nm;
};

/// Computes the height errors of the part that the programs produce.
/// \param pixels number of pixels along the longer side of the array
/// \pre pixels >= 1
/// \throw InputError for a program that cannot be simulated
ErrorField error_field(const Job& job, const Machine& machine, const std::vector<NcProgram>& programs,
                       std::size_t pixels);

}  // namespace retrace::fabrication
