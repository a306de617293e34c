#pragma once

// What a plan must know of the process by which its elements are cut.

#include <string>
#include <vector>

#include "fabrication/job/job.h"
#include "fabrication/machine/machine.h"

namespace retrace::fabrication {

/// One of the processes that cut elements, for one job.
struct ProcessFacts {
  int cuts_per_facet = 0;                ///< of roughing
  std::vector<double> passes_mm;         ///< side by side, as offsets of their middles along the root
  std::string array_title;               ///< of jobs without a title
  std::vector<std::string> description;  ///< lines for people: what is cut, how it lies, with which tool
};

/// A chisel that plunges and ploughs stands upright, and the table tilts. \pre the job cuts prisms
ProcessFacts plunging_facts(const Job& job, double stock_mm, std::size_t elements);
/// The V of micro chiseling is tilted by the head. \pre the job cuts cube corners
ProcessFacts chiseling_facts(const Job& job, double stock_mm, std::size_t elements);

/// Where the tool is touched off, for people.
std::string zero_text(const Job& job);

}  // namespace retrace::fabrication
