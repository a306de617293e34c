#pragma once

// Estimates, before they are built, the memory and the time of the structures in which beams find the elements of a
// part.

#include "geometry/part/part.h"

namespace retrace::raytrace {

/// Cost of making a BeamTracer.
struct ElementCost {
  double cells = 0.0;  ///< number of cells of the back surface, over all placements
  double bytes = 0.0;  ///< peak memory
  double work = 0.0;   ///< time in units of BeamTrace::work(), tests of a facet's bounding box

  /// Returns true if the memory is within the budget.
  bool fits_memory() const;
};

ElementCost element_cost(const geometry::Part& part);

/// Checks the memory before a BeamTracer is made.
/// \throw BudgetError if the elements of the part do not fit into the memory budget
void require_element_memory(const geometry::Part& part);

}  // namespace retrace::raytrace
