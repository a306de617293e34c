#pragma once

// Selection of the light that is traced in an excerpt of a larger part.

#include "geometry/part/element_excerpt.h"
#include "raytrace/exact/beam.h"

namespace retrace::raytrace {

/// Selects the light of one element of a larger part, which is traced in an excerpt around this element. Light belongs
/// to the element that it meets first, even if a side of the part has reflected the light before. Light that first
/// meets flat land belongs to the element through whose portion of the entrance face it entered. All other light is not
/// traced, and no account of the ledger contains its power. The sides of the larger part do not count as cells of the
/// back (CellTrail).
///
/// The larger part continues beyond the outline of the excerpt. Light that reaches the outline is not traced further,
/// and its power is added to `truncated`.
struct ExcerptLight {
  const geometry::ElementExcerpt& excerpt;
  /// Portion of the element on the entrance face. The polygons of the entrance face do not cross its border.
  const geometry::Polygon& portion_mm;

  geometry::ExcerptCell kind_of(const CellInstance& cell) const { return excerpt.cells[cell.id]; }
  /// Returns true if a fragment of the light belongs to the element.
  /// \param entry_mm any point of the region through which the fragment entered, in the frame of the excerpt
  /// \param cell first cell that the light meets
  bool is_own(const Vec2& entry_mm, const CellInstance& cell) const {
    using enum geometry::ExcerptCell;
    const geometry::ExcerptCell kind = kind_of(cell);
    return kind == own_element || (kind == land && geometry::contains(portion_mm, entry_mm));
  }
};

}  // namespace retrace::raytrace
