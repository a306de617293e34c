#pragma once

// What discs of source and receiver make of far fields, at all points of a square of directions.

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "core/progress.h"
#include "geometry/vec.h"
#include "raytrace/observers/aperture_kernel.h"
#include "raytrace/observers/far_field.h"

namespace retrace::raytrace {

/// Points over x and y of unit vectors, row by row of rising y, x rising.
struct CosineSquare {
  geometry::Vec2 middle = geometry::Vec2::Zero();
  double half_width = 0.0;  ///< > 0
  std::size_t columns = 2;  ///< and rows; >= 2

  geometry::Vec2 at(std::size_t index) const;
};

/// A far field, and what its intensities count in each of three bands, such as red, green and blue.
struct BandedField {
  const FarField* field = nullptr;
  std::array<double, 3> weights{};
};

/// Of each point and band the sum over fields of weight x FarField::intensity(), per steradian, within 2e-4 of the
/// greatest; 0 below the horizon. What is diffracted is worked out once, on a lattice as fine as its details, and means
/// over the discs are sums over that lattice (docs/theory/appearance.md). Of no use if it was cancelled. \pre the
/// fields are of one direction of light
std::vector<std::array<double, 3>> disc_means(std::span<const BandedField> fields, const CosineSquare& square,
                                              const ApertureKernel& kernel, const Cancellation* cancel);

}  // namespace retrace::raytrace
