#pragma once

// Processes rays at the facets of a column and at the walls between columns.

#include "raytrace/cells/cell_step.h"

namespace retrace::raytrace {

/// Processes the rays of a batch that have met facets.
void meet_facets(const CellStep& step);

/// Processes the rays of a batch that have met the wall to a neighbouring column.
/// \pre meet_facets() has processed the batch, because meet_wall() overwrites the normals of the batch
void meet_wall(const ColumnFaces::Exit& exit, const CellStep& step);

}  // namespace retrace::raytrace
