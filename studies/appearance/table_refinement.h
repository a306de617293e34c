#pragma once

// Choice and computation of the directions of light of a reflection table.

#include <vector>

#include "core/progress.h"
#include "requests/part.h"
#include "studies/appearance/colour_photometer.h"
#include "studies/appearance/light_lattice.h"
#include "studies/appearance/reflection_table.h"

namespace retrace::studies {

/// Computes the directions and the cells of a table. Cells are halved until their interpolation errors are at most the
/// requested error, or until the table has the maximum number of directions. Returns false if the computation was
/// cancelled.
/// \param table table with its grid of view directions, to which the directions of light are added
/// \param cells receives the cells
bool refine_cells(const MaterialRequest& request, const ColourPhotometer& photometer, const LightLattice& lattice,
                  ReflectionTable& table, std::vector<PlannedCell>& cells, Progress* progress,
                  const Cancellation* cancel);

}  // namespace retrace::studies
