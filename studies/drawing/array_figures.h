#pragma once

// Positions and pitches of an array, for its drawing with dimension lines.

#include "design/design.h"
#include "geometry/part/part.h"

namespace retrace::studies {

/// Positions of the elements of an array, in mm of the part frame. The extent of an infinite array is one period.
struct ArrayFigures {
  geometry::Rectangle extent_mm;
  geometry::Rectangle block_mm;                      ///< block of elements; the remainder of the extent is flat
  geometry::Vec2 count = geometry::Vec2::Ones();     ///< approximate number of elements along x and y
  geometry::Vec2 size_mm = geometry::Vec2::Zero();   ///< size of one element in plan
  geometry::Vec2 pitch_mm = geometry::Vec2::Zero();  ///< prisms: distance of neighbours; cube corners: period
  /// Position of the dimensioned element: the corner of a prism, or the apex of a cube corner.
  geometry::Vec2 element_mm = geometry::Vec2::Zero();
  /// Point on the root of the dimensioned element, where its facets meet.
  geometry::Vec2 root_mm = geometry::Vec2::Zero();
  double section_y_mm = 0.0;        ///< y of the section, which goes through root_mm
  double shift_mm = 0.0;            ///< shift of every second row
  bool element_is_shifted = false;  ///< true: the dimensioned element is in a shifted row
  double aperture_mm = 0.0;         ///< aperture of cube corners
  bool has_neighbours = false;      ///< true: there are elements in the next column
};

/// Returns the positions and pitches of an array.
/// \param part part of the design
ArrayFigures array_figures(const design::Design& design, const geometry::Part& part);

}  // namespace retrace::studies
