#pragma once

// Estimates the memory and time for building the search structures of BeamTracer, which find the elements that a beam
// meets.

#include "geometry/part/part.h"

namespace retrace::raytrace {

/// Cost of constructing a BeamTracer.
struct ElementCost {
  double cells = 0.0;  ///< number of cells of the back surface, over all placements
  double bytes = 0.0;  ///< peak memory
  double work = 0.0;   ///< time in units of BeamTrace::work(), about 20 ns

  /// Returns true if `bytes` does not exceed element_memory_bytes().
  bool fits_memory() const;
};

ElementCost element_cost(const geometry::Part& part);

/// Checks the memory budget before a BeamTracer is constructed.
/// \throw BudgetError if the search structures of the part exceed element_memory_bytes()
void require_element_memory(const geometry::Part& part);

}  // namespace retrace::raytrace
