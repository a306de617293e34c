#pragma once

// The map of height errors that programs leave on a part, seen from above.

#include <cstddef>
#include <vector>

#include "fabrication/job/job.h"
#include "fabrication/machine/machine.h"
#include "fabrication/read/nc_program.h"
#include "geometry/vec.h"

namespace retrace::fabrication {

/// What programs leave, seen from above, against the design: for pictures. Dexels of every element, cut apart from the
/// exact figures.
struct ErrorField {
  geometry::Vec2 low_mm = geometry::Vec2::Zero();  ///< of the array's extent, in the workpiece frame
  geometry::Vec2 size_mm = geometry::Vec2::Zero();
  std::size_t columns = 0;  ///< along x_w
  std::size_t rows = 0;     ///< the first at the largest y_w
  /// Height of what is left over the design's facets, along their normals; NaN on flat land. Row by row.
  std::vector<double> height_nm;
};

/// \param pixels along the longer side of the array \pre pixels >= 1
/// \throw InputError for a program that cannot be carried out
ErrorField error_field(const Job& job, const Machine& machine, const std::vector<NcProgram>& programs,
                       std::size_t pixels);

}  // namespace retrace::fabrication
