#pragma once

// Diffraction of the light that returns to a camera, as a correction of geometrical optics.

#include <cstddef>
#include <vector>

#include "geometry/polygon.h"
#include "geometry/vec.h"
#include "raytrace/light/aperture_kernel.h"

namespace retrace::raytrace {

/// Approximate angular distribution of light that a cell returns in one direction and spreads by diffraction, averaged
/// over the discs of lamp and pupil. It is the average over the discs (ApertureKernel) plus a tail that falls with the
/// third power of the angle, as the mean diffraction pattern of an aperture does (docs/theory/images.md).
struct DiffractionBlur {
  double tail_fraction = 0.0;   ///< fraction of the light in the tail; 0 to 1
  double tail_width_rad = 1.0;  ///< angle at which the tail begins to fall; > 0

  /// Returns the blur for cells of a given width.
  /// \param reach_rad sum of the radii of both discs; > 0
  static DiffractionBlur for_cells(double width_mm, double wavelength_nm, double reach_rad);
  /// Returns the density per steradian at an angular separation. Its integral is 1.
  double per_sr(const ApertureKernel& kernel, double separation_rad) const;
};

/// Correction of the light of the lamp that comes back through the part: the light of geometrical optics is blurred and
/// multiplied by a gain. The gain varies slowly over the entrance face. It is interpolated bilinearly between the
/// points of a grid. By default, the light is not changed.
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
