#pragma once

// What the structures in which beams find the elements of a part cost, before they are made.

#include "geometry/part/part.h"

namespace retrace::raytrace {

/// Cost of making a BeamTracer.
struct ElementCost {
  double cells = 0.0;  ///< of the back surface, at all places
  double bytes = 0.0;  ///< memory at its peak
  double work = 0.0;   ///< in looks at a facet's bounding box, as BeamTrace::work()

  /// Returns true if the memory is within the budget.
  bool fits_memory() const;
};

ElementCost element_cost(const geometry::Part& part);

/// \throw BudgetError if the elements of the part do not fit into the memory budget
void require_element_memory(const geometry::Part& part);

}  // namespace retrace::raytrace
