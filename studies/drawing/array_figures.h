#pragma once

// Positions and pitches of an array that its drawing shows and dimensions.

#include "geometry/part/part.h"
#include "studies/design/design.h"

namespace retrace::studies {

/// Where the elements of an array lie, in mm of the part frame; an endless array's extent is one period.
struct ArrayFigures {
  geometry::Rectangle extent_mm;
  geometry::Rectangle block_mm;                        ///< that elements fill; the rest of the extent is land
  geometry::Vec2 count = geometry::Vec2::Ones();       ///< elements along x and y, about
  geometry::Vec2 size_mm = geometry::Vec2::Zero();     ///< of one element in plan
  geometry::Vec2 pitch_mm = geometry::Vec2::Zero();    ///< prisms: from one to the next; cube corners: the period
  geometry::Vec2 element_mm = geometry::Vec2::Zero();  ///< of the element that is measured: corner, or apex of cubes
  geometry::Vec2 root_mm = geometry::Vec2::Zero();     ///< a point of its root in plan
  double section_y_mm = 0.0;                           ///< across its root
  double shift_mm = 0.0;                               ///< of every second row
  bool element_is_shifted = false;                     ///< with its row
  double aperture_mm = 0.0;                            ///< cube corners
  bool has_neighbours = false;                         ///< in the next column
};

/// \param part of that design
ArrayFigures array_figures(const Design& design, const geometry::Part& part);

}  // namespace retrace::studies
