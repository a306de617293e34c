#pragma once

// Light that is traced in an excerpt. An excerpt is an element of a part with its surroundings, made into a separate
// part.

#include "geometry/part/element_excerpt.h"
#include "raytrace/exact/beam.h"

namespace retrace::raytrace {

/// Selects the light that belongs to the element of an excerpt. Light belongs to the element whose facet it meets
/// first. Reflections at sides of the original part before this facet do not count. If the first cell is flat land, the
/// light belongs to the element through whose portion of the entrance face it entered. Light that belongs to other
/// elements is not traced and is not in the ledger. In the list of met cells (CellTrail), sides of the original part do
/// not count as cells.
///
/// Light that reaches the outline of the excerpt would continue in the original part. It is not traced further, and its
/// power is added to `truncated`.
struct ExcerptLight {
  const geometry::ElementExcerpt& excerpt;
  /// Portion of the entrance face through which the light of the element enters (ElementPortion). No entrance polygon
  /// crosses the border of the portion.
  const geometry::Polygon& portion_mm;

  geometry::ExcerptCell kind_of(const CellInstance& cell) const { return excerpt.cells[cell.id]; }
  /// Returns true if a fragment of light belongs to the element.
  /// \param entry_mm any point at which the fragment entered, in the frame of the excerpt
  /// \param cell first cell that the fragment meets
  bool is_own(const Vec2& entry_mm, const CellInstance& cell) const {
    using enum geometry::ExcerptCell;
    const geometry::ExcerptCell kind = kind_of(cell);
    return kind == own_element || (kind == land && geometry::contains(portion_mm, entry_mm));
  }
};

}  // namespace retrace::raytrace
