#pragma once

// Averages of far fields over the discs (apertures) of source and receiver, for all directions of a square grid.

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "core/progress.h"
#include "geometry/vec.h"
#include "raytrace/light/aperture_kernel.h"
#include "raytrace/observers/far_field.h"

namespace retrace::raytrace {

/// Square grid of directions, given by the x and y components of unit vectors. Its points are ordered row by row. y
/// increases with the row, and x with the column.
struct CosineSquare {
  geometry::Vec2 centre = geometry::Vec2::Zero();
  double half_width = 0.0;  ///< > 0
  std::size_t columns = 2;  ///< number of columns and of rows; >= 2

  geometry::Vec2 at(std::size_t index) const;
};

/// A far field, and the weights with which it is added to three bands such as red, green and blue.
struct BandedField {
  const FarField* field = nullptr;
  std::array<double, 3> weights{};
};

/// Returns the intensity per steradian of each band at each grid point, averaged over the discs of source and receiver.
/// The intensity of a band is the weighted sum of FarField::intensity() over all fields. The error is at most 2e-4 of
/// the maximum. Grid points below the horizon have the value 0.
///
/// The diffracted light is computed one time, on a lattice that is fine enough for its details. Each average is a sum
/// over the points of this lattice (docs/theory/appearance.md). The result is invalid if the computation was cancelled.
/// \pre all fields have the same direction of incident light
std::vector<std::array<double, 3>> disc_means(std::span<const BandedField> fields, const CosineSquare& square,
                                              const ApertureKernel& kernel, const Cancellation* cancel);

}  // namespace retrace::raytrace
