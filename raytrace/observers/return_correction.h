#pragma once

// Diffraction of the light that returns to a camera, as a correction of geometrical optics.

#include <cstddef>
#include <vector>

#include "geometry/polygon.h"
#include "geometry/vec.h"
#include "raytrace/light/aperture_kernel.h"

namespace retrace::raytrace {

/// Approximate angular distribution of light that geometrical optics returns in one direction, after diffraction at a
/// cell and averaged over the discs of lamp and pupil. It is the weighted sum of the average over the discs
/// (ApertureKernel) and a tail. The tail falls with the third power of the angle, like the mean diffraction pattern of
/// an aperture (docs/theory/images.md).
struct DiffractionBlur {
  double tail_fraction = 0.0;   ///< fraction of the light in the tail; 0 to 1
  double tail_width_rad = 1.0;  ///< angle at which the tail begins to fall; > 0

  /// Returns the blur for cells of a given width.
  /// \param reach_rad sum of the radii of both discs; > 0
  static DiffractionBlur for_cells(double width_mm, double wavelength_nm, double reach_rad);
  /// Returns the density per steradian at an angular separation. Its integral is 1.
  double per_sr(const ApertureKernel& kernel, double separation_rad) const;
};

/// Correction of the lamp's light that the part returns: the light of geometrical optics is blurred and multiplied by a
/// gain. The gain varies slowly over the entrance face, and is interpolated bilinearly between the points of a grid.
/// The default is no correction.
struct ReturnCorrection {
  DiffractionBlur blur;
  geometry::Rectangle face_mm;  ///< area of the grid, in the frame of FacePoint::local_mm
  std::size_t columns = 1;      ///< number of grid points along x; >= 1
  std::size_t rows = 1;
  std::vector<double> gain = {1.0};  ///< row by row, with increasing y

  /// Returns the gain at a point. Outside of the grid, it is the gain of the nearest point of the grid's border.
  double gain_at(const geometry::Vec2& local_mm) const;
};

}  // namespace retrace::raytrace
