#pragma once

// Converts the spread of a design's cells to the units of the tracer.

#include "design/design.h"
#include "raytrace/observers/cell_interference.h"

namespace retrace::design {

/// Returns the parameters with which the fields of cells are added, for light of a single wavelength.
/// \param index refractive index of the part
inline raytrace::CellInterference interference_of(const CellSpread& spread, double index) {
  return {1e-6 * spread.depth_nm, 1e-6 * spread.spacing_nm, index, {}};
}

}  // namespace retrace::design
