#pragma once

// Averages far fields over the discs (apertures) of source and receiver, at all points of a square grid of directions.

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "core/progress.h"
#include "geometry/vec.h"
#include "raytrace/observers/aperture_kernel.h"
#include "raytrace/observers/far_field.h"

namespace retrace::raytrace {

/// Square grid in the x and y components of unit vectors. Points are stored row by row, with ascending y and x.
struct CosineSquare {
  geometry::Vec2 middle = geometry::Vec2::Zero();
  double half_width = 0.0;  ///< > 0
  std::size_t columns = 2;  ///< and rows; >= 2

  geometry::Vec2 at(std::size_t index) const;
};

/// A far field and the weights with which it contributes to three bands, such as red, green and blue.
struct BandedField {
  const FarField* field = nullptr;
  std::array<double, 3> weights{};
};

/// Returns the intensity per steradian of each band at each grid point, averaged over the discs of source and receiver.
/// The intensity of a band is the sum of FarField::intensity() over all fields, each times its weight for the band. The
/// error is at most 2e-4 of the maximum. Points below the horizon have the value 0.
/// The diffracted light is computed one time, on a lattice that resolves its details. The averages are sums over the
/// points of this lattice (docs/theory/appearance.md). If the computation is cancelled, the result is invalid.
/// \pre all fields have the same direction of incident light
std::vector<std::array<double, 3>> disc_means(std::span<const BandedField> fields, const CosineSquare& square,
                                              const ApertureKernel& kernel, const Cancellation* cancel);

}  // namespace retrace::raytrace
