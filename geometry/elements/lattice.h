#pragma once

// The periodic tiling of the plane by cells that an arrangement of elements repeats.

#include <vector>

#include "geometry/elements/element_cells.h"

namespace retrace::geometry {

/// Cells that fill the plane without overlap when repeated with a rectangular period.
struct Lattice {
  Vec2 period_mm = Vec2::Zero();
  std::vector<Cell> cells;
  int elements_per_period = 0;
};

/// The element as it is: with its edges and its scratches.
Cell finished_cell(const Cell& cell, const PartSpec& spec);

/// The periodic tiling that an arrangement repeats. For RTP arrays the lower left corner of an element in row 1,
/// unshifted, is at the origin; for cube corners the apex of an unrotated cell is. `rows_are_shifted` is false for a
/// single row. \pre the arrangement fits the element and is not `single`.
Lattice make_lattice(const PartSpec& spec, bool rows_are_shifted);

}  // namespace retrace::geometry
