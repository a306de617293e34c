#pragma once

// Parameters of the interference of light from different cells of an infinite array.

#include <vector>

namespace retrace::raytrace {

/// Random differences between the cells of an array, and the coherence of the light. The differences are Gaussian and
/// independent from cell to cell (docs/theory/coherence_between_cells.md).
struct CellInterference {
  double depth_spread_mm = 0.0;    ///< standard deviation of the depth of a cell
  double spacing_spread_mm = 0.0;  ///< standard deviation of the position of a cell, along x and along y
  double index = 1.0;              ///< refractive index of the part
  /// Wavelengths that divide the light of the far field into bands of equal flux, in ascending order. They include both
  /// ends of its spectrum. If the list is empty, the light has a single wavelength.
  std::vector<double> band_nm;
};

}  // namespace retrace::raytrace
