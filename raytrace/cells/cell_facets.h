#pragma once

// What happens to rays at the facets of a column, and at the walls between columns.

#include "raytrace/cells/cell_step.h"

namespace retrace::raytrace {

/// Processes the rays of a batch that have met facets.
void meet_facets(const CellStep& step);

/// Processes the rays of a batch that have met the wall of an exit.
/// \pre the facets have been processed, because the normals of the batch are replaced
void meet_wall(const ColumnFaces::Exit& exit, const CellStep& step);

}  // namespace retrace::raytrace
