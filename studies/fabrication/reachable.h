#pragma once

// Computes the part that a chisel with a straight edge can cut from a design of cube corners. The result is a design
// that can be traced.

#include <string>

#include "design/design.h"
#include "fabrication/chisel/check/chisel_reach.h"
#include "studies/fabrication/job_maker.h"

namespace retrace::studies {

/// Cube corners as a chisel with a straight edge can cut them (single-point inverted cutting). The chisel leaves a core
/// over each apex.
struct ReachablePart {
  fabrication::ChiselReach reach;
  std::int64_t elements = 0;
  std::string design;  ///< text of the design file (retrace.design/1) of this part, for `retrace rre`
  std::string facets;  ///< table of facet planes that belongs to the design
};

/// Computes the part that the chisel of a request can cut.
/// \param facets_file file name of the table of facet planes
/// \throw InputError for prisms, for `dmc`, and for tools that are too wide
ReachablePart reachable_part(const design::Design& design, const JobRequest& request, const std::string& facets_file);

/// Returns the fraction of the facets' area that a chisel reaches, or 0 if it reaches nothing.
double reachable_fraction(const geometry::Element& element, double tool_width_mm);

/// These functions return the result as JSON (retrace.reach/2) and as a table.
std::string reach_json(const ReachablePart& part, const JobRequest& request);
std::string reach_table(const ReachablePart& part);

/// Checks that jobs support the kind of the design's elements.
/// \throw InputError for a round cube corner
void check_is_cut(const design::Design& design);

}  // namespace retrace::studies
