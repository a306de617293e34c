#pragma once

// Periodic tiling of the plane from which an arrangement of elements is built.

#include <vector>

#include "geometry/elements/element_cells.h"

namespace retrace::geometry {

/// Cells that tile the plane without overlap when they are repeated with a rectangular period.
struct Lattice {
  Vec2 period_mm = Vec2::Zero();
  std::vector<Cell> cells;
  int elements_per_period = 0;
  /// False if the cells cover a finite part without repeating. The period is then longer than the part.
  bool repeats = true;
};

/// Returns the element with its rounded edges and its scratches.
Cell finished_cell(const Cell& cell, const PartSpec& spec);

/// Returns the periodic tiling of an arrangement. The origin is the lower left corner of an unshifted prism in row 1,
/// or the apex of a cube corner that is not rotated.
/// \param rows_are_shifted false if there is a single row
/// \pre the arrangement fits the element and is not `single`
Lattice make_lattice(const PartSpec& spec, bool rows_are_shifted);

}  // namespace retrace::geometry
