#pragma once

// Describes the cutting process of a job for the planner.

#include <string>
#include <vector>

#include "fabrication/job/job.h"

namespace retrace::fabrication {

/// Properties of the cutting process of one job.
struct ProcessFacts {
  int cuts_per_facet = 0;                ///< number of roughing cuts per facet
  std::vector<double> passes_mm;         ///< offsets of the centres of parallel passes, along the root
  std::string array_title;               ///< title of the program if the job has none
  std::vector<std::string> description;  ///< lines of text for the header: elements, their orientation, and the tool
};

/// Returns the properties of plunging and ploughing with a chisel. The chisel is upright, and the table tilts.
/// \pre the job cuts prisms
ProcessFacts plunging_facts(const Job& job, double stock_mm, std::size_t elements);
/// Returns the properties of micro chiseling with a V-shaped tool. The head tilts the tool.
/// \pre the job cuts cube corners
ProcessFacts chiseling_facts(const Job& job, double stock_mm, std::size_t elements);

/// Returns a text for the header that describes where the tool is touched off.
std::string zero_text(const Job& job);

}  // namespace retrace::fabrication
