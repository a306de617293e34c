#pragma once

// Estimates of memory and time for the search structures that find the elements which a beam meets. They are made
// before the structures are built.

#include "geometry/part/part.h"

namespace retrace::raytrace {

/// Cost of constructing a BeamTracer.
struct ElementCost {
  double cells = 0.0;  ///< number of cells of the back surface, over all placements
  double bytes = 0.0;  ///< peak memory
  double work = 0.0;   ///< time in units of BeamTrace::work(): tests of a beam against the bounding box of a facet

  /// Returns true if `bytes` is within the memory budget.
  bool fits_memory() const;
};

ElementCost element_cost(const geometry::Part& part);

/// Checks the memory budget before a BeamTracer is constructed.
/// \throw BudgetError if the search structures of the part exceed the memory budget
void require_element_memory(const geometry::Part& part);

}  // namespace retrace::raytrace
